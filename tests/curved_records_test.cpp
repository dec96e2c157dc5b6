// All crossings of curved rays: closed forms against integrated paths, and about a black hole.
#include <gtest/gtest.h>

#include "tests/by_ray.h"
#include "tests/sanitized.h"

namespace nullcone::test {
namespace {

TEST(Records, CurvedRaysLeaveWhatTheyEnter) {
  const std::string falling =
      R"({"name": "falling", "transparent": true, "shape": {"type": "sphere", "radius": 0.1},
    "placing": {"type": "local", "worldline": {"type": "geodesic", "event": [0, -0.5, -0.5, 0], "velocity": [0.1, 0.5, 0]},
    "axes": "gyroscope"}})";
  expect_pairs(scene_of("goedel", R"("type": "panorama", "fov_deg": [360, 60], "resolution": [300, 50])",
                        falling, kAtOrigin + R"(, "max_lookback": 5)"),
               50);
  const std::string wide = R"("type": "perspective", "azimuth_deg": 180, "fov_deg": 50, "resolution": )" +
                           std::string(kSanitized ? "[30, 22]" : "[120, 90]");
  const std::string ball = local_object("ball", sphere(1.5), {{-7, 0.5, 0}}, kTransparent) + "," + kSky;
  expect_pairs(
      scene_of("kerr_schild", wide, ball, R"("observer": {"event": [0, 15, 0, 1]}, "accuracy": "draft")"),
      100);
}

/// The crossings of the closed form against those of integrated paths, one by one.
void expect_same_crossings(const std::string& closed, const std::string& integrated, double tolerance) {
  const auto a = by_ray(trace_text(closed)), b = by_ray(trace_text(integrated));
  std::size_t same = 0, other = 0, most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    expect_sorted(a[i]);
    expect_sorted(b[i]);
    if (ids(a[i]) != ids(b[i])) {  // edges of quads and grazing rays
      ++other;
      continue;
    }
    EXPECT_EQ(a[i].status, b[i].status);
    most = std::max(most, a[i].hits.size());
    for (std::size_t n = 0; n < a[i].hits.size(); ++n, ++same) {
      const HitRecord &h = a[i].hits[n], &k = b[i].hits[n];
      EXPECT_NEAR(h.Z, k.Z, tolerance / std::min(h.mu + 1e-3, 1.0)) << i << " " << n;
    }
  }
  EXPECT_GT(same, a.size() / 4);
  EXPECT_LE(other, a.size() / 200) << "of " << a.size();
  EXPECT_GT(most, 5U);
}

TEST(Records, GoedelRaysMeetTheSameThingsAgain) {
  // Rays return to the observer after 2 pi a and less: two turns meet every object again and again.
  const std::string objects =
      local_object("ball", sphere(0.25), {{0.7, 0.3, 0}}, kTransparent) + "," +
      local_object("other", sphere(0.15), {{-0.4, 0.6, 0.05}}, kTransparent) + "," +
      R"({"name": "card", "transparent": true, "shape": {"type": "quad", "edges": [0.6, 0.8]},
    "placing": {"type": "local", "worldline": {"type": "static", "event": [0, 0.2, -0.7, 0]}, "z_axis": [0.6, 1, 0.3]}})";
  const std::string camera = R"("type": "panorama", "fov_deg": [360, 40], "resolution": )" +
                             std::string(kSanitized ? "[60, 7]" : "[240, 27]");
  const std::string scene =
      scene_of("goedel", camera, objects, R"("observer": {"event": [0.3, 0.1, -0.1, 0]})");
  const std::string integrated = R"({"paths": "integrated", "accuracy": "reference", )" + scene.substr(1);
  expect_same_crossings(scene, integrated, 1e-7);
}

TEST(Records, APlaneThroughAHole) {
  const std::string objects =
      R"({"name": "plane", "transparent": true, "shape": {"type": "quad", "edges": [40, 40]},
    "placing": {"type": "coordinate", "centre": [0, 0, 0]}}, )" +
      kSky;
  const std::string camera = R"("type": "perspective", "azimuth_deg": 180, "elevation_deg": -8, "fov_deg": 60,
    "resolution": )" + std::string(kSanitized ? "[31, 21]" : "[121, 81]");
  const auto rays = by_ray(
      trace_text(scene_of("kerr_schild", camera, objects, R"("observer": {"event": [0, 30, 0, 4.2]})")));
  const auto fine = by_ray(trace_text(scene_of(
      "kerr_schild", camera, objects,
      R"("observer": {"event": [0, 30, 0, 4.2]}, "accuracy": {"rtol": 1e-12, "integrator": "dopri5"})")));
  std::size_t other = 0, sky_behind = 0, captured_behind = 0, twice = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    expect_sorted(rays[i]);
    other +=
        ids(rays[i]) != ids(fine[i]) || (rays[i].status == Status::sky) != (fine[i].status == Status::sky);
    const std::size_t met = rays[i].hits.size();
    if (rays[i].status == Status::sky) {
      ASSERT_GT(met, 0U);
      EXPECT_EQ(rays[i].hits.back().id, 2U);
      sky_behind += met > 1;
      twice += met > 2;
    } else {
      // Nothing rests in the ergosphere: who meets the plane there has no ratio of frequencies.
      EXPECT_TRUE(rays[i].status == Status::captured || rays[i].status == Status::not_finite);
      captured_behind += met > 0;
    }
  }
  EXPECT_LE(other, 2 + rays.size() / 1000);
  EXPECT_GT(sky_behind, rays.size() / 10);
  EXPECT_GT(captured_behind, 10U);
  EXPECT_GT(twice, 10U);
}

}  // namespace
}  // namespace nullcone::test
