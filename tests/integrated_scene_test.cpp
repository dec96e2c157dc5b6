// Scenes traced along integrated rays: against closed forms where there are some, and against themselves.
#include <gtest/gtest.h>

#include "tests/random_rays.h"
#include "tests/same_picture.h"

namespace nullcone::test {
namespace {

const std::string kGoedelSpheres =
    R"({"metric": {"name": "goedel"}, "observer": {"event": [0.5, 0.1, -0.2, 0.1]},
  "camera": {"type": "sphere", "resolution": )" +
    pixels(240, 120) + R"(}, "max_lookback": 9, "objects": [
  {"name": "a", "shape": {"type": "sphere", "radius": 0.3}, "placing": {"type": "local", "worldline":
    {"type": "static", "event": [0, 0.9, 0.1, 0]}}},
  {"name": "b", "shape": {"type": "sphere", "radius": 0.15}, "placing": {"type": "coordinate",
    "centre": [0.4, 0.8, 0.2]}},
  {"name": "c", "shape": {"type": "quad", "edges": [0.6, 0.4]}, "placing": {"type": "local", "worldline":
    {"type": "static", "event": [0, -0.5, -0.6, -0.1]}, "z_axis": [1, 0.5, 0.2]}}]})";

TEST(Integrated, GoedelLooksTheSameAsItsClosedForm) {
  const auto expect = [](const std::string& accuracy, double limit) {
    expect_same_picture(kGoedelSpheres,
                        with(kGoedelSpheres, R"("paths": "integrated", "accuracy": )" + accuracy), limit, 1);
  };
  expect(R"("reference")", 1e-8);
  expect(R"("balanced")", 1e-5);
  expect(R"({"rtol": 1e-9, "integrator": "dopri5"})", 1e-6);
  expect(R"({"rtol": 1e-9, "integrator": "verner65"})", 1e-6);
  expect(R"({"rtol": 1e-9, "integrator": "fehlberg78"})", 1e-6);
}

TEST(Integrated, MinkowskiLooksTheSameAsItsClosedForm) {
  // Moving objects, a moving observer and the sky; steps grow without bound here, past all objects.
  const std::string scene = R"({"metric": {"name": "minkowski"}, "observer": {"event": [5, 0, 0, 0],
    "velocity": [0.3, 0.1, -0.2]}, "camera": {"type": "perspective", "fov_deg": 110, "resolution": )" +
                            pixels(160, 100) + R"(},
    "objects": [
    {"name": "ball", "shape": {"type": "sphere", "radius": 1}, "placing": {"type": "local", "worldline":
      {"type": "geodesic", "event": [0, 4, 0, 0], "velocity": [0, 0.9, 0.1]}}},
    {"name": "card", "shape": {"type": "quad", "edges": [3, 2]}, "placing": {"type": "local", "worldline":
      {"type": "geodesic", "event": [0, 5, 1, 1], "velocity": [-0.2, 0, 0.5]}, "z_axis": [-1, 0.2, 0.1]}},
    {"name": "heaven", "shape": {"type": "sky"}}]})";
  expect_same_picture(scene, with(scene, R"("paths": "integrated")"), 1e-9, 1);
}

std::string numbers(std::initializer_list<double> list) {
  std::string out;
  for (const double x : list) out += (out.empty() ? "" : ", ") + std::to_string(x);
  return "[" + out + "]";
}

/// Small spheres and slivers at random places.
std::string clutter(Random& random, int count, double least, double most, double size) {
  std::string objects;
  for (int i = 0; i < count; ++i) {
    const auto place = random.logarithmic(least, most) * random.direction();
    const std::string shape = i % 2
                                  ? R"({"type": "sphere", "radius": )" + std::to_string(size) + "}"
                                  : R"({"type": "quad", "edges": )" + numbers({0.2 * size, 15 * size}) + "}";
    objects += R"({"name": "o)" + std::to_string(i) + R"(", "shape": )" + shape +
               R"(, "placing": {"type": "coordinate", "centre": )" + numbers({place[0], place[1], place[2]}) +
               R"(, "z_axis": )" + numbers({1, 0.3, random.normal()}) + "}},";
  }
  return objects;
}

