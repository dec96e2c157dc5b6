#include "apps/geodesic_killing.h"

#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>

#include "core/base/error.h"

namespace nullcone {

namespace {

using State = std::array<double, 8>;  ///< event and vector

Event moved(const Event& x, double step, const Event& along) {
  Event out;
  for (std::size_t i = 0; i < 4; ++i) out[i] = x[i] + step * along[i];
  return out;
}

/// Sum of the components' sizes: NaN where one of them is.
double size_of(const Event& x) {
  double out = 0;
  for (const double component : x) out += std::fabs(component);
  return out;
}

double distance(const Event& a, const Event& b) { return size_of(moved(a, -1, b)); }

/// The derivative of K at x along v: sixth order differences.
Event difference(const KillingField& K, const Event& x, const Event& v, double h) {
  constexpr std::array<double, 3> kWeight = {45, -9, 1};
  Event out{};
  for (std::size_t n = 0; n < 3; ++n) {
    const double step = h * static_cast<double>(n + 1), weight = kWeight[n] / (60 * h);
    out = moved(out, weight, K.at(moved(x, step, v)));
    out = moved(out, -weight, K.at(moved(x, -step, v)));
  }
  return out;
}

/// The step at which truncation (what halving it changes) and rounding of the difference are smallest
/// together. A spacetime does not tell its length scale, so the search begins with the largest there is.
double best_step(const KillingField& K, const Event& x, const Event& v) {
  const double rounding = 1e-16 * (size_of(K.at(x)) + 1e-300);
  double h = std::max(1.0, size_of(x)) / size_of(v), best = h, least = HUGE_VAL;
  Event coarse = difference(K, x, v, h);
  for (int i = 0; i < 60; ++i) {
    h *= 0.5;
    const Event fine = difference(K, x, v, h);
    const double error = distance(fine, coarse) + rounding / h;
    if (error < least) least = error, best = h;
    coarse = fine;
  }
  return best;
}

/// An event and a vector carried along the field in so many steps: dx/deta = K(x), dv/deta = (v.d)K, for the
/// Lie derivative of the vector vanishes.
KillingField::Carried walked(const KillingField& K, const KillingField::Carried& start, double eta,
                             int steps) {
  boost::numeric::odeint::runge_kutta_fehlberg78<State> stepper;
  State y;
  std::copy_n(start.event.begin(), 4, y.begin());
  std::copy_n(start.vector.begin(), 4, y.begin() + 4);
  double h = 0;
  const auto rate = [&](const State& s, State& ds, double) {
    const Event x = {s[0], s[1], s[2], s[3]}, v = {s[4], s[5], s[6], s[7]};
    const Event dx = K.at(x), dv = difference(K, x, v, h);
    std::copy_n(dx.begin(), 4, ds.begin());
    std::copy_n(dv.begin(), 4, ds.begin() + 4);
  };
  for (int i = 0; i < steps; ++i) {
    if (i % std::max(1, steps / 32) == 0)
      h = best_step(K, {y[0], y[1], y[2], y[3]}, {y[4], y[5], y[6], y[7]});
    stepper.do_step(rate, y, 0.0, eta / steps);
  }
  return {{y[0], y[1], y[2], y[3]}, {y[4], y[5], y[6], y[7]}};
}

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out.empty() ? "nothing: no Killing field is known here" : out;
}

}  // namespace

KillingField::KillingField(const Spacetime& spacetime, std::span<const double> parameters,
                           const std::string& name, const Event& near)
    : spacetime_(spacetime), parameters_(parameters) {
  // A quadratic constant of motion, like Carter's, is told by its sign.
  const Event k = {1, 0.3, 0.5, 0.7}, opposite = {-1, -0.3, -0.5, -0.7};
  const auto there = spacetime.conserved(parameters, {0, near, k}),
             back = spacetime.conserved(parameters, {0, near, opposite});
  std::vector<std::string> known;
  for (std::size_t i = 0; i < there.size(); ++i) {
    if (!(std::fabs(there[i].value + back[i].value) <= 1e-9 * std::fabs(there[i].value))) continue;
    known.emplace_back(there[i].name);
    number_ = i;
    if (known.back() == name) return;
  }
  throw InputError("--killing " + printable(name, 40), "unknown; expected one of " + joined(known));
}

double KillingField::charge(const Event& event, const Event& tangent) const {
  return spacetime_.conserved(parameters_, {0, event, tangent})[number_].value;
}

// K = sum_a eta^aa g(K, e_a) e_a over an orthonormal frame.
Event KillingField::at(const Event& event) const {
  const auto axes = spacetime_.static_tetrad(parameters_, event);
  Event out{};
  for (std::size_t a = 0; a < 4; ++a) out = moved(out, (a == 0 ? 1 : -1) * charge(event, axes[a]), axes[a]);
  return out;
}

KillingField::Carried KillingField::carry(const Carried& start, double eta) const {
  if (eta == 0) return start;
  Carried coarse = walked(*this, start, eta, 8), best = coarse;
  double least = HUGE_VAL;
  for (int steps = 16; steps <= 8192 && !(least < 1e-12); steps *= 2) {
    const Carried fine = walked(*this, start, eta, steps);
    const double error =
        distance(fine.event, coarse.event) / (size_of(start.event) + size_of(fine.event) + 1e-300) +
        distance(fine.vector, coarse.vector) / size_of(fine.vector);
    if (error < least) least = error, best = fine;
    coarse = fine;
  }
  // Far out the isometry itself amplifies roundings, and 1e-12 cannot be had.
  if (!(least < 1e-9))
    throw InputError("--eta", "the field does not carry so far: digits are lost on the way");
  return best;
}

}  // namespace nullcone
