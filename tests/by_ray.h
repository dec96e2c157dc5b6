// The crossings of a traced picture, ray by ray.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/sanitized.h"
#include "tests/traced.h"

namespace nullcone::test {

struct RayOfPicture {
  std::size_t x, y;
  Status status;
  std::vector<HitRecord> hits;
  std::vector<HitDetail> details;
};

inline std::vector<RayOfPicture> by_ray(const Traced& traced) {
  std::vector<RayOfPicture> out;
  const auto width = static_cast<std::size_t>(traced.scene.camera.width);
  for (const TracedBand& band : traced.bands) {
    const std::size_t first = out.size();
    for (std::size_t i = 0; i < band.rays.size(); ++i)
      out.push_back(
          {(first + i) % width, (first + i) / width, static_cast<Status>(band.rays[i].status), {}, {}});
    for (std::size_t i = 0; i < band.hits.size(); ++i) {
      RayOfPicture& ray = out[first + band.hits[i].pixel];
      ray.hits.push_back(band.hits[i]);
      ray.details.push_back(band.details[i]);
    }
  }
  return out;
}

/// A scene's text from its metric's, observer's and camera's members, its objects, and what else.
inline std::string scene_of(const std::string& metric, const std::string& camera, const std::string& objects,
                            const std::string& more = "") {
  return R"({"metric": {"name": ")" + metric + R"("}, "camera": {)" + camera + R"(}, "objects": [)" +
         objects + "]" + (more.empty() ? "" : ", " + more) + "}";
}
inline std::string text_of(double x) {
  std::array<char, 32> out{};
  std::snprintf(out.data(), out.size(), "%.17g", x);
  return out.data();
}
inline std::string text_of(const host::Vec3<double>& X) {
  return "[" + text_of(X[0]) + ", " + text_of(X[1]) + ", " + text_of(X[2]) + "]";
}
inline std::string local_object(const std::string& name, const std::string& shape,
                                const host::Vec3<double>& centre, const std::string& more = "") {
  return R"({"name": ")" + name + R"(", "shape": )" + shape + more +
         R"(, "placing": {"type": "local", "worldline": {"type": "static", "event": [0, )" +
         text_of(centre).substr(1) + "}}}";
}
inline std::string sphere(double radius) {
  return R"({"type": "sphere", "radius": )" + text_of(radius) + "}";
}

inline const std::string kTransparent = R"(, "transparent": true)";
inline const std::string kSky = R"({"name": "heaven", "shape": {"type": "sky"}})";
inline const std::string kAtOrigin = R"("observer": {"event": [0, 0, 0, 0]})";

inline std::vector<std::uint32_t> ids(const RayOfPicture& ray) {
  std::vector<std::uint32_t> out;
  for (const HitRecord& hit : ray.hits) out.push_back(hit.id);
  return out;
}
using Ids = std::vector<std::uint32_t>;

inline void expect_sorted(const RayOfPicture& ray) {
  EXPECT_TRUE(std::ranges::is_sorted(ray.hits, {}, &HitRecord::Z));
}

/// Every ray enters the first object of a scene, a sphere, as often as it leaves it.
inline void expect_pairs(const std::string& scene, std::size_t fewest) {
  std::size_t pairs = 0;
  for (const RayOfPicture& ray : by_ray(trace_text(scene))) {
    expect_sorted(ray);
    std::size_t met = 0;
    for (const HitRecord& hit : ray.hits) met += hit.id == 1;
    EXPECT_EQ(met % 2, 0U) << ray.x << " " << ray.y << ": " << met;
    pairs += met > 0;
  }
  EXPECT_GT(pairs, kSanitized ? fewest / 2 : fewest);
}

}  // namespace nullcone::test