TEST(Integrated, SmallAndThinThingsAreNeverSteppedOver) {
  // In flat spacetime a step may be longer than everything; straight lines know what is met.
  Random random(11);
  for (int trial = 0; trial < (kSanitized ? 1 : 8); ++trial) {
    const std::string scene = R"({"metric": {"name": "minkowski"}, "observer": {"event": [0, 0, 0, 0]},
      "camera": {"type": "sphere", "resolution": )" +
                              pixels(400, 200) + R"(}, "objects": [)" +
                              clutter(random, 12, 1, 50, random.logarithmic(0.003, 0.3)) +
                              R"({"name": "heaven", "shape": {"type": "sky"}}]})";
    const Traced exact = trace_text(scene), found = trace_text(with(scene, R"("paths": "integrated")"));
    for (std::size_t band = 0; band < exact.bands.size(); ++band) {
      const auto &a = exact.bands[band].hits, &b = found.bands[band].hits;
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(a[i].id, b[i].id) << scene;
        ASSERT_TRUE(a[i].Z == b[i].Z || std::fabs(a[i].Z - b[i].Z) < 1e-9 * a[i].Z)
            << a[i].Z << " " << b[i].Z;
      }
    }
  }
}

TEST(Integrated, GrazingAndThinThingsAboutABlackHole) {
  // Large steps against steps cut small by the tolerance: what is seen must be the same.
  Random random(12);
  const std::string scene =
      R"({"metric": {"name": "kerr_schild", "spin": 0.8}, "observer": {"event": [0, 40, 0, 5]},
    "camera": {"type": "perspective", "azimuth_deg": 180, "elevation_deg": -7, "fov_deg": 70,
    "resolution": )" +
      pixels(220, 170) + R"(}, "objects": [)" + clutter(random, 14, 4, 30, 0.25) +
      R"({"name": "heaven", "shape": {"type": "sky"}}]})";
  const std::string fine = with(scene, R"("accuracy": {"rtol": 1e-13, "integrator": "dopri5"})");
  expect_same_picture(scene, fine, 1e-5, 10);
  expect_same_picture(with(scene, R"("accuracy": {"rtol": 1e-10, "integrator": "verner65"})"), fine, 1e-5,
                      10);
}

TEST(Integrated, AHoleSeenFromAboveIsRound) {
  // Spin 0 from r = 15: the shadow is a disc of the half angle that theory says; what rests shifts by known
  // ratios.
  const double r = 15, half = std::asin(5.196152422706632 * std::sqrt(1 - 2 / r) / r);
  constexpr std::size_t kPixels = kSanitized ? 151 : 301;
  const std::string pixels = std::to_string(kPixels);
  const Traced seen = trace_text(R"({"metric": {"name": "kerr_schild"}, "observer": {"event": [0, 0, 0, 15]},
    "camera": {"type": "perspective", "elevation_deg": -90, "fov_deg": 60, "resolution": [)" +
                                 pixels + ", " + pixels + R"(]}, "objects": [
    {"name": "ball", "shape": {"type": "sphere", "radius": 0.4}, "placing": {"type": "local", "worldline": {"type":
      "static", "event": [0, 6, 0, 0]}}}, {"name": "heaven", "shape": {"type": "sky"}}]})");
  for (std::size_t band = 0; band < seen.bands.size(); ++band)
    for (std::size_t i = 0; i < seen.bands[band].rays.size(); ++i) {
      const RayRecord& ray = seen.bands[band].rays[i];
      const double angle = std::acos(-seen.look(i % kPixels, band * kBandLines + i / kPixels)[2]);
      const bool dark = ray.status == static_cast<std::uint32_t>(Status::captured);
      ASSERT_TRUE(dark == (angle < half) || ray.status == 0 || std::fabs(angle - half) < 1e-6) << angle;
      ASSERT_LT(ray.drift, 1e-6F);
    }
  EXPECT_GT(seen.rays_with(Status::captured), kPixels * kPixels / 9);
  double sum = 0,
         count = 0;  // g = sqrt(f_em / f_obs); the ball is small against the curvature, but not a point
  seen.for_each_hit([&](const HitRecord& hit, std::size_t, std::size_t) {
    ASSERT_TRUE(hit.id == 1 || std::fabs(hit.shift - 1 / std::sqrt(1 - 2 / r)) < 1e-7) << hit.shift;
    if (hit.id == 1) sum += hit.shift, count += 1;
  });
  EXPECT_NEAR(sum / count, std::sqrt((1 - 2 / 6.0) / (1 - 2 / r)), 5e-3);
}

