// All crossings of a ray: behind what is transparent, from inside, grazing, and as many as a scene asks for.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>

#include "tests/by_ray.h"
#include "tests/sanitized.h"

namespace nullcone::test {
namespace {

using namespace host;

const std::string kWide = R"("type": "perspective", "fov_deg": 60, "resolution": [61, 43])";
const std::string kOneRay = R"("type": "perspective", "fov_deg": 60, "resolution": [1, 1])";

TEST(Records, ATransparentSphereIsEnteredAndLeft) {
  const Vec3<double> C = {{5, 0.7, -0.4}};
  const double R = 1.5;
  const Traced traced = trace_text(
      scene_of("minkowski", kWide, local_object("ball", sphere(R), C, kTransparent) + "," + kSky, kAtOrigin));
  std::size_t through = 0;
  for (const RayOfPicture& ray : by_ray(traced)) {
    const Vec3<double> d = traced.look(ray.x, ray.y);
    const double middle = dot(C, d), square = R * R - dot(cross(C, d), cross(C, d));
    EXPECT_EQ(ray.status, Status::sky);
    if (square < 0) {
      EXPECT_EQ(ids(ray), Ids{2});
      continue;
    }
    ++through;
    ASSERT_EQ(ids(ray), (Ids{1, 1, 2}));
    const double half = std::sqrt(square), rounding = 1e-14 / half + 1e-14;
    EXPECT_NEAR(ray.hits[0].Z, middle - half, rounding);
    EXPECT_NEAR(ray.hits[1].Z, middle + half, rounding);
    EXPECT_NEAR(ray.hits[0].mu, half / R, rounding);
    EXPECT_NEAR(ray.hits[1].mu, half / R, rounding);
    EXPECT_EQ(ray.hits[2].Z, std::numeric_limits<double>::infinity());
  }
  EXPECT_GT(through, 500U);
}

TEST(Records, NestedSpheresAreMetInOrder) {
  std::string objects;
  for (const double R : {1.0, 0.3, 0.6})
    objects +=
        local_object("r" + std::to_string(std::lround(10 * R)), sphere(R), {{4, 0, 0}}, kTransparent) + ",";
  const Traced traced = trace_text(scene_of("minkowski", kWide, objects + kSky, kAtOrigin));
  std::map<std::size_t, std::size_t> counts;
  for (const RayOfPicture& ray : by_ray(traced)) {
    expect_sorted(ray);
    const Ids found = ids(ray);
    EXPECT_TRUE(found == (Ids{1, 3, 2, 2, 3, 1, 4}) || found == (Ids{1, 3, 3, 1, 4}) ||
                found == (Ids{1, 1, 4}) || found == Ids{4});
    ++counts[found.size()];
  }
  EXPECT_GT(counts[7], 40U);
}

const std::string kCard = R"({"type": "quad", "edges": [2, 2]})";

TEST(Records, CoincidentCardsAreBothMet) {
  const std::string card =
      R"(, "placing": {"type": "local", "worldline": {"type": "static", "event": [0, 4, 0, 0]},
    "z_axis": [1, 0.4, 0.3]}})";
  std::string objects;
  for (const char* name : {"a", "b"})
    objects += std::string(R"({"name": ")") + name + R"(", "shape": )" + kCard + kTransparent + card + ",";
  std::size_t met = 0;
  for (const RayOfPicture& ray :
       by_ray(trace_text(scene_of("minkowski", kWide, objects + kSky, kAtOrigin)))) {
    expect_sorted(ray);
    EXPECT_EQ(ids(ray).back(), 3U);
    if (ray.hits.size() == 1) continue;
    ++met;
    ASSERT_EQ(ray.hits.size(), 3U);
    EXPECT_EQ(ray.hits[0].id + ray.hits[1].id, 3U);
    EXPECT_NEAR(ray.hits[0].Z, ray.hits[1].Z, 1e-14);
  }
  EXPECT_GT(met, 100U);
}

TEST(Records, GrazingChordsHaveTwoEnds) {
  // Chords along the x axis through spheres of radius 1: from far below what rounding resolves to 1e-3.
  for (const double distance : {3.0, 1e3, 1e6}) {
    std::string objects;
    std::vector<double> chords;
    for (double chord = 1e-12; chord < 2e-3; chord *= 1.3) {
      chords.push_back(chord);
      objects +=
          local_object(
              "o" + std::to_string(chords.size()), sphere(1),
              {{distance + 5 * static_cast<double>(chords.size()), std::sqrt(1 - 0.25 * chord * chord), 0}},
              kTransparent) +
          ",";
    }
    const RayOfPicture ray =
        by_ray(trace_text(scene_of("minkowski", kOneRay, objects + kSky, kAtOrigin))).at(0);
    expect_sorted(ray);
    EXPECT_EQ(ray.status, Status::sky);
    std::map<std::uint32_t, std::vector<double>> Z;
    for (const HitRecord& hit : ray.hits) Z[hit.id].push_back(hit.Z);
    for (std::uint32_t i = 0; i < chords.size(); ++i) {
      const auto& found = Z[i + 1];
      EXPECT_TRUE(found.empty() || found.size() == 2) << found.size() << " " << chords[i] << " " << distance;
      if (chords[i] < 1e-6 * distance) continue;
      ASSERT_EQ(found.size(), 2U) << chords[i];
      EXPECT_NEAR(found[1] - found[0], chords[i], 1e-14 * distance / chords[i]) << chords[i];
    }
  }
}

