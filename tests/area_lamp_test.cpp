// Lamps with area in flat spacetime: Weiskopf, Kraus and Ruder 1999, eq. (26), and soft shadows.
#include <gtest/gtest.h>

#include "tests/lit_scene.h"
#include "tests/random_rays.h"

namespace nullcone::test {
namespace {

using namespace host;

/// Irradiance from a parallel rectangle of intensity 1 along its normal, on the axis of its centre at
/// distance d: I/(ab) times the integral of cos^2/r^2.
double from_parallel_rectangle(double a, double b, double d) {
  double sum = 0;
  const int n = 400;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double x = a * ((i + 0.5) / n - 0.5), y = b * ((j + 0.5) / n - 0.5), r2 = x * x + y * y + d * d;
      sum += d * d / (r2 * r2);
    }
  return sum / (n * n);
}

TEST(AreaLamps, by_spheres_and_rectangles) {
  const auto brightest = [](Lamp lamp) {
    Scene scene = scene_of(camera(1, 1, 0.001), {wall()}, {std::move(lamp)});
    return lit(scene).light(0).E;
  };
  // A sphere of even radiance lights like a point at its centre as long as all of it stands above the
  // horizon.
  Lamp lamp = point_lamp({0, 7, 0, 0});
  const double point = brightest(lamp);
  EXPECT_NEAR(point, 1.0 / 9, 1e-12);
  lamp.type = ShapeType::sphere;
  lamp.samples = 4096;
  for (const double radius : {1e-6, 0.3, 2.5}) {
    lamp.radius = radius;
    EXPECT_NEAR(brightest(lamp), point, 2e-3 * point) << radius;
  }
  lamp.radius = 1e-6;
  lamp.samples = 4096;
  EXPECT_NEAR(brightest(lamp), point, 1e-4 * point);

  lamp.type = ShapeType::quad;
  lamp.placing.axes = {{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}};
  for (const double edge : {1e-6, 1.0, 4.0}) {
    lamp.edges = {edge, 0.5 * edge};
    EXPECT_NEAR(brightest(lamp), from_parallel_rectangle(edge, 0.5 * edge, 3), 1e-3 * point) << edge;
  }
}

TEST(AreaLamps, area_lamps_in_motion_are_as_bright_as_points) {
  // Eq. (26): a small sphere is a point whatever its speed, also obliquely.
  Random random(74);
  for (int n = 0; n < 30; ++n) {
    const Triple velocity = (random.uniform(0, 0.99) * random.direction()).c;
    const Vec3<double> place = {{random.uniform(-3, 5), random.uniform(-3, 3), random.uniform(-3, 3)}};
    Lamp lamp = point_lamp({-12, place[0], place[1], place[2]}, velocity);
    const auto light = [&] { return lit(scene_of(camera(1, 1, 0.001), {wall()}, {lamp})).light(0); };
    const HitLight point = light();
    lamp.type = ShapeType::sphere;
    lamp.radius = 1e-5;
    lamp.samples = 1024;
    const HitLight sphere = light();
    EXPECT_NEAR(sphere.E, point.E, 2e-3 * point.E);
    EXPECT_NEAR(sphere.shift, point.shift, 1e-3 * point.shift);
    EXPECT_NEAR(sphere.tau, point.tau, 1e-3);
  }
}

TEST(AreaLamps, soft_shadows_have_the_penumbra_of_geometry) {
  // A half-plane's edge (a long wall) at x = 5 between a lamp of radius 1 at x = 0 and the wall at x = 10:
  // the penumbra is as wide as the lamp, seen through the edge: 2 R (10 - 5)/5.
  Object screen = wall(100);
  screen.name = "screen";
  screen.placing.worldline.event = {0, 5, 50, 0};
  Lamp lamp = point_lamp({0, 0, 0, 0});
  lamp.type = ShapeType::sphere, lamp.radius = 1, lamp.samples = 2000;
  Scene scene = scene_of(camera(1, 1, 0.001), {wall(40), screen}, {lamp});
  const auto share = [&](double y) {
    // Seen from beside, so that the screen does not hide the place.
    scene.observer.event = {0, 9.9, y, 0};
    scene.lights.shadows = true;
    const double with = lit(scene).light(0).E;
    scene.lights.shadows = false;
    return with / lit(scene).light(0).E;
  };
  EXPECT_NEAR(share(0), 0.5, 0.02);
  EXPECT_EQ(share(1.05), 0);
  EXPECT_NEAR(share(-1.05), 1, 1e-12);
  EXPECT_GT(share(-0.5), 0.6);
  EXPECT_LT(share(0.5), 0.4);
}

}  // namespace
}  // namespace nullcone::test
