// Cameras in scenes: how they are read, and that what they see is what any other camera sees there.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/record/dataset.h"
#include "tests/sanitized.h"
#include "tests/traced.h"

namespace nullcone::test {
namespace {

using nlohmann::json;

json scene_with(const json& camera, const std::string& metric = "minkowski") {
  json out = json::parse(R"({"observer": {"event": [1, 0.2, -0.1, 0.1], "velocity": [0.1, 0.3, -0.2]},
    "max_lookback": 9, "records": {"differentials": true}, "objects": [
    {"name": "dome", "shape": {"type": "sphere", "radius": 1.2, "dome": true},
     "placing": {"type": "coordinate", "centre": [0, 0, 0]}},
    {"name": "ball", "shape": {"type": "sphere", "radius": 0.3}, "placing": {"type": "local", "axes": "gyroscope",
      "worldline": {"type": "geodesic", "event": [0, 0, 0.6, 0], "velocity": [0.5, 0, 0]}}},
    {"name": "house", "shape": {"type": "box", "edges": [0.4, 0.3, 0.2]}, "placing": {"type": "local",
      "worldline": {"type": "static", "event": [0, -0.5, -0.3, 0.1]}}}]})");
  out["metric"]["name"] = metric;
  if (metric == "kerr_schild") {
    out["observer"] = {{"event", {0, 20, 0, 0}}};
    out["objects"] = json::parse(R"([{"name": "heaven", "shape": {"type": "sky"}}])");
    out["accuracy"] = "draft";
    out.erase("max_lookback");
  }
  out["camera"] = camera;
  return out;
}

Camera read(const json& camera) {
  const auto metrics = metric_descriptions();
  return read_scene(scene_with(camera).dump(), "file", metrics).camera;
}

std::vector<json> new_cameras() {
  const json common = {{"azimuth_deg", 150}, {"elevation_deg", 12}, {"roll_deg", 40}};
  std::vector<json> out = {{{"type", "fisheye"}, {"fov_deg", 250}, {"resolution", {33, 31}}},
                           {{"type", "cube_map"}, {"resolution", {66, 11}}},
                           {{"type", "tetrahedron_map"}, {"resolution", {42, 21}}}};
  for (json& camera : out) camera.update(common);
  return out;
}

/// The crossing that a panorama of one pixel sees straight ahead.
std::vector<HitRecord> seen_along(const host::Vec3<double>& m, const std::string& metric) {
  const json camera = {{"type", "panorama"},
                       {"fov_deg", {1, 1}},
                       {"resolution", {1, 1}},
                       {"forward", {m[0], m[1], m[2]}},
                       {"up", {-m[1] + 0.1, m[2], m[0]}}};
  return trace_text(scene_with(camera, metric).dump(), 1).bands.at(0).hits;
}

TEST(CameraScene, EveryCameraSeesTheSameInADirection) {
  for (const std::string metric : {"minkowski", "goedel"})
    for (const json& camera : new_cameras()) {
      const Traced traced = trace_text(scene_with(camera, metric).dump());
      std::size_t n = 0;
      std::array<std::size_t, 4> met{};
      traced.for_each_hit([&](const HitRecord& hit, std::size_t x, std::size_t y) {
        ++met[hit.id];
        if (++n % (kSanitized ? 20 : 3) != 0) return;
        const auto other = seen_along(traced.look(x, y), metric);
        ASSERT_EQ(other.size(), 1U);
        ASSERT_EQ(other[0].id, hit.id);
        // A direction's last bit, some hundred times: lenses and oblique surfaces.
        ASSERT_NEAR(other[0].Z, hit.Z, 1e-12);
        ASSERT_NEAR(other[0].t, hit.t, 1e-12);
        ASSERT_NEAR(other[0].u, hit.u, 1e-11);
        ASSERT_NEAR(other[0].v, hit.v, 1e-11);
        ASSERT_NEAR(other[0].shift, hit.shift, 1e-12);
      });
      const auto directions =
          static_cast<std::size_t>(traced.scene.camera.width * traced.scene.camera.height) -
          traced.rays_with(Status::outside);
      EXPECT_EQ(traced.hits(), directions) << camera;  // a dome is all around
      for (std::size_t id = 1; id < 4; ++id) EXPECT_GT(met[id], 3U) << camera << id;
    }
}

TEST(CameraScene, BeyondTheCircleThereIsNoRay) {
  for (const std::string metric : {"minkowski", "goedel", "kerr_schild"}) {
    json scene =
        scene_with({{"type", "fisheye"}, {"fov_deg", 200}, {"resolution", {31, 21}}, {"samples", 2}}, metric);
    if (metric == "goedel") scene["paths"] = "integrated", scene["objects"].erase(1);
    const auto metrics = metric_descriptions();
    const Scene read = read_scene(scene.dump(), "file", metrics);
    const Dataset dataset = trace_scene(find_spacetime(metric), read, "file", 1);
    EXPECT_EQ(dataset.manifest.format, 4);
    EXPECT_TRUE(verify(dataset).empty()) << verify(dataset).front();
    const Camera rays = sample_camera(read.camera);
    for (int y = 0; y < rays.height; ++y)
      for (int x = 0; x < rays.width; ++x) {
        const auto i = static_cast<std::size_t>(y * rays.width + x);
        const bool outside = std::hypot(31 - (x + 0.5), 21 - (y + 0.5)) > 21;
        ASSERT_EQ(dataset.rays.status[i] == static_cast<std::uint32_t>(Status::outside), outside)
            << x << " " << y;
        if (!outside) continue;
        ASSERT_EQ(dataset.rays.steps[i], 0U);
        ASSERT_EQ(dataset.rays.drift[i], 0.0F);
        const auto pixel = static_cast<std::size_t>(y / 2 * read.camera.width + x / 2);
        for (std::size_t k = dataset.hits.offset[pixel]; k < dataset.hits.offset[pixel + 1]; ++k)
          ASSERT_NE(dataset.hits.sample[k], static_cast<std::uint32_t>(y % 2 * 2 + x % 2));
      }
    Dataset older = dataset;
    older.manifest.format = 2;
    EXPECT_FALSE(verify(older).empty());
  }
}

/// Changes of uv from pixel to pixel do not jump from face to face: they are those that the places on the
/// inner side tell of.
TEST(CameraScene, DifferentialsEndAtNoEdge) {
  for (const json& camera : new_cameras()) {
    json scene = scene_with(camera);
    scene["observer"] = {{"event", {0, 0, 0, 0}}};
    scene["objects"].erase(2), scene["objects"].erase(1);
    const Traced traced = trace_text(scene.dump());
    const Camera& c = traced.scene.camera;
    const auto uv = [&](double x, double y, double dx, double dy) {
      const auto m = host::look_direction(c, x, y, dx, dy);
      return std::array{std::atan2(m[1], m[0]) / (2 * std::numbers::pi), std::asin(m[2]) / std::numbers::pi};
    };
    double worst = 0;
    for (const TracedBand& band : traced.bands)
      for (std::size_t i = 0; i < band.hits.size(); ++i) {
        const std::size_t width = static_cast<std::size_t>(c.width), pixel = band.hits[i].pixel;
        const double x = static_cast<double>(pixel % width) + 0.5,
                     y = static_cast<double>(pixel / width) + 0.5 +
                         static_cast<double>(kBandLines * (&band - traced.bands.data()));
        if (std::fabs(host::look_direction(c, x, y)[2]) > 0.95) continue;  // u moves fast about the poles
        // To the side on which the pixel's own face lies, also where its centre is on a diagonal.
        const double h = 1e-4;
        const auto here = uv(x, y, 0, 0), right = uv(x, y, -h, 0), down = uv(x, y, 0, h);
        for (std::size_t k = 0; k < 2; ++k) {
          const auto turn = [&](double a) { return k == 0 ? a - std::round(a) : a; };
          worst = std::max(worst, std::fabs(band.details[i].duv[k] - turn(here[k] - right[k]) / h));
          worst = std::max(worst, std::fabs(band.details[i].duv[2 + k] - turn(down[k] - here[k]) / h));
        }
      }
    EXPECT_LT(worst, 1e-4) << camera;  // of 0.02 a pixel and more; differences of 1e-4 and a 16th of a pixel
  }
}

TEST(CameraScene, DirectionsAndAnglesSayTheSame) {
  const json plain = {{"type", "sphere"}, {"resolution", {8, 4}}};
  for (const auto& [azimuth, elevation, roll] :
       {std::array{30.0, 20.0, 0.0}, std::array{-100.0, -50.0, 130.0}, std::array{10.0, 89.0, -20.0}}) {
    json turned = plain, aimed = plain;
    turned.update({{"azimuth_deg", azimuth}, {"elevation_deg", elevation}, {"roll_deg", roll}});
    const Camera expected = read(turned);
    const auto &f = expected.forward, &u = expected.up;
    aimed["forward"] = {3 * f[0], 3 * f[1], 3 * f[2]};
    aimed["up"] = {u[0] + 2 * f[0], u[1] + 2 * f[1], u[2] + 2 * f[2]};
    const Camera found = read(aimed);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(found.forward[i], expected.forward[i], 1e-15);
      EXPECT_NEAR(found.left[i], expected.left[i], 1e-15);
      EXPECT_NEAR(found.up[i], expected.up[i], 1e-15);
    }
  }
  json level = plain;
  level["forward"] = {0, 2, 0};
  EXPECT_EQ(read(level).left, (Triple{-1, 0, 0}));
}