TEST(Records, LimbsUnderTheTelescope) {
  const double degrees = 180 / std::numbers::pi;
  for (const double fov : {1.0, 1e-3, 1e-6, 1e-9}) {
    const std::string telescope =
        R"("type": "perspective", "resolution": [40, 40], "fov_deg": )" + text_of(fov);
    const std::string azimuth = R"(, "azimuth_deg": )" + text_of(degrees * std::asin(0.2));
    expect_pairs(scene_of("minkowski", telescope + azimuth,
                          local_object("o", sphere(1), {{5, 0, 0}}, kTransparent) + "," + kSky, kAtOrigin),
                 100);
    expect_pairs(scene_of("minkowski", telescope + azimuth,
                          local_object("o", sphere(1), {{5, 0, 0}}, kTransparent) + "," + kSky,
                          kAtOrigin + R"(, "paths": "integrated")"),
                 100);
  }
}

TEST(Records, ACardSeenEdgeOnIsMetOnce) {
  for (const double angle : {1e-1, 1e-4, 1e-6, 1e-7, 1e-8})
    for (const std::string paths : {"closed", "integrated"})
      for (const double height : {0.0, 0.3}) {  // at the middle of the card, and off it
        const std::string card =
            R"({"name": "card", "transparent": true, "shape": {"type": "quad", "edges": [2, 2]},
          "placing": {"type": "local", "worldline": {"type": "static", "event": [0, 5, 0, )" +
            text_of(height * angle) + R"(]}, "z_axis": [)" + text_of(std::sin(angle)) + ", 0, " +
            text_of(std::cos(angle)) + "]}},";
        const RayOfPicture ray =
            by_ray(trace_text(scene_of("minkowski", kOneRay, card + kSky,
                                       kAtOrigin + (paths == "closed" ? "" : R"(, "paths": "integrated")"))))
                .at(0);
        EXPECT_EQ(ids(ray), (Ids{1, 2})) << angle << " " << paths << " " << height;
        EXPECT_NEAR(ray.hits[0].Z, 5 + height * std::cos(angle) / std::cos(angle),
                    1e-14 / angle + 0.3 * angle * angle + 1e-13);
      }
}

TEST(Records, OpaqueSurfacesEndARay) {
  const std::string objects = local_object("glass", sphere(1), {{6, 0, 0}}, kTransparent) + "," +
                              local_object("stone", sphere(0.2), {{6, 0, 0}}) + "," +
                              local_object("behind", sphere(0.5), {{9, 0, 0}}, kTransparent) + "," + kSky;
  std::map<Ids, std::size_t> seen;
  for (const RayOfPicture& ray : by_ray(trace_text(scene_of("minkowski", kWide, objects, kAtOrigin)))) {
    const Ids found = ids(ray);
    ++seen[found];
    EXPECT_EQ(ray.status, found.back() == 2 ? Status::hit : Status::sky);
  }
  EXPECT_EQ(seen.size(), 4U);
  EXPECT_GT((seen[Ids{1, 2}]), 3U);
  EXPECT_GT((seen[Ids{1, 1, 3, 3, 4}]), 3U);
  EXPECT_GT((seen[Ids{1, 1, 4}]), 3U);
  EXPECT_GT((seen[Ids{4}]), 3U);
}

TEST(Records, AsManyCrossingsAsAskedFor) {
  const std::string dome =
      R"({"name": "dome", "shape": {"type": "sphere", "radius": 10, "dome": true}, "placing": {
    "type": "coordinate", "centre": [0, 0, 0]}})";
  const std::string objects = local_object("a", sphere(1), {{4, 0, 0}}) + "," +
                              local_object("b", sphere(0.5), {{4, 0, 0}}) + "," + dome + "," + kSky;
  const Ids all = {1, 2, 2, 1, 3, 4};
  for (const std::string paths : {"", R"(, "paths": "integrated")"})
    for (std::uint32_t most = 0; most < 8; ++most) {
      const std::string records =
          most == 0 ? "" : R"(, "records": {"max_hits": )" + std::to_string(most) + "}";
      const RayOfPicture ray =
          by_ray(trace_text(scene_of("minkowski", kOneRay, objects, kAtOrigin + paths + records))).at(0);
      const std::size_t expected = most == 0 ? 1 : std::min<std::size_t>(most, all.size());
      EXPECT_EQ(ids(ray), Ids(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(expected)))
          << most << paths;
      EXPECT_EQ(ray.status, expected == all.size() ? Status::sky : Status::hit) << most << paths;
    }
}

}  // namespace
}  // namespace nullcone::test
