// The Runge-Kutta pairs: order conditions of their tableaus, and what a step does.
#include <gtest/gtest.h>

#include <functional>
#include <numeric>

#include "core/trace/integrate.h"
#include "metrics/kerr_schild.h"

namespace nullcone::test {
namespace {

using namespace host;

/// A rooted tree: its children. Order conditions (Butcher 1963): sum_i b_i phi_i(t) = 1/gamma(t) for every
/// tree.
struct Tree {
  std::vector<Tree> children;
  int order() const {
    return std::accumulate(children.begin(), children.end(), 1,
                           [](int n, const Tree& t) { return n + t.order(); });
  }
  long double gamma() const {
    return std::accumulate(children.begin(), children.end(), static_cast<long double>(order()),
                           [](long double g, const Tree& t) { return g * t.gamma(); });
  }
};

/// All forests of trees from number `from` of `list` on, with `nodes` nodes together.
void forests(const std::vector<Tree>& list, std::size_t from, int nodes, std::vector<Tree>& forest,
             const std::function<void()>& visit) {
  if (nodes == 0) return visit();
  for (std::size_t i = from; i < list.size(); ++i) {
    if (list[i].order() > nodes) continue;
    forest.push_back(list[i]);
    forests(list, i, nodes - list[i].order(), forest, visit);
    forest.pop_back();
  }
}

std::vector<Tree> trees_up_to(int order) {
  std::vector<Tree> out;
  for (int n = 1; n <= order; ++n) {
    std::vector<Tree> found, forest;
    forests(out, 0, n - 1, forest, [&] { found.push_back({forest}); });
    out.insert(out.end(), found.begin(), found.end());
  }
  return out;
}

template <class T>
std::vector<long double> phi(const T& tableau, const Tree& tree) {
  std::vector<long double> out(static_cast<std::size_t>(T::stages), 1);
  for (const Tree& child : tree.children) {
    const auto inner = phi(tableau, child);
    for (std::size_t i = 0; i < out.size(); ++i) {
      long double sum = 0;
      for (std::size_t j = 0; j < i; ++j) sum += static_cast<long double>(tableau.a[i - 1][j]) * inner[j];
      out[i] *= sum;
    }
  }
  return out;
}

template <class T>
void expect_order(const T& tableau, const double (&b)[static_cast<std::size_t>(T::stages)], int order,
                  const char* name) {
  double worst_within = 0, best_beyond = 0;
  for (const Tree& tree : trees_up_to(order + 1)) {
    const auto values = phi(tableau, tree);
    long double sum = -1 / tree.gamma();
    for (std::size_t i = 0; i < values.size(); ++i) sum += static_cast<long double>(b[i]) * values[i];
    double& worst = tree.order() <= order ? worst_within : best_beyond;
    worst = std::max(worst, std::fabs(static_cast<double>(sum)));
  }
  EXPECT_LT(worst_within, 2e-15) << name;  // coefficients of up to 40 are rounded to double
  EXPECT_GT(best_beyond, 1e-7) << name << " is of a higher order than it says";
}

TEST(Steppers, TableausFulfilTheirOrderConditions) {
  EXPECT_EQ(trees_up_to(8).size(), 1U + 1 + 2 + 4 + 9 + 20 + 48 + 115);
  expect_order(kVerner65, kVerner65.b, 6, "Verner 6");
  expect_order(kVerner65, kVerner65.b_embedded, 5, "Verner 5");
  expect_order(kPrinceDormand87, kPrinceDormand87.b, 8, "Prince-Dormand 8");
  expect_order(kPrinceDormand87, kPrinceDormand87.b_embedded, 7, "Prince-Dormand 7");
}

/// A turn of the harmonic oscillator, through Odeint.
struct Oscillator {
  template <class S>
  void operator()(const State<S>& y, State<S>& dy, const S&) const {
    for (std::size_t i = 0; i < 4; ++i) dy[i] = y[i + 4], dy[i + 4] = -y[i];
  }
};

/// log2 of how much smaller the error of a step gets when it is halved: order + 1.
template <class Stepper>
double measured_order() {
  Stepper stepper;
  double last = 0, rate = 0;
  for (const double h : {0.8, 0.4}) {
    State<double> y{{1, 1, 1, 1, 0.5, 0.5, 0.5, 0.5}}, dy, y1, dy1, error;
    Oscillator{}(y, dy, 0.0);
    stepper.step(Oscillator{}, y, dy, h, y1, dy1, error);
    const double off = std::fabs(y1[0] - (std::cos(h) + 0.5 * std::sin(h)));
    EXPECT_EQ(stepper.move(Oscillator{}, y, dy, h)[0], y1[0]);
    rate = std::log2(last / off);
    last = off;
  }
  return rate;
}

TEST(Steppers, StepsConvergeWithTheirOrder) {  // on a linear system some do even better
  EXPECT_NEAR(measured_order<DormandPrince5<double>>(), 6, 0.3);
  EXPECT_GT(measured_order<Verner65<double>>(), 6.7);
  EXPECT_GT(measured_order<Fehlberg78<double>>(), 8.7);
  EXPECT_GT(measured_order<PrinceDormand87<double>>(), 8.7);
}

TEST(Steppers, StepsThatBreakDownAreRefused) {
  const HamiltonSystem<KerrSchild> system{{}};
  DormandPrince5<double> stepper;
  const double nan = std::nan(""), infinity = INFINITY, tiny = 5e-324;
  for (const double bad : {nan, infinity, -infinity}) {
    for (std::size_t i = 0; i < 8; ++i) {
      Flight<double> flight;
      flight.y = {{0, 10, 1, 2, 1, -1, 0.1, 0}};
      flight.y[i] = bad;
      flight.dy = system.rate(flight.y);
      const auto a = attempt(stepper, system, kBalanced, flight, 0.1);
      // The time has no influence on anything else in a stationary spacetime, but must be a number too.
      EXPECT_FALSE(a.accepted) << "component " << i << " = " << bad;
      EXPECT_EQ(a.factor, 0.2);
    }
    Flight<double> flight;
    flight.y = {{0, 10, 1, 2, 1, -1, 0.1, 0}};
    flight.dy = system.rate(flight.y);
    EXPECT_FALSE(attempt(stepper, system, kBalanced, flight, bad).accepted) << bad;
  }
  Flight<double> flight;  // denormal momenta are nothing special
  flight.y = {{0, 10, 1, 2, tiny, -tiny, tiny, tiny}};
  flight.dy = system.rate(flight.y);
  const auto a = attempt(stepper, system, kBalanced, flight, 0.1);
  EXPECT_TRUE(std::isfinite(a.factor));
}

}  // namespace
}  // namespace nullcone::test
