// What crossings tell on request: directions and places in flat spacetime, where all are known, and changes
// of texture coordinates against those that neighbouring pixels see.
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "core/base/boost.h"
#include "core/base/json.h"
#include "core/trace/gather.h"
#include "tests/by_ray.h"
#include "tests/reference_cases.h"
#include "tests/sanitized.h"

namespace nullcone::test {
namespace {

using namespace host;

const std::string kDetails =
    R"(, "records": {"channels": ["order", "uv", "shift", "t", "tau", "mu", "N", "K", "P"],
  "differentials": true})";

Vec3<double> vec(const Triple& x) { return Vec3<double>{x}; }
void expect_near(const Vec3<double>& a, const Vec3<double>& b, double tolerance) {
  EXPECT_LT(norm(a - b), tolerance) << a[0] << " " << a[1] << " " << a[2] << ", not " << b[0] << " " << b[1]
                                    << " " << b[2];
}

TEST(Details, OfAMovingSphere) {
  // In its rest frame the ray is straight: place, normal and aberrated direction follow from one boost.
  const Vec4<double> start = {{-4, 3, -2, 0.5}}, u = four_velocity(Vec3<double>{{0.2, 0.7, -0.3}});
  const std::string ball =
      R"({"name": "ball", "transparent": true, "shape": {"type": "sphere", "radius": 1.2}, "placing": {
    "type": "local", "worldline": {"type": "geodesic", "event": [-4, 3, -2, 0.5], "velocity": [0.2, 0.7, -0.3]}}},)";
  const Traced traced =
      trace_text(scene_of("minkowski", R"("type": "panorama", "fov_deg": [90, 90], "resolution": [70, 70])",
                          ball + kSky, R"("observer": {"event": [2, 1, 0, 0]})" + kDetails));
  std::size_t met = 0;
  for (const RayOfPicture& ray : by_ray(traced))
    for (std::size_t i = 0; i < ray.hits.size(); ++i) {
      const Vec3<double> d = traced.look(ray.x, ray.y);
      const HitRecord& hit = ray.hits[i];
      const HitDetail& detail = ray.details[i];
      if (hit.id == 2) {
        expect_near(vec(detail.N), -d, 1e-14);
        expect_near(vec(detail.K), -d, 1e-14);
        EXPECT_EQ(detail.P[0], std::copysign(std::numeric_limits<double>::infinity(), d[0]));
        continue;
      }
      ++met;
      const Vec4<double> event = {{2 - hit.Z, 1 + hit.Z * d[0], hit.Z * d[1], hit.Z * d[2]}};
      const Vec3<double> X = spatial(boost(u, event - start));
      const Vec4<double> photon = boost(u, Vec4<double>{{1, -d[0], -d[1], -d[2]}});
      const Vec3<double> K = (1 / photon[0]) * spatial(photon);
      const double rounding = 1e-13 / (hit.mu + 1e-3);
      expect_near(vec(detail.P), hit.Z * d, rounding);
      expect_near(vec(detail.K), K, rounding);
      expect_near(vec(detail.N), ((i == 0 ? 1 : -1) / 1.2) * X, rounding);
      EXPECT_NEAR(norm(vec(detail.K)), 1, rounding);
      EXPECT_NEAR(hit.mu, dot(vec(detail.N), K), rounding);
      EXPECT_NEAR(hit.shift, 1 / photon[0], rounding);
    }
  EXPECT_GT(met, 200U);
}

TEST(Details, OfACardFromBothSides) {
  const std::string card =
      R"(, "placing": {"type": "local", "worldline": {"type": "static", "event": [0, 3, 0, 0]},
    "z_axis": [-1, 0.5, 0.2], "y_axis": [0, 0, 1]}})";
  for (const double side : {1.0, -1.0}) {
    const Traced traced =
        trace_text(scene_of("minkowski", R"("type": "perspective", "fov_deg": 40, "resolution": [31, 23],
      "azimuth_deg": )" + text_of(side > 0 ? 0.0 : 180.0),
                            R"({"name": "card", "shape": {"type": "quad", "edges": [1, 1]})" + card,
                            R"("observer": {"event": [0, )" + text_of(3 - 3 * side) + ", 0, 0]}" + kDetails));
    const Placing& placing = traced.scene.objects[0].placing;
    std::size_t met = 0;
    for (const RayOfPicture& ray : by_ray(traced))
      for (std::size_t i = 0; i < ray.hits.size(); ++i, ++met) {
        const Vec3<double> d = traced.look(ray.x, ray.y);
        expect_near(vec(ray.details[i].N), {{0, 0, side}}, 1e-15);
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_NEAR(ray.details[i].K[k], -dot(vec(placing.axes[k]), d), 1e-14);
        EXPECT_NEAR(ray.details[i].K[2] * side, ray.hits[i].mu, 1e-14);
      }
    EXPECT_GT(met, 50U);
  }
}

