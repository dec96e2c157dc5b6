// Observers who move: hyperbolas, orbits, falls and closed circles against their closed forms, and what their
// axes do: Thomas, de Sitter and Goedel precession.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/boost.h"
#include "core/base/error.h"
#include "core/trace/follow.h"
#include "metrics/registry.h"
#include "tests/random_rays.h"

namespace nullcone::test {
namespace {

using namespace host;

constexpr double kPi = std::numbers::pi;

Followed at(std::string_view metric, const std::vector<double>& parameters, const Motion& motion, double tau,
            ObserverFrame frame = ObserverFrame::at_rest) {
  return follow(find_spacetime(metric), parameters, motion, frame, tau, "test");
}
Motion circle(const Event& event, double speed, Motion::Pace pace = Motion::Pace::speed,
              bool clockwise = false) {
  return {Motion::Type::circular, event, {}, {}, pace, speed, clockwise};
}
/// The angle by which axes 1 and 2 have turned within the plane from x to y.
double turned(const Followed& now) { return std::atan2(now.axes[1][2], now.axes[1][1]); }

void expect_orthonormal(std::string_view metric, const std::vector<double>& parameters, const Followed& now) {
  const auto rows = find_spacetime(metric).metric(parameters, now.event);
  const Matrix4<double> g = {Vec4<double>{rows[0]}, Vec4<double>{rows[1]}, Vec4<double>{rows[2]},
                             Vec4<double>{rows[3]}};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      EXPECT_NEAR(inner(g, Vec4<double>{now.axes[i]}, Vec4<double>{now.axes[j]}),
                  i != j   ? 0
                  : i == 0 ? 1
                           : -1,
                  1e-10);
}

TEST(Follow, AccelerationInFlatSpaceIsAHyperbola) {
  const Motion motion{Motion::Type::accelerated, {1, 2, 3, 4}, {}, {0.3, 0.4, 0}, {}, 0, false};
  for (const double tau : {-4.0, 0.5, 6.0}) {
    const Followed now = at("minkowski", {}, motion, tau);
    const double a = 0.5, s = std::sinh(a * tau), c = std::cosh(a * tau);
    EXPECT_NEAR(now.event[0], 1 + s / a, 1e-11 * c);
    EXPECT_NEAR(now.event[1], 2 + 0.6 * (c - 1) / a, 1e-11 * c);
    EXPECT_NEAR(now.event[2], 3 + 0.8 * (c - 1) / a, 1e-11 * c);
    EXPECT_NEAR(now.event[3], 4, 1e-12);
    EXPECT_NEAR(now.axes[0][0], c, 1e-11 * c);
    EXPECT_NEAR(now.axes[3][3], 1, 1e-12);
    EXPECT_NEAR(0.6 * now.axes[1][0] + 0.8 * now.axes[2][0], s, 1e-11 * c);  // the axis along a is boosted
    expect_orthonormal("minkowski", {}, now);
  }
}

TEST(Follow, AccelerationFromASpeedEqualsItsBoost) {
  // Along x from velocity -tanh(a tau0): the hyperbola from another of its events.
  const double a = 0.7, tau0 = 1.3;
  const Motion motion{
      Motion::Type::accelerated, {0, 0, 0, 0}, {-std::tanh(a * tau0), 0, 0}, {a, 0, 0}, {}, 0, false};
  const Followed turn = at("minkowski", {}, motion, tau0), back = at("minkowski", {}, motion, 2 * tau0);
  EXPECT_NEAR(turn.axes[0][0], 1, 1e-12);
  EXPECT_NEAR(turn.event[1], -(std::cosh(a * tau0) - 1) / a, 1e-11);
  EXPECT_NEAR(back.event[1], 0, 1e-11);
}

TEST(Follow, GeodesicsAreThoseOfTheClosedForms) {
  Random random(3);
  for (int i = 0; i < 20; ++i) {
    const auto event = random.event(1.5);
    const Vec3<double> beta = random.uniform(0, 0.9) * random.direction();
    const Motion motion{Motion::Type::geodesic, event.c, beta.c, {}, {}, 0, false};
    const double tau = random.uniform(-8, 8);
    for (const std::string_view metric : {"minkowski", "goedel"}) {
      const std::vector<double> a = metric == "goedel" ? std::vector<double>{1.3} : std::vector<double>{};
      const Followed now = at(metric, a, motion, tau);
      const auto point =
          find_spacetime(metric).geodesic(a, event.c, four_velocity(beta).c, std::span(&tau, 1)).front();
      for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_NEAR(now.event[k], point.event[k], 1e-10);
        EXPECT_NEAR(now.axes[0][k], point.tangent[k], 1e-10);
      }
      expect_orthonormal(metric, a, now);
    }
  }
}

TEST(Follow, CirclesInFlatSpaceShowThomasPrecession) {
  const double v = 0.6, r = 2, gamma = 1.25, period = 2 * kPi * r / (gamma * v);
  for (const double tau : {0.0, 0.25 * period, period, 3 * period}) {
    const Followed now = at("minkowski", {}, circle({0, r, 0, 1}, v), tau);
    const double angle = gamma * v / r * tau;
    EXPECT_NEAR(now.event[0], gamma * tau, 1e-10);
    EXPECT_NEAR(now.event[1], r * std::cos(angle), 1e-10);
    EXPECT_NEAR(now.event[2], r * std::sin(angle), 1e-10);
    expect_orthonormal("minkowski", {}, now);
  }
  // After a turn axes have turned back by 2 pi (gamma - 1).
  const Followed after = at("minkowski", {}, circle({0, r, 0, 1}, v), period);
  EXPECT_NEAR(turned(after), -2 * kPi * (gamma - 1), 1e-10);
}

TEST(Follow, FreeOrbitsAboutABlackHole) {
  // Schwarzschild: dphi/dt = r^(-3/2) with the areal radius, which is that of Kerr-Schild; u^t = (1 -
  // 3/r)^(-1/2); and de Sitter precession by 2 pi (1 - sqrt(1 - 3/r)) a turn, forwards.
  const std::vector<double> hole = {1, 0, 0};
  const double r = 10, ut = 1 / std::sqrt(1 - 3 / r), omega = std::pow(r, -1.5),
               period = 2 * kPi / (omega * ut);
  const Followed now = at("kerr_schild", hole, circle({0, r, 0, 0}, 0, Motion::Pace::free), period);
  EXPECT_NEAR(now.event[0], 2 * kPi / omega, 1e-7);
  EXPECT_NEAR(now.event[1], r, 1e-8);
  EXPECT_NEAR(now.axes[0][0], ut, 1e-9);
  const Followed begun = at("kerr_schild", hole, circle({0, r, 0, 0}, 0, Motion::Pace::free), 0);
  const auto rows = find_spacetime("kerr_schild").metric(hole, now.event);
  const Matrix4<double> g = {Vec4<double>{rows[0]}, Vec4<double>{rows[1]}, Vec4<double>{rows[2]},
                             Vec4<double>{rows[3]}};
  const auto along = [&](std::size_t i) {
    return -inner(g, Vec4<double>{begun.axes[i]}, Vec4<double>{now.axes[1]});
  };
  const double expected = 2 * kPi * (1 - std::sqrt(1 - 3 / r));
  EXPECT_NEAR(std::atan2(along(2), along(1)), expected, 1e-8);
  expect_orthonormal("kerr_schild", hole, now);
  // Kerr: dphi/dt = +-1 / (r^(3/2) +- a), with x^2 + y^2 = r^2 + a^2.
  const double spin = 0.7, x = std::sqrt(r * r + spin * spin);
  for (const bool clockwise : {false, true}) {
    const Followed orbit =
        at("kerr_schild", {1, spin, 0}, circle({0, x, 0, 0}, 0, Motion::Pace::free, clockwise), 0);
    const double rate = orbit.axes[0][2] / x / orbit.axes[0][0], a = clockwise ? -1 : 1;
    EXPECT_NEAR(rate, 1 / (a * std::pow(r, 1.5) + spin), 1e-9);
  }
  EXPECT_THROW(at("kerr_schild", hole, circle({0, 10, 0, 1}, 0, Motion::Pace::free), 1), InputError);
  EXPECT_THROW(at("kerr_schild", hole, circle({0, 2.9, 0, 0}, 0, Motion::Pace::free), 1), InputError);
}

TEST(Follow, FallsThroughTheHorizon) {
  // From rest far out: proper time between radii of a fall from infinity, tau = (2/3) (r1^(3/2) - r2^(3/2)) /
  // sqrt(2).
  const std::vector<double> ingoing = {1, 0, 1};
  const double r1 = 20, r2 = 1;
  // Velocity of the fall against the static observer: sqrt(2/r).
  const Motion fall{Motion::Type::geodesic, {0, r1, 0, 0}, {-std::sqrt(2 / r1), 0, 0}, {}, {}, 0, false};
  const double tau = 2.0 / 3 * (std::pow(r1, 1.5) - std::pow(r2, 1.5)) / std::sqrt(2.0);
  const Followed now = at("kerr_schild", ingoing, fall, tau);
  EXPECT_NEAR(now.event[1], r2, 1e-7);
  EXPECT_NEAR(now.axes[0][1], -std::sqrt(2 / r2), 1e-7);
  expect_orthonormal("kerr_schild", ingoing, now);
  EXPECT_THROW(at("kerr_schild", ingoing, fall, tau + 1), InputError);  // the singularity
}

TEST(Follow, GyroscopesAtRestInGoedel) {
  // They turn counter-clockwise against the static tetrad with 1/(sqrt2 a) (docs/physics.md).
  const double a = 1.3;
  const Motion rest{Motion::Type::geodesic, {0, 0, 0, 0}, {}, {}, {}, 0, false};
  EXPECT_NEAR(turned(at("goedel", {a}, rest, 1.5)), 1.5 / (std::numbers::sqrt2 * a), 1e-11);
}

TEST(Follow, ClosedTimelikeCircles) {
  const double r = 3;
  const Followed now = at("goedel", {1}, circle({0.4, r, 0, 0}, 0, Motion::Pace::closed), 5.0);
  EXPECT_EQ(now.event[0], 0.4);
  EXPECT_NEAR(std::hypot(now.event[1], now.event[2]), r, 1e-12);
  // g_phiphi = r^2 (u^2 - 1), u = r/2a: once round takes 2 pi r sqrt(u^2 - 1).
  const double round = 2 * kPi * r * std::sqrt(0.25 * r * r - 1);
  const Followed again = at("goedel", {1}, circle({0.4, r, 0, 0}, 0, Motion::Pace::closed), round);
  EXPECT_NEAR(again.event[1], r, 1e-9);
  EXPECT_NEAR(again.event[2], 0, 1e-9);
  expect_orthonormal("goedel", {1}, again);
  EXPECT_THROW(at("goedel", {1}, circle({0, 1.9, 0, 0}, 0, Motion::Pace::closed), 1), InputError);
}

}  // namespace
}  // namespace nullcone::test