std::string complaint(const json& camera) {
  try {
    read(camera);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(CameraScene, WhatIsWrongIsRefusedWithItsPointer) {
  const json fisheye = {{"type", "fisheye"}, {"fov_deg", 180}, {"resolution", {20, 20}}},
             cube = {{"type", "cube_map"}, {"resolution", {60, 10}}},
             tetrahedron = {{"type", "tetrahedron_map"}, {"resolution", {20, 10}}};
  for (const json& camera : {fisheye, cube, tetrahedron}) EXPECT_EQ(complaint(camera), "");
  const struct {
    const json& camera;
    json changes;
    const char *place, *part;
  } cases[] = {
      {fisheye, {{"fov_deg", 361}}, "/fov_deg", "360"},
      {fisheye, {{"fov_deg", 0}}, "/fov_deg", "expected"},
      {fisheye, {{"fov_deg", {180, 90}}}, "/fov_deg", "number"},
      {fisheye, {{"fov_deg", nullptr}}, "/fov_deg", "number"},
      {cube, {{"resolution", {40, 10}}}, "/resolution", "6 times the height"},
      {cube, {{"resolution", {10, 60}}}, "/resolution", "6 times the height"},
      {cube, {{"fov_deg", 90}}, "/fov_deg", "unknown"},
      {cube, {{"type", "cubemap"}}, "/type", "cube_map"},
      {tetrahedron, {{"resolution", {10, 10}}}, "/resolution", "2 times the height"},
      {tetrahedron, {{"samples", 17}}, "/samples", "16"},
      {cube, {{"forward", {0, 0, 0}}}, "/forward", "zero"},
      {cube, {{"forward", {1, 0}}}, "/forward", "3 numbers"},
      {cube, {{"forward", {1, 0, "x"}}}, "/forward/2", "number"},
      {cube, {{"forward", {0, 0, -1}}}, "/forward", "up beside it"},
      {cube, {{"forward", {1, 2, 3}}, {"up", {-2, -4, -6}}}, "/up", "parallel"},
      {cube, {{"forward", {1, 2, 3}}, {"up", {0, 0, 0}}}, "/up", "zero"},
      {cube, {{"up", {0, 0, 1}}}, "/up", "forward"},
      {cube, {{"forward", {1, 0, 0}}, {"azimuth_deg", 0}}, "/azimuth_deg", "either"},
      {cube, {{"forward", {1, 0, 0}}, {"roll_deg", 0}}, "/roll_deg", "either"},
  };
  for (const auto& [camera, changes, place, part] : cases) {
    json changed = camera;
    changed.update(changes);
    const std::string found = complaint(changed), start = std::string("file: /camera") + place + ": ";
    EXPECT_EQ(found.substr(0, start.size()), start) << found;
    EXPECT_NE(found.find(part), std::string::npos) << found;
    EXPECT_EQ(found.find('\n'), std::string::npos) << found;
  }
}

}  // namespace
}  // namespace nullcone::test