TEST(Details, KIsAUnitVectorWhereverObjectsAre) {
  // Stretched frames (coordinate objects) and rigid ones: |K| = 1 and K.N = mu.
  for (const std::string metric : {"goedel", "kerr_schild"}) {
    const std::string objects =
        R"({"name": "a", "shape": {"type": "sphere", "radius": 0.5}, "transparent": true, "placing":
      {"type": "coordinate", "centre": [1.5, 4.2, 0.3]}}, {"name": "b", "transparent": true, "shape": {"type": "quad", "edges": [2, 3]},
      "placing": {"type": "coordinate", "centre": [1, 4.5, 0.3], "z_axis": [0.2, 1, 0.5]}},)" +
        local_object("c", sphere(0.3), {{-0.5, 4.2, 0}}, kTransparent);
    std::size_t met = 0;
    for (const RayOfPicture& ray : by_ray(trace_text(
             scene_of(metric, R"("type": "panorama", "fov_deg": [180, 90],
        "azimuth_deg": 90, "resolution": [120, 60])",
                      objects, R"("observer": {"event": [0, 0.5, 3, 0]}, "max_lookback": 15)" + kDetails))))
      for (std::size_t i = 0; i < ray.hits.size(); ++i, ++met) {
        const Vec3<double> N = vec(ray.details[i].N), K = vec(ray.details[i].K);
        EXPECT_NEAR(norm(N), 1, 1e-14);
        // Integrated rays are null but for their drift.
        EXPECT_NEAR(norm(K), 1, metric == "goedel" ? 1e-12 : 1e-8) << metric << ray.hits[i].id;
        EXPECT_NEAR(dot(N, K), ray.hits[i].mu, 1e-12);
      }
    EXPECT_GT(met, 300U);
  }
}

constexpr std::size_t kCoarse = kSanitized ? 4 : 1;

/// Changes of (u, v) against central differences between pixels that see the same image; `limit`: largest
/// relative difference of all but one in twenty (near limbs, poles and caustics pixels are too coarse).
void expect_changes(const Traced& traced, double limit, std::size_t fewest) {
  limit *= kCoarse * kCoarse, fewest /= kCoarse * kCoarse;  // pixels are wider under sanitizers
  const auto rays = by_ray(traced);
  const auto width = static_cast<std::size_t>(traced.scene.camera.width), height = rays.size() / width;
  std::vector<double> errors;
  for (std::size_t y = 1; y + 1 < height; ++y)
    for (std::size_t x = 1; x + 1 < width; ++x) {
      const auto& here = rays[y * width + x];
      const std::array<const RayOfPicture*, 4> near = {&rays[y * width + x + 1], &rays[y * width + x - 1],
                                                       &rays[(y + 1) * width + x],
                                                       &rays[(y - 1) * width + x]};
      for (std::size_t i = 0; i < here.hits.size(); ++i) {
        const HitRecord& hit = here.hits[i];
        const auto alike = [&](const RayOfPicture* ray) {
          return ray->hits.size() == here.hits.size() && ray->hits[i].id == hit.id &&
                 ray->hits[i].order == hit.order;
        };
        if (!std::ranges::all_of(near, alike) || hit.mu < 0.5 || std::fabs(hit.v - 0.5) > 0.4) continue;
        std::array<double, 4> found{};
        for (std::size_t k = 0; k < 2; ++k) {
          found[2 * k] = 0.5 * std::remainder(near[2 * k]->hits[i].u - near[2 * k + 1]->hits[i].u, 1.0);
          found[2 * k + 1] = 0.5 * (near[2 * k]->hits[i].v - near[2 * k + 1]->hits[i].v);
        }
        double off = 0, size = 0;
        for (std::size_t k = 0; k < 4; ++k) {
          off = std::max(off, std::fabs(found[k] - here.details[i].duv[k]));
          size = std::max(size, std::fabs(found[k]));
        }
        errors.push_back(std::isfinite(off) ? off / size : 1e9);
      }
    }
  ASSERT_GT(errors.size(), fewest);
  std::ranges::sort(errors);
  EXPECT_LT(errors[errors.size() / 2], 0.1 * limit);
  EXPECT_LT(errors[errors.size() * 95 / 100], limit)
      << errors.size() << " changes, median " << errors[errors.size() / 2];
}

std::string fine(double fov, const std::string& more = "") {
  return R"("type": "perspective", "resolution": )" + std::string(kSanitized ? "[40, 30]" : "[160, 120]") +
         R"(, "fov_deg": )" + text_of(fov) + more;
}

