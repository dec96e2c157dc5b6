// Light of lamps in flat spacetime: irradiance on moving surfaces, delays, shadows and lamps with area,
// against independent formulas.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "core/base/boost.h"
#include "core/trace/illumination.h"
#include "tests/lit_scene.h"
#include "tests/random_rays.h"

namespace nullcone::test {
namespace {

using namespace host;

using L = long double;

/// Eqs. (18) and (19) of Weiskopf, Kraus and Ruder (1999) in the patch's rest frame: the retarded lamp by
/// bisection in its own proper time.
struct ByFrame {
  L E, shift, t, tau;
};
ByFrame by_frame(const Vec4<L>& event, const Vec4<L>& u, const Vec3<L>& normal, const Vec4<L>& lamp,
                 const Vec4<L>& v) {
  const auto at = [&](L tau) { return boost(u, lamp + tau * v - event); };
  L low = -1, high = 1;
  const auto late = [&](L tau) {
    const Vec4<L> x = at(tau);
    return x[0] + norm(spatial(x));
  };
  while (late(low) > 0) low *= 2;
  while (late(high) < 0) high *= 2;
  for (int i = 0; i < 200; ++i) (late(0.5L * (low + high)) < 0 ? low : high) = 0.5L * (low + high);
  const L tau = 0.5L * (low + high);
  const Vec3<L> R = spatial(at(tau));
  const L r = norm(R);
  const Vec4<L> w = boost(u, v);  // the lamp's 4-velocity: k = (1, -R/r), k.w = w0 + R.w/r
  const L cosine = dot(R, normal) / r, shift = 1 / (w[0] + dot(R, spatial(w)) / r);
  return {cosine > 0 ? cosine / (r * r) : 0, shift, (lamp + tau * v)[0], tau};
}

TEST(Illumination, of_moving_patches_by_moving_lamps) {
  Random random(71);
  double worst_E = 0, worst_shift = 0, worst_t = 0;
  int lit_hits = 0, dark = 0;
  for (int n = 0; n < 1000; ++n) {
    const auto velocity = [&] {
      const double beta = n % 3 == 0 ? 0.999 : random.uniform(0, 0.99);
      return (beta * random.direction()).c;
    };
    Object patch;
    patch.name = "patch";
    patch.shape.type = ShapeType::quad;
    patch.shape.edges = {4, 3, 0};
    const Vec3<double> place = random.logarithmic(2, 20) * random.direction();
    patch.placing = moving({random.uniform(-5, 5), place[0], place[1], place[2]}, velocity());
    const Vec3<double> z = random.direction(), x = normalised(cross(random.direction(), z));
    patch.placing.axes = {x.c, cross(z, x).c, z.c};
    const Vec3<double> there = random.logarithmic(0.5, 50) * random.direction();
    const Scene scene =
        scene_of(camera(16, 16, 1.0), {patch},
                 {point_lamp({random.uniform(-9, 9), there[0], there[1], there[2]}, velocity())});
    Scene aimed = scene;
    aimed.camera.type = CameraType::panorama;
    aimed.camera.fov_horizontal = 6.28, aimed.camera.fov_vertical = 3.14;
    const LightSink found = lit(aimed);
    const Vec4<L> u = convert<L>(four_velocity(Vec3<double>{patch.placing.worldline.velocity}));
    for (std::size_t i = 0; i < found.hits.size(); ++i) {
      const HitRecord& hit = found.hits[i];
      const L tau_origin = (0 - patch.placing.worldline.event[0]) / u[0], tau = hit.tau + tau_origin;
      const Vec3<L> X = {{4 * (static_cast<L>(hit.u) - 0.5L), 3 * (static_cast<L>(hit.v) - 0.5L), 0}};
      const Vec3<L> rest = X[0] * convert<L>(x) + X[1] * convert<L>(cross(z, x));
      const Vec4<L> event = convert<L>(Vec4<double>{patch.placing.worldline.event}) + tau * u +
                            boost(opposite(u), Vec4<L>{{0, rest[0], rest[1], rest[2]}});
      const Lamp& lamp = scene.lights.lamps[0];
      const Vec4<L> v = convert<L>(four_velocity(Vec3<double>{lamp.placing.worldline.velocity}));
      // The side that is seen: the one to which the photon leaves.
      const Vec4<L> to_eye = boost(u, -event);
      const Vec3<L> side = dot(spatial(to_eye), convert<L>(z)) > 0 ? convert<L>(z) : -convert<L>(z);
      const ByFrame expected =
          by_frame(event, u, side, convert<L>(Vec4<double>{lamp.placing.worldline.event}), v);
      const HitLight& light = found.light(i);
      if (expected.E == 0) {
        ++dark;
        EXPECT_EQ(light.E, 0);
        continue;
      }
      ++lit_hits;
      const L origin = (0 - lamp.placing.worldline.event[0]) / v[0];
      worst_E = std::max(worst_E, static_cast<double>(std::fabs(light.E / expected.E - 1)));
      worst_shift = std::max(worst_shift, static_cast<double>(std::fabs(light.shift / expected.shift - 1)));
      const L scale = std::fabs(expected.t) + 10;
      worst_t = std::max({worst_t, static_cast<double>(std::fabs(light.t - expected.t) / scale),
                          static_cast<double>(std::fabs(light.tau + origin - expected.tau) / scale)});
    }
  }
  std::printf("%d lit, %d dark; E %.1e, shift %.1e, times %.1e\n", lit_hits, dark, worst_E, worst_shift,
              worst_t);
  EXPECT_GT(lit_hits, 1000);
  EXPECT_GT(dark, 1000);
  EXPECT_LT(worst_E, 1e-10);  // gamma = 22: boosts there and back
  EXPECT_LT(worst_shift, 1e-10);
  EXPECT_LT(worst_t, 1e-10);
}

/// The event of a hit on the wall.
Vec4<double> on_wall(const HitRecord& hit, double edge = 12) {
  return {{hit.t, 10, edge * (hit.u - 0.5), edge * (hit.v - 0.5)}};
}

/// Nearest distance of the light's way from `event` to a resting lamp at `lamp`, from a moving sphere's
/// centre.
double distance_of_light(const Vec4<double>& event, const Vec3<double>& lamp, const Placing& sphere) {
  const Vec4<L> u = convert<L>(four_velocity(Vec3<double>{sphere.worldline.velocity}));
  const Vec3<L> way = convert<L>(lamp) - convert<L>(spatial(event));
  const L length = norm(way);
  const Vec4<L> past = {{-1, way[0] / length, way[1] / length, way[2] / length}};
  const Vec3<L> X = spatial(boost(u, convert<L>(event - Vec4<double>{sphere.worldline.event}))),
                k = spatial(boost(u, past));
  const L nearest = std::clamp(-dot(X, k) / dot(k, k), static_cast<L>(0), length);
  return static_cast<double>(norm(X + nearest * k));
}

TEST(Illumination, shadows_fall_where_moving_spheres_were) {
  Random random(72);
  int shadowed = 0, free = 0, grazing = 0;
  for (int n = 0; n < 100; ++n) {
    const Vec3<double> lamp = {{random.uniform(-2, 2), random.uniform(-4, 4), random.uniform(-4, 4)}};
    const Vec3<double> place = {{random.uniform(3, 8), random.uniform(-2, 2), random.uniform(-2, 2)}};
    const Triple velocity = ((n % 4) * 0.3 * random.direction()).c;
    // Where it was when the light passed, roughly.
    const Object sphere = ball({-13, place[0], place[1], place[2]}, random.uniform(0.2, 1), velocity);
    Scene scene =
        scene_of(camera(40, 40, 1.2), {wall(), sphere}, {point_lamp({0, lamp[0], lamp[1], lamp[2]})});
    const LightSink found = lit(scene);
    scene.lights.shadows = false;
    const LightSink bare = lit(scene);
    for (std::size_t i = 0; i < found.hits.size(); ++i) {
      if (found.hits[i].id != 1) continue;
      const double distance = distance_of_light(on_wall(found.hits[i]), lamp, sphere.placing);
      const double off = distance / sphere.shape.radius - 1;
      ++(std::fabs(off) < 1e-9 ? grazing : off < 0 ? shadowed : free);
      if (std::fabs(off) < 1e-9) continue;
      EXPECT_EQ(found.light(i).E, off < 0 ? 0 : bare.light(i).E) << off;
    }
  }
  EXPECT_GT(shadowed, 2000);
  EXPECT_GT(free, 20000);
  EXPECT_EQ(grazing, 0);
}

TEST(Illumination, surfaces_do_not_stand_in_their_own_light) {
  Random random(73);
  for (const double far : {0.0, 1e3, 1e6}) {  // large coordinates leave little of small distances
    Object box;
    box.name = "box";
    box.shape.type = ShapeType::box;
    box.shape.edges = {1, 1.5, 0.8};
    box.placing = moving({0, far + 5, 1.5, 0.3}, {0, 0.5, 0});
    Scene scene =
        scene_of(camera(64, 64, 0.9), {ball({0, far + 5, -1, 0}, 1), box}, {point_lamp({0, far + 1, 4, 3})});
    scene.observer.event = {0, far, 0, 0};
    const LightSink found = lit(scene);
    scene.lights.shadows = false;
    const LightSink bare = lit(scene);
    std::size_t differ = 0, lights = 0;
    for (std::size_t i = 0; i < found.hits.size(); ++i) {
      lights += bare.light(i).E > 0;
      differ += found.light(i).E != bare.light(i).E;
    }
    EXPECT_GT(lights, 300u);
    EXPECT_EQ(differ, 0u) << far;  // neither stands in the other's light here
  }
}

TEST(Illumination, translucent_spheres_take_their_part_twice_and_the_lamps_body_nothing) {
  const Vec3<double> lamp = {{0, 0, 3}};
  Object glass = ball({0, 5, 0, 1.2}, 0.7);
  glass.opacity = 0.3;
  glass.transparent = true;
  const auto factor = [&](std::uint32_t body) {
    Scene scene =
        scene_of(camera(80, 80, 1.1), {wall(), glass}, {point_lamp({0, lamp[0], lamp[1], lamp[2]})});
    scene.lights.lamps[0].body = body;
    const LightSink found = lit(scene);
    scene.lights.shadows = false;
    const LightSink bare = lit(scene);
    std::map<int, int> out;  // in thousandths
    for (std::size_t i = 0; i < found.hits.size(); ++i)
      if (found.hits[i].id == 1 && bare.light(i).E > 0)
        ++out[static_cast<int>(std::lround(1000 * found.light(i).E / bare.light(i).E))];
    return out;
  };
  const auto with = factor(0), without = factor(2);
  EXPECT_EQ(with.size(), 2u);
  EXPECT_GT(with.at(490), 100);  // 0.7^2
  EXPECT_GT(with.at(1000), 100);
  EXPECT_EQ(without.size(), 1u);
  EXPECT_TRUE(without.contains(1000));
}

TEST(Illumination, within_a_transparent_sphere_its_far_side_shades) {
  Object glass = ball({0, 5, 0, 0}, 4);
  glass.opacity = 0.25;
  glass.transparent = true;
  const Scene scene =
      scene_of(camera(40, 40, 0.2), {glass, ball({0, 5, 0, 0}, 0.5)}, {point_lamp({0, 0, 5, 0})});
  const LightSink found = lit(scene);
  std::size_t checked = 0;
  for (std::size_t i = 0; i < found.hits.size(); ++i) {
    if (found.hits[i].id != 2 || found.light(i).E == 0) continue;
    ++checked;
    EXPECT_LT(found.light(i).E, 0.75 / 12);
  }
  EXPECT_GT(checked, 100u);
}

TEST(Illumination, the_brightest_paths_are_kept_in_order) {
  std::array<HitLight, 3> among{};
  for (const double E : {2.0, 5.0, 1.0, 3.0, 0.0, 4.0})
    insert_light({E, 1, 0, 0}, among.data(), among.size());
  EXPECT_EQ(among[0].E, 5);
  EXPECT_EQ(among[1].E, 4);
  EXPECT_EQ(among[2].E, 3);
  insert_light({std::nan(""), 1, 0, 0}, among.data(), among.size());
  insert_light({9, std::nan(""), 0, 0}, among.data(), among.size());
  EXPECT_EQ(among[0].E, 5);
}

}  // namespace
}  // namespace nullcone::test
