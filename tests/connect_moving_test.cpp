// Connections with moving lamps: against a scan of their worldlines, and against paths.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/connections.h"
#include "tests/sanitized.h"

namespace nullcone::test {
namespace {

/// The light of one branch that leaves a lamp at the proper time tau: whether it exists, and how late it
/// comes.
struct Lateness {
  bool exists;
  double value;
};
Lateness lateness(const Goedel& metric, const Vec4<double>& event, const LampLine<Goedel>& line,
                  const GoedelBranch& branch, double tau) {
  const GoedelPlace<double> place(metric, metric.to_origin(event, line.event(tau)));
  const GoedelLight<double> light = light_to(metric, branch, place.u0, place.zeta);
  return {light.exists, place.at[0] + light.time};
}

/// Where a predicate changes between two times.
template <class P>
double change(const P& is, double from, double to) {
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (from + to);
    (is(middle) == is(from) ? from : to) = middle;
  }
  return from;
}

/// The proper times at which lateness changes sign while the branch exists, by a scan in steps of `step`.
std::vector<double> emissions_by_scan(const Goedel& metric, const Vec4<double>& event,
                                      const LampLine<Goedel>& line, const GoedelBranch& branch, double low,
                                      double high, double step) {
  const auto at = [&](double tau) { return lateness(metric, event, line, branch, tau); };
  const auto exists = [&](double tau) { return at(tau).exists; };
  std::vector<double> out;
  // Within [from, to] the branch exists.
  const auto look = [&](double from, double to) {
    if (at(from).value < 0 && at(to).value >= 0)
      out.push_back(change([&](double tau) { return at(tau).value < 0; }, from, to));
  };
  bool inside = exists(low);
  for (double tau = low; tau < high; tau += step) {
    const bool next = exists(tau + step);
    if (inside && next)
      look(tau, tau + step);
    else if (inside)
      look(tau, change(exists, tau, tau + step));
    else if (next)
      look(change(exists, tau + step, tau), tau + step);
    inside = next;
  }
  return out;
}

/// Proper times between which lamps of one kind may send light: passing the event, or up to `windings`
/// before.
struct Stretch {
  double low, high, period;
};
Stretch stretch_of(const Goedel& metric, const Vec4<double>& event, const LampLine<Goedel>& line,
                   int windings) {
  const Vec4<double>& u = line.body.frame.u;
  const double kappa = std::sqrt(1 - 0.5 * (u[1] * u[1] + u[2] * u[2]) / (u[0] * u[0]));
  const double slowest = metric.mean_rate(u) - std::fabs(u[3]),
               since = std::fabs(event[0] - line.body.frame.start[0]);
  const double light =
      4.5 * metric.a * (windings + 1) + since + std::fabs(u[3]) / metric.mean_rate(u) * since;
  return {-light / slowest, light / slowest,
          std::numbers::pi * std::numbers::sqrt2 * metric.a / (kappa * u[0])};
}

struct Tally {
  int found = 0, doubles = 0;
};

/// Compares all emissions of lobes 0 and 1 with those of a scan.
void expect_all_emissions(const Goedel& metric, const Vec4<double>& event, const LampLine<Goedel>& line,
                          Tally& tally) {
  constexpr int kWindings = 2;
  const Stretch all = stretch_of(metric, event, line, kWindings);
  if (all.high > 40 * all.period) return;  // too slow for a scan
  for (int lobe = 0; lobe < kWindings; ++lobe)
    for (const bool far : {false, true}) {
      const auto want =
          emissions_by_scan(metric, event, line, {lobe, far}, all.low, all.high, all.period / 150);
      const int in_lobe = branches(metric, line, 1);
      std::vector<double> got;
      for (int branch = in_lobe * lobe + far; branch < in_lobe * (lobe + 1); branch += 2) {
        const auto one = connect(metric, event, line, branch);
        if (!one.found) continue;
        got.push_back(one.tau);
        EXPECT_LT(miss(metric, event, one), 1e-9);
      }
      std::sort(got.begin(), got.end());
      ASSERT_EQ(got.size(), want.size()) << "lobe " << lobe << " far " << far;
      for (std::size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i], want[i], 1e-9 * all.period);
      tally.found += static_cast<int>(want.size());
      tally.doubles += want.size() > 1;
    }
}

Tally random_lamps(unsigned seed, int lamps, double slowest, double fastest, double ball) {
  Random random(seed);
  Tally tally;
  for (int n = 0; n < lamps; ++n) {
    const Goedel metric{random.logarithmic(0.1, 10)};
    const Vec4<double> event = metric.a * random.event(1.8), start = metric.a * random.event(1.8);
    Vec3<double> velocity = random.uniform(slowest, fastest) * random.direction();
    if (n % 3 == 0) velocity[2] = 0;
    auto line = falling_lamp(metric, start, velocity, std::fmax(ball, 1e-3) * metric.a, n % 2 == 0);
    line.X = ball * metric.a * random.direction();
    SCOPED_TRACE(testing::Message() << "lamp " << n << " of speed " << norm(velocity));
    expect_all_emissions(metric, event, line, tally);
  }
  return tally;
}

constexpr int kLamps = kSanitized ? 70 : 700;

