// Light of lamps along integrated rays: against closed forms, and against flat space where gravity is weak.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "metrics/goedel.h"
#include "metrics/kerr_schild.h"
#include "tests/lit_scene.h"
#include "tests/random_rays.h"
#include "tests/sanitized.h"

namespace nullcone::test {
namespace {

using namespace host;

/// Two spheres at rest, the nearer one in the light of the other, and a lamp.
Scene two_spheres(const Event& lit_ball, const Event& screen, const Event& lamp) {
  Scene out = scene_of(camera(48, 48, 0.7), {ball(lit_ball, 0.3), ball(screen, 0.15)}, {point_lamp(lamp)});
  out.accuracy = kReference;
  out.lights.paths = 2;
  return out;
}

/// Compares the light of crossings; returns how many are lit, and how many are in shadow alone there.
struct Compared {
  std::size_t lit = 0, shadowed = 0, differ = 0;
};
Compared compare(const LightSink& one, const LightSink& other, double tolerance) {
  Compared out;
  EXPECT_EQ(one.hits.size(), other.hits.size());
  if (one.hits.size() != other.hits.size()) return out;
  for (std::size_t i = 0; i < one.hits.size(); ++i)
    for (std::size_t k = 0; k < one.paths; ++k) {
      const HitLight &a = one.light(i, k), &b = other.light(i, k);
      (a.E > 0 ? out.lit : out.shadowed) += 1;
      const double scale = std::max(a.E, b.E);
      if (scale == 0) continue;
      const bool same = std::fabs(a.E - b.E) < tolerance * (scale + 1e-2) &&
                        std::fabs(a.shift - b.shift) < tolerance && std::fabs(a.t - b.t) < 30 * tolerance &&
                        std::fabs(a.tau - b.tau) < 30 * tolerance;
      out.differ += !same;
    }
  return out;
}

TEST(IntegratedIllumination, is_that_of_closed_forms) {
  Random random(91);
  Compared all;
  for (int n = 0; n < (kSanitized ? 2 : 12); ++n) {
    const double up = random.uniform(-0.3, 0.3), side = random.uniform(-0.4, 0.4);
    Scene scene = two_spheres({0, 1.0, 0, 0}, {0, 0.8, 0.5 * side, 0.45 * (up > 0 ? 1 : -1)},
                              {0, 0.7, side, up > 0 ? 1.0 : -1.0});
    scene.max_lookback = 4;
    const Goedel metric{1.2};
    const LightSink closed = lit(metric, scene);
    scene.integrated = true;
    const LightSink integrated = lit(metric, scene);
    const Compared here = compare(closed, integrated, 1e-6);
    all.lit += here.lit, all.shadowed += here.shadowed, all.differ += here.differ;
  }
  EXPECT_GT(all.lit, kSanitized ? 100u : 2000u);
  EXPECT_LE(all.differ, all.lit / 500);  // rims of shadows
}

TEST(IntegratedIllumination, is_that_of_flat_space_where_gravity_is_weak) {
  // A hole of a tiny mass far from everything: light is found by shooting, and shadows along integrated rays.
  KerrSchild hole;
  hole.mass = 1e-9;
  Scene scene = two_spheres({0, 5, 0.2, 0.3}, {0, 4.1, 0.6, 0.95}, {0, 3.2, 0.8, 1.4});
  scene.observer.event = {0, 2, 0, 0.3};
  scene.camera = camera(48, 48, 0.25);
  scene.max_lookback = 1e3;
  const LightSink flat = lit(Minkowski{}, scene);
  scene.integrated = true;
  const LightSink curved = lit(hole, scene);
  ASSERT_EQ(flat.hits.size(), curved.hits.size());
  std::size_t lights = 0, shadows = 0, differ = 0;
  for (std::size_t i = 0; i < flat.hits.size(); ++i) {
    const HitLight &a = flat.light(i), &b = curved.light(i);
    (a.E > 0 ? lights : shadows) += 1;
    differ += std::fabs(a.E - b.E) > 1e-6 * (a.E + 1e-2) || (a.E > 0 && std::fabs(a.t - b.t) > 1e-5);
  }
  EXPECT_GT(lights, 300u);
  EXPECT_GT(shadows, 100u);
  EXPECT_LE(differ, 3u);
}

TEST(IntegratedIllumination, of_a_lamp_in_a_gravitational_field_is_shifted) {
  // A sphere far out, lit by a lamp close to the hole, and the other way round: g = sqrt(f_lamp/f_surface).
  KerrSchild hole;
  hole.spin = 0;
  for (const bool lamp_is_deep : {true, false}) {
    Scene scene = two_spheres({0, lamp_is_deep ? 20.0 : 6.0, 0, 0}, {0, 100, 100, 100},
                              {0, lamp_is_deep ? 6.0 : 20.0, 2, 0});
    scene.observer.event = {0, lamp_is_deep ? 15.0 : 12.0, 1, 0};
    scene.camera.forward = {lamp_is_deep ? 1.0 : -1.0, 0, 0};
    scene.camera.left = {0, lamp_is_deep ? 1.0 : -1.0, 0};
    scene.max_lookback = 1e4;
    const LightSink found = lit(hole, scene);
    const double deep = 1 - 2 / std::hypot(6.0, lamp_is_deep ? 2.0 : 0.0),
                 high = 1 - 2 / std::hypot(20.0, lamp_is_deep ? 0.0 : 2.0);
    const double expected = lamp_is_deep ? std::sqrt(deep / high) : std::sqrt(high / deep);
    std::size_t lights = 0;
    for (std::size_t i = 0; i < found.hits.size(); ++i) {
      if (found.light(i).E == 0) continue;
      ++lights;
      EXPECT_NEAR(found.light(i).shift, expected, 0.03);  // the sphere has a size
    }
    EXPECT_GT(lights, 20u);
  }
}

}  // namespace
}  // namespace nullcone::test
