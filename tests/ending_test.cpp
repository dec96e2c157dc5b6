// How rays end: what the sky's direction is worth, and which rays a horizon captures.
#include <gtest/gtest.h>

#include "core/trace/check_sample.h"
#include "metrics/ellis_wormhole.h"
#include "metrics/kerr_schild.h"
#include "metrics/minkowski.h"
#include "tests/random_rays.h"

namespace nullcone::test {
namespace {

using namespace nullcone::host;

/// Light through x in the chart direction n, into the future (sense 1) or the past (-1).
template <Metric M>
Phase<double> light(const M& metric, const Vec4<double>& x, const Vec3<double>& n, double sense) {
  const Matrix4<double> g = metric.g(x);
  const Vec4<double> space = {{0, n[0], n[1], n[2]}};
  const double A = g[0][0], B = dot(g[0], space), C = inner(g, space, space);
  Vec4<double> k = space;
  k[0] = (-B + sense * std::sqrt(B * B - A * C)) / A;
  return {x, g * k};
}

struct End {
  Ending how = Ending::none;
  Phase<double> at;
  Vec3<double> sky;
  int steps = 0;
};
/// Follows a ray by steps of a small part of what anything takes to change.
template <Metric M>
End followed(const M& metric, Phase<double> at, double precision, double fraction, int most = 100000) {
  End out;
  for (; out.steps < most && out.how == Ending::none; ++out.steps) {
    const auto rate = rhs(metric, at.x, at.p);
    const double end = ending(metric, at, rate, precision);
    out.how = static_cast<Ending>(static_cast<int>(end));
    if (out.how >= Ending::sky) out.sky = normalised(sky_direction(metric, at, rate, end));
    out.at = at;
    at = runge_kutta_step(metric, at, fraction / rate_of_change(metric, at.x, rate.x));
  }
  return out;
}

TEST(Sky, DirectionsAreAsGoodAsTheEndingSays) {
  // A ray that ends at 1e-4 has the direction of its own continuation, which ends at 1e-10 much further out.
  // The integration's own error is held below by small steps.
  const auto expect_good = [](const auto& metric, double from, unsigned seed) {
    Random random(seed);
    for (int n = 0; n < 100; ++n) {
      const Vec3<double> X = random.direction(), V = random.direction();
      const double mix = random.logarithmic(1e-3, 1);
      const Vec4<double> x = {{0, from * X[0], from * X[1], from * X[2]}};
      const Vec3<double> along = (mix * (dot(X, V) < 0 ? -1.0 : 1.0)) * V + (1 - mix) * X;
      const auto start = light(metric, x, along, n % 2 == 0 ? -1 : 1);
      for (const double precision : {1e-3, 1e-5}) {
        const End early = followed(metric, start, precision, 0.02);
        if (early.how == Ending::captured) continue;
        ASSERT_EQ(early.how, Ending::sky);
        const End late = followed(metric, early.at, 1e-3 * precision, 0.02);
        ASSERT_EQ(late.how, Ending::sky);
        EXPECT_LT(norm(early.sky - late.sky), 0.12 * precision) << n << " " << norm(spatial(early.at.x));
      }
    }
  };
  for (const double chart : {0.0, 1.0})
    for (const double spin : {-1.0, 0.0, 0.7}) {
      expect_good(KerrSchild{1, spin, chart}, 12, 1);
      expect_good(KerrSchild{1, spin, chart}, 500, 2);
    }
  expect_good(EllisWormhole{1}, 3, 3);
}

TEST(Sky, DeflectionBySchwarzschildIsExact) {
  // Deflection by elliptic integrals, with M = 1: light from periapsis into the future and into the past, in
  // either chart.
  struct Case {
    double b, deflection;
  };
  for (const Case& c : {Case{1.1 * std::sqrt(27.0), 2.0805336858689050}, Case{10, 0.59039578760582732},
                        Case{100, 0.041222539749273652}}) {
    const double r0 = 2 * c.b / std::sqrt(3.0) * std::cos(std::acos(-std::sqrt(27.0) / c.b) / 3);
    for (const double chart : {0.0, 1.0}) {
      const KerrSchild metric{1, 0, chart};
      // At periapsis dr/dlambda = 0, and p_x is what the chart makes of it: k^x = 0.
      const Vec4<double> x = {{0, 0.8 * r0, 0, 0.6 * r0}};
      const Vec3<double> across = {{0, 1, 0}};
      const End to = followed(metric, light(metric, x, across, 1), 1e-9, 0.004);
      const End from = followed(metric, light(metric, x, -across, -1), 1e-9, 0.004);
      ASSERT_EQ(to.how, Ending::sky);
      ASSERT_EQ(from.how, Ending::sky);
      const double straight = std::acos(-1.0);
      const double angle = std::atan2(norm(cross(to.sky, from.sky)), dot(to.sky, from.sky));
      const double turned = c.deflection > straight ? 2 * straight - angle : angle;
      EXPECT_NEAR(straight - turned, c.deflection, 1e-8) << c.b;
    }
  }
}

TEST(Sky, TheWormholeHasTwo) {
  const EllisWormhole metric{2};
  const Vec4<double> x = {{0, 3, 1, -2}};
  const End missed = followed(metric, light(metric, x, {{1, 0.3, 0.2}}, -1), 1e-9, 0.01);
  const End through = followed(metric, light(metric, x, {{-3, -1.2, 2.1}}, -1), 1e-9, 0.01);
  EXPECT_EQ(missed.how, Ending::sky);
  ASSERT_EQ(through.how, Ending::second_sky);
  // The same ray as the other side sees it: everything mirrored by X -> b^2 X/(4 rho^2), which keeps p dX.
  const Vec3<double> X = spatial(through.at.x), p = spatial(through.at.p);
  const double rho2 = dot(X, X), factor = rho2 / metric.quarter();
  const Vec3<double> Y = (1 / factor) * X, q = factor * (p - (2 * dot(p, X) / rho2) * X);
  const Phase<double> mirrored = {{{0, Y[0], Y[1], Y[2]}}, {{through.at.p[0], q[0], q[1], q[2]}}};
  const Phase<double> rate = metric.rhs(mirrored.x, mirrored.p);
  EXPECT_EQ(metric.ending(mirrored, rate, 1e-9), as_scalar<double>(Ending::sky));
  const auto direction = normalised(metric.sky_direction(mirrored, rate, as_scalar<double>(Ending::sky)));
  EXPECT_LT(norm(direction - through.sky), 1e-12);
  // And the plane of the ray holds: L is parallel on both sides.
  EXPECT_NEAR(dot(normalised(cross(X, p)), through.sky), 0, 1e-8);
}

TEST(Sky, BoundParticlesNeverReachIt) {
  const KerrSchild metric{1, 0.5, 0};
  const Vec4<double> x = {{0, 1000, 0, 0}};
  const auto tetrad = static_tetrad(metric, x);
  const auto moving_out = [&](double speed) {
    const Vec4<double> k = tetrad.to_chart({{1, speed, 0, 0}}), p = metric.g(x) * k;
    return metric.ending({x, p}, metric.rhs(x, p), 1e-2);
  };
  EXPECT_EQ(moving_out(0.04), as_scalar<double>(Ending::none));  // falls back: escape is at 0.0447
  EXPECT_EQ(moving_out(0.99), as_scalar<double>(Ending::sky));
  EXPECT_EQ(moving_out(1), as_scalar<double>(Ending::sky));
}

TEST(Horizon, PastDirectedLightFallsInByTheOutgoingChart) {
  Random random(5);
  for (const double spin : {0.0, 0.9, -1.0}) {
    const KerrSchild metric{1, spin, 0};
    for (int n = 0; n < 50; ++n) {
      const Vec3<double> X = 20.0 * random.direction(), aim = random.direction() - X;
      const End end = followed(metric, light(metric, {{0, X[0], X[1], X[2]}}, aim, -1), 1e-6, 0.05);
      EXPECT_EQ(end.how, Ending::captured) << spin << " " << n;
      EXPECT_LT(end.steps, 400);
    }
  }
}

TEST(Horizon, LightThatCreepsAlongItEnds) {
  // Past-directed in the ingoing chart, where K grows without end; and the same in the mirror of time.
  Random random(6);
  for (const double chart : {0.0, 1.0})
    for (const double spin : {0.0, 0.9, -0.998, 1.0}) {
      const KerrSchild metric{1, spin, chart};
      for (int n = 0; n < 50; ++n) {
        const Vec3<double> X = 20.0 * random.direction(), aim = random.direction() - X;
        const double sense = chart == 0 ? 1 : -1;
        const End end = followed(metric, light(metric, {{0, X[0], X[1], X[2]}}, aim, sense), 1e-6, 0.05);
        EXPECT_EQ(end.how, Ending::captured) << spin << " " << n;
        EXPECT_LT(end.steps, 2000);  // for a = M; fewer than 700 else
        const auto c = metric.congruence(end.at.x);
        EXPECT_NEAR((c.r2_a2 - 2 * c.r) / (metric.horizon() * metric.horizon()), 0, 1e-3);
      }
    }
}

TEST(Horizon, WhoFallsInSeesTheSkyThroughIt) {
  // An observer at r = 1.5 in the ingoing chart: light with E > 0 came in through the horizon from the sky,
  // or from the hole's own past, and crosses without a trace; light with E < 0 never was outside.
  const KerrSchild metric{1, 0, 1};
  const Vec4<double> x = {{0, 0.9, -0.72, 0.96}};
  ASSERT_NEAR(norm(spatial(x)), 1.5, 1e-12);
  const auto tetrad = gram_schmidt_tetrad(metric, x, inverse(metric.g(x))[0]);
  Random random(7);
  int skies = 0, captured = 0;
  for (int n = 0; n < 400; ++n) {
    const Vec3<double> m = random.direction();
    const Vec4<double> p = metric.g(x) * tetrad.to_chart({{-1, m[0], m[1], m[2]}});
    const End end = followed(metric, {x, p}, 1e-6, 0.05);
    ASSERT_TRUE(end.how == Ending::sky || end.how == Ending::captured) << static_cast<int>(end.how);
    // b = L/E decides: sky for E > 0 and b below the critical 3 sqrt 3.
    const double E = -p[0], L = norm(cross(spatial(x), spatial(p)));
    EXPECT_EQ(end.how == Ending::sky, E > 0 && L < std::sqrt(27.0) * E) << E << " " << L;
    ++(end.how == Ending::sky ? skies : captured);
  }
  EXPECT_GT(skies, 50);
  EXPECT_GT(captured, 50);
}

TEST(Horizon, FutureDirectedLightReachesTheCentre) {
  const KerrSchild metric{1, 0, 1};
  const End end = followed(metric, light(metric, {{0, 5, 3, 1}}, {{-5, -3.1, -1.2}}, 1), 1e-6, 0.05);
  EXPECT_EQ(end.how, Ending::left_chart);
}

TEST(Minkowski, RaysEndFarOut) {
  const Minkowski metric;
  const auto ends = [&](double x, double n) {
    const Phase<double> at = light(metric, {{0, x, 1, 2}}, {{n, 0, 0}}, -1);
    return metric.ending(at, metric.rhs(at.x, at.p), 1e-9);
  };
  EXPECT_EQ(ends(2e6, 1), as_scalar<double>(Ending::sky));
  EXPECT_EQ(ends(2e6, -1), as_scalar<double>(Ending::none));
  EXPECT_EQ(ends(5e5, 1), as_scalar<double>(Ending::none));
}

}  // namespace
}  // namespace nullcone::test