TEST(Integrated, AWormholeShowsTwoSkies) {
  // From l = 3 b the other sky fills the disc sin psi < b / sqrt(b^2 + l^2).
  const double l = 3, rho = 0.5 * (l + std::sqrt(l * l + 1)), half = std::asin(1 / std::sqrt(10.0));
  const Traced seen =
      trace_text(R"({"metric": {"name": "ellis_wormhole"}, "observer": {"event": )" +
                 numbers({0, 0, 0, rho}) + R"(}, "camera": {"type": "perspective", "elevation_deg": -90,
    "fov_deg": 80, "resolution": [201, 201]}, "objects": [{"name": "here", "shape": {"type": "sky"}},
    {"name": "there", "shape": {"type": "sky", "side": 2}}]})");
  EXPECT_EQ(seen.hits(), 201U * 201U);
  seen.for_each_hit([&](const HitRecord& hit, std::size_t x, std::size_t y) {
    const double angle = std::acos(-seen.look(x, y)[2]);
    ASSERT_TRUE(hit.id == (angle < half ? 2U : 1U) || std::fabs(angle - half) < 1e-5) << angle;
    ASSERT_NEAR(hit.shift, 1, 1e-7);
  });
}

/// A picture in a wormhole of throat 1: an object of the chart, both skies, an observer on the x axis.
Traced in_wormhole(double from, double towards, const std::string& shape, double centre) {
  return trace_text(R"({"metric": {"name": "ellis_wormhole"}, "observer": {"event": )" +
                    numbers({0, from, 0, 0}) + R"(}, "camera": {"type": "perspective", "forward": )" +
                    numbers({towards, 0, 0}) + R"(, "fov_deg": 50, "resolution": [81, 81]}, "objects": [
    {"name": "ball", "shape": )" +
                    shape + R"(, "placing": {"type": "coordinate",
      "z_axis": [1, 0, 0], "centre": )" +
                    numbers({centre, 0, 0}) + R"(}},
    {"name": "here", "shape": {"type": "sky"}}, {"name": "there", "shape": {"type": "sky", "side": 2}}]})");
}

TEST(Integrated, TheOtherSideOfAWormholeIsSeenAsFromThere) {
  // X -> X/(4 rho^2) is an isometry: of spheres it makes spheres, of left right. This one is near the other
  // side's infinity, nearer than it is large.
  const double c = 0.1, r = 0.075, power = 4 * (c * c - r * r), from = 4;
  const auto sphere = [](double radius) {
    return R"({"type": "sphere", "radius": )" + std::to_string(radius) + "}";
  };
  const Traced a = in_wormhole(from, -1, sphere(r), c),
               b = in_wormhole(1 / (4 * from), 1, sphere(r / power), c / power);
  ASSERT_EQ(a.hits(), 81U * 81U);
  ASSERT_EQ(b.hits(), 81U * 81U);
  std::vector<HitRecord> other(b.hits());
  b.for_each_hit([&](const HitRecord& hit, std::size_t x, std::size_t y) { other[81 * y + 80 - x] = hit; });
  std::size_t on_ball = 0, elsewhere = 0;
  a.for_each_hit([&](const HitRecord& hit, std::size_t x, std::size_t y) {
    const HitRecord& twin = other[81 * y + x];
    if (hit.id != (twin.id == 1 ? 1 : 5 - twin.id)) return void(++elsewhere);
    if (hit.id != 1) return;
    ++on_ball;
    EXPECT_NEAR(hit.t, twin.t, 1e-5);
    EXPECT_NEAR(hit.Z, twin.Z, 1e-5);
    EXPECT_NEAR(hit.mu, twin.mu, 1e-5 / std::max(hit.mu, 0.01));
  });
  EXPECT_GT(on_ball, 100U);
  EXPECT_LE(elsewhere, 8U) << "rays that graze";
}

TEST(Integrated, RaysEscapeThroughARingAboutTheOtherInfinity) {
  const Traced seen = in_wormhole(4, -1, R"({"type": "ring", "inner_radius": 0.1, "radius": 0.3})", 0.05);
  EXPECT_EQ(seen.hits(), 81U * 81U);
  std::array<std::size_t, 4> of{};
  seen.for_each_hit([&](const HitRecord& hit, std::size_t, std::size_t) { ++of[hit.id]; });
  for (const std::size_t id : {1U, 2U, 3U}) EXPECT_GT(of[id], 100U) << id;
}

}  // namespace
}  // namespace nullcone::test