TEST(ConnectMoving, LampsAtModerateSpeed) { EXPECT_GT(random_lamps(21, kLamps, 0, 0.6, 0).found, kLamps); }
TEST(ConnectMoving, PointsOfBodies) {
  EXPECT_GT(random_lamps(22, kLamps / 3, 0, 0.6, 0.05).found, kLamps / 4);
}

TEST(ConnectMoving, FastLamps) { EXPECT_GT(random_lamps(23, kLamps, 0.6, 0.999, 0).found, kLamps); }

TEST(ConnectMoving, FastLampsMaySendTwice) {
  Random random(25);
  Tally tally;
  for (int n = 0; n < 20; ++n) {
    const Goedel metric{1};
    const double speed = random.uniform(0.95, 0.999);
    const auto line = falling_lamp(metric, random.event(0.1), {{0.8 * speed, 0.6 * speed, 0}});
    ASSERT_EQ(branches(metric, line, 1), 4);
    for (int k = 0; k < 2000; k += kSanitized ? 7 : 1) {
      Vec4<double> event = random.event(2.5);
      event[3] *= 0.1;
      bool twice = false;
      for (const int branch : {2, 3, 6, 7}) twice = twice || connect(metric, event, line, branch).found;
      if (twice) expect_all_emissions(metric, event, line, tally);
    }
  }
  EXPECT_GE(tally.doubles, kSanitized ? 0 : 6);
}

TEST(ConnectMoving, FlatLimit) {
  Random random(24);
  for (int n = 0; n < 200; ++n) {
    const Goedel metric{random.logarithmic(1e10, 1e15)};
    const Vec4<double> event = random.event(5), start = random.event(5);
    const Vec3<double> velocity = random.uniform(0, 0.95) * random.direction();
    const auto got = all_connections(metric, event, falling_lamp(metric, start, velocity), 1);
    const auto want = connect(Minkowski{}, event, falling_lamp(Minkowski{}, start, velocity), 0);
    const double tolerance = 1e-12 + 1000 / metric.a;
    ASSERT_GE(got.size(), 1u);
    EXPECT_NEAR(got[0].lambda, want.lambda, tolerance * want.lambda);
    EXPECT_NEAR(got[0].tau, want.tau, 20 * tolerance);
    EXPECT_NEAR(got[0].det, want.det, tolerance * want.det);
    for (std::size_t i = 1; i < 4; ++i) EXPECT_NEAR(got[0].past[i], want.past[i], 20 * tolerance);
  }
}

std::vector<double> values_of(const Connection<Pack>& c, std::size_t lane) {
  std::vector<double> out;
  for (const Pack& x : {c.lambda, c.tau, c.det}) out.push_back(x.get(lane));
  for (const auto* v : {&c.past, &c.emitted, &c.tangent})
    for (std::size_t i = 0; i < 4; ++i) out.push_back((*v)[i].get(lane));
  return out;
}
std::vector<double> values_of(const Connection<double>& c) {
  std::vector<double> out = {c.lambda, c.tau, c.det};
  for (const auto* v : {&c.past, &c.emitted, &c.tangent}) out.insert(out.end(), v->c.begin(), v->c.end());
  return out;
}

/// Lanes of a pack hold what one lane holds, whatever their neighbours do.
template <class M>
void expect_same_bits(const M& metric, const LampLine<M>& line, Random& random, double scale, int& found) {
  std::array<Vec4<double>, Pack::size> events;
  for (auto& event : events) event = scale * random.event(1.5);
  const auto packed = Vec4<Pack>::map([&](std::size_t i) {
    std::array<double, Pack::size> lanes;
    for (std::size_t lane = 0; lane < Pack::size; ++lane) lanes[lane] = events[lane][i];
    return Lanes<Pack>::load(lanes.data());
  });
  for (int branch = 0; branch < branches(metric, line, 2); ++branch) {
    const Connection<Pack> together = connect(metric, packed, line, branch);
    std::array<bool, Pack::size> is_found;
    Lanes<Pack>::store(together.found, is_found.data());
    for (std::size_t lane = 0; lane < Pack::size; ++lane) {
      const Connection<double> alone = connect(metric, events[lane], line, branch);
      ASSERT_EQ(is_found[lane], alone.found);
      if (!alone.found) continue;
      ++found;
      ASSERT_EQ(values_of(together, lane), values_of(alone));
    }
  }
}

TEST(ConnectMoving, PacksHoldTheSameBits) {
  Random random(22);
  int found = 0;
  for (int n = 0; n < 600; ++n) {
    const Goedel metric{random.logarithmic(0.1, 10)};
    const Vec4<double> start = metric.a * random.event(1.5);
    const Vec3<double> velocity = random.uniform(0, .95) * random.direction();
    expect_same_bits(metric, lamp_at_rest(metric, start), random, metric.a, found);
    expect_same_bits(metric, falling_lamp(metric, start, velocity), random, metric.a, found);
    const Minkowski flat;
    expect_same_bits(flat, lamp_at_rest(flat, start), random, 1, found);
    expect_same_bits(flat, falling_lamp(flat, start, velocity), random, 1, found);
  }
  EXPECT_GT(found, 5000);
}

}  // namespace
}  // namespace nullcone::test