TEST(Details, ChangesOfTextureCoordinatesInFlatSpacetime) {
  const std::string objects = local_object("ball", sphere(0.5), {{3, 0.2, 0.1}}, kTransparent) +
                              R"(, {"name": "card",
    "transparent": true, "shape": {"type": "quad", "edges": [3, 2]}, "placing": {"type": "local", "worldline": {"type": "geodesic",
    "event": [-4, 4, -0.5, 0], "velocity": [0.1, 0.3, 0.2]}, "z_axis": [-1, 0.3, 0.4]}}, )" +
                              kSky;
  const std::string more = R"("observer": {"event": [0, 0, 0, 0], "velocity": [0.2, 0.1, 0]})" + kDetails;
  for (const std::string paths : {"", R"(, "paths": "integrated")"}) {
    const Traced traced = trace_text(scene_of("minkowski", fine(20), objects, more + paths));
    expect_changes(traced, 2e-3, 5000);  // curvature of a sphere within a pixel: (1/200 of a radius)^2 / mu^3
  }
  // Exactly: a card at right angles, seen from the middle at distance 2. A pixel is 2 tan(fov/2)/n wide.
  const std::string card =
      R"({"name": "card", "shape": {"type": "quad", "edges": [4, 4]}, "placing": {"type": "local", "worldline":
    {"type": "static", "event": [0, 2, 0, 0]}, "z_axis": [-1, 0, 0], "y_axis": [0, 0, 1]}})";
  const double pixel = 2 * std::tan(0.25 * std::numbers::pi * 0.5) * 2 / 4 / 20;
  for (const std::string paths : {"", R"(, "paths": "integrated")"})
    for (const RayOfPicture& ray : by_ray(trace_text(
             scene_of("minkowski", R"("type": "perspective", "fov_deg": 45, "resolution": [20, 20])", card,
                      kAtOrigin + kDetails + paths)))) {
      const double tolerance = paths.empty() ? 1e-5 : 1e-3;  // the square of 1/16 or 1/2 of a pixel (0.04)
      EXPECT_NEAR(ray.details[0].duv[0], pixel, pixel * tolerance);
      EXPECT_NEAR(ray.details[0].duv[1], 0, pixel * tolerance);
      EXPECT_NEAR(ray.details[0].duv[2], 0, pixel * tolerance);
      EXPECT_NEAR(ray.details[0].duv[3], -pixel, pixel * tolerance);
    }
}

TEST(Details, ChangesAreThoseOfPixelsAndNotOfSamples) {
  const std::string card =
      R"({"name": "card", "shape": {"type": "quad", "edges": [40, 40]}, "placing": {"type": "local", "worldline":
    {"type": "static", "event": [0, 2, 0, 0]}, "z_axis": [-1, 0, 0], "y_axis": [0, 0, 1]}})";
  std::array<float, 2> change{};
  for (const int samples : {1, 3}) {
    Scene scene =
        trace_text(scene_of("minkowski", R"("type": "perspective", "fov_deg": 45, "resolution": [20, 20])",
                            card, kAtOrigin + kDetails))
            .scene;
    scene.camera.samples = samples;
    const auto tracer = prepare_scene(find_spacetime("minkowski"), scene, "test");
    const Band band = gather(trace_band(*tracer, scene, true, 0), scene);
    change[samples > 1] = band.hits.duv[0].at(0);
  }
  EXPECT_GT(change[0], 0);
  EXPECT_NEAR(change[1] / change[0], 1, 1e-4);
}

TEST(Details, ChangesOfTextureCoordinatesInTheGoedelUniverse) {
  json earth = json::parse(std::ifstream(NULLCONE_SOURCE "/scenes/goedel_earth.json"));
  earth["records"] = {{"differentials", true}};
  if (kSanitized) earth["camera"]["resolution"] = {660, 75};
  expect_changes(trace_text(earth.dump()), 5e-3, 3000);
}

TEST(Details, ChangesOfTextureCoordinatesAboutABlackHole) {
  const std::string objects =
      R"({"name": "ball", "shape": {"type": "sphere", "radius": 2}, "placing": {"type": "local", "worldline":
    {"type": "static", "event": [0, -6, 5, 1]}}}, )" +
      kSky;
  const std::string view = R"(, "azimuth_deg": 180, "elevation_deg": 4)";
  expect_changes(
      trace_text(scene_of("kerr_schild", fine(12, view), objects,
                          R"("observer": {"event": [0, 40, -5, 2]}, "accuracy": "reference")" + kDetails)),
      1e-2, 2000);
}

}  // namespace
}  // namespace nullcone::test
