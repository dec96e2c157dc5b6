// Shadows along integrated rays, where all is straight.
#include <gtest/gtest.h>

#include "core/trace/integrated_shadow.h"
#include "metrics/minkowski_kernel.h"
#include "tests/random_rays.h"

namespace nullcone::test {
namespace {

using namespace host;

using FlatObject = MarchObject<Minkowski>;
template <class S>
FlatObject at_rest(std::uint32_t number, const Vec3<double>& place, const S& shape) {
  const ChartBody<Minkowski> body{
      {}, {{0, place[0], place[1], place[2]}}, {{{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}}};
  const double ball = shape.bounding_radius();
  return {number, true, ball,
          place,  ball, {Marched<FixedMap, ChartBody<Minkowski>, S>{{place, body.axes, 1}, body, shape}}};
}

TEST(Shadows, NoSurfaceShadesItselfHoweverLongTheWay) {
  // Steps add up to the length but for rounding: what is left must not count as a step of its own.
  const FlatObject board = at_rest(1, {{0, 0, 0}}, AnyShape(Box{100, 100, 0}));
  const double opaque = 1;
  const MarchSetting<Minkowski> march{{{}}, kBalanced, 1e6, &board, 1, {}, 1000, kFar, 0};
  PrinceDormand87<Pack> stepper;
  Random random(6);
  int dark = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3<double> from = {{random.uniform(-50, 50), random.uniform(-50, 50), 0}},
                       way = Vec3<double>{{random.uniform(-50, 50), random.uniform(-50, 50),
                                           random.uniform(1, 40)}} -
                             from,
                       n = normalised(way);
    const auto shade = light_through(stepper, ShadowSetting<Minkowski>{&march, &opaque, 0}, 1,
                                     convert<Pack>(Vec4<double>{{1, from[0], from[1], 0}}),
                                     convert<Pack>(Vec4<double>{{-1, n[0], n[1], n[2]}}), Pack(norm(way)),
                                     Pack(0.0) == Pack(0.0));
    dark += shade.through.get(0) < 1;
  }
  EXPECT_EQ(dark, 0);
}

TEST(Shadows, OfSpheresBoxesAndRectangles) {
  // Between the plane z = 0 and a lamp at (0, 0, 10): a glass sphere, a box, a sheet, and the lamp's globe.
  const std::array<FlatObject, 5> objects = {
      at_rest(1, {{-3, 0, 5}}, Sphere{1}), at_rest(2, {{3, 0, 5}}, AnyShape(Box{1, 1, 0.5})),
      at_rest(3, {{0, 3, 5}}, AnyShape(Box{1, 1, 0})), at_rest(4, {{0, 0, 10}}, Sphere{0.5}),
      at_rest(5, {{0, 0, -50}}, Sphere{50})};
  const std::array<double, 5> opacity = {0.4, 1, 0.3, 1, 1};
  const MarchSetting<Minkowski> march{{{}}, kBalanced, 1e6, objects.data(), 5, {}, 100, kFar, 0};
  const ShadowSetting<Minkowski> setting{&march, opacity.data(), 4};
  PrinceDormand87<Pack> stepper;
  const auto through = [&](const Vec3<double>& from, std::uint32_t own, const ShadowSetting<Minkowski>& how) {
    const Vec3<double> way = Vec3<double>{{0, 0, 10}} - from, n = normalised(way);
    const Vec4<Pack> event = convert<Pack>(Vec4<double>{{1, from[0], from[1], from[2]}});
    const auto shade =
        light_through(stepper, how, own, event, convert<Pack>(Vec4<double>{{-1, n[0], n[1], n[2]}}),
                      Pack(norm(way)), Pack(0.0) == Pack(0.0));
    EXPECT_FALSE(any(shade.lost));
    EXPECT_EQ(shade.through.get(0), shade.through.get(1));
    return shade.through.get(0);
  };
  Random random(5);
  for (int i = 0; i < 500; ++i) {
    const Vec3<double> from = {{random.uniform(-12, 12), random.uniform(-12, 12), 1}};
    const Vec3<double> to_lamp = Vec3<double>{{0, 0, 10}} - from, n = normalised(to_lamp);
    const auto at_height = [&](double z) { return from + (z - from[2]) / n[2] * n; };
    const Vec3<double> low = at_height(4.5), middle = at_height(5), high = at_height(5.5);
    const Vec3<double> centre = Vec3<double>{{-3, 0, 5}} - from;
    double expected = norm(cross(centre, n)) < 1 ? 0.36 : 1;
    if (std::fabs(middle[0]) < 1 && std::fabs(middle[1] - 3) < 1) expected *= 0.7;
    const auto in_box = [](const Vec3<double>& X) { return std::fabs(X[0] - 3) < 1 && std::fabs(X[1]) < 1; };
    bool boxed = false;
    for (int k = 0; k <= 1000; ++k) boxed = boxed || in_box(low + k / 1000.0 * (high - low));
    if (boxed) expected = 0;
    EXPECT_NEAR(through(from, 0, setting), expected, 1e-12) << i;
    if (expected > 0) {
      EXPECT_EQ(through(from, 0, {&march, opacity.data(), 0}), 0) << "the lamp's globe in its own light";
    }
  }
  // Surfaces do not hide the lamp from themselves, unless they are turned away from it.
  for (int i = 0; i < 200; ++i) {
    const Vec3<double> n = random.direction();
    const double above = Vec3<double>{{0, 0, 60}}[2] * n[2] - 50;  // of the lamp over the tangent plane
    if (std::fabs(above) < 1e-3) continue;
    const Vec3<double> from = Vec3<double>{{0, 0, -50}} + 50.0 * n;
    if (above > 0 && std::fabs(from[0]) > 0.5) continue;  // may stand behind the others
    EXPECT_EQ(through(from, 5, setting), above > 0 ? 1 : 0) << i;
  }
  EXPECT_EQ(through({{3, 0.5, 5.5}}, 2, setting), 1);          // the box's upper face
  EXPECT_EQ(through({{3, 0.5, 4.5}}, 2, setting), 0);          // its lower one
  EXPECT_EQ(through({{0.2, 3.5, 5}}, 3, setting), 1);          // the sheet
  EXPECT_NEAR(through({{-3, 0, 4}}, 1, setting), 0.6, 1e-12);  // out of the glass, from its far side
}

}  // namespace
}  // namespace nullcone::test
