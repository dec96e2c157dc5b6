// The rank of an image: how many caustics of the observer's light cone a ray has passed.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>

#include "tests/by_ray.h"
#include "tests/sanitized.h"

namespace nullcone::test {
namespace {

using namespace host;
constexpr double kPi = std::numbers::pi, kDegrees = 180 / kPi;

double angle_between(const Vec3<double>& a, const Vec3<double>& b) {
  return std::atan2(norm(cross(a, b)), dot(a, b));
}

/// Angles about the centre that a ray has swept at each of its crossings: summed up along the ray itself.
std::vector<double> swept_angles(const Traced& traced, const RayOfPicture& ray) {
  const Spacetime& spacetime = find_spacetime(traced.scene.metric);
  std::vector<double> parameters, lambda, out;
  for (const MetricParameter& p : spacetime.description().parameters)
    parameters.push_back(traced.scene.metric_parameters.at(std::string(p.name)));
  constexpr int kParts = 400;
  double from = 0;
  for (const HitRecord& hit : ray.hits) {
    if (!std::isfinite(hit.Z)) break;
    for (int i = 1; i <= kParts; ++i) lambda.push_back(from + (hit.Z - from) * i / kParts);
    from = hit.Z;
  }
  const Vec3<double> look = traced.look(ray.x, ray.y);
  const auto points = spacetime.geodesic(parameters, traced.scene.observer.event,
                                         {-1, look[0], look[1], look[2]}, lambda, &kReference);
  Vec3<double> last = spatial(Vec4<double>{traced.scene.observer.event});
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3<double> X = spatial(Vec4<double>{points[i].event});
    sum += angle_between(last, X);
    last = X;
    if (i % kParts == kParts - 1) out.push_back(sum);
  }
  if (out.size() < ray.hits.size()) {  // the sky
    const double longitude = 2 * kPi * (ray.hits.back().u - 0.5), latitude = kPi * (ray.hits.back().v - 0.5);
    const Vec3<double> far = {{std::cos(latitude) * std::cos(longitude),
                               std::cos(latitude) * std::sin(longitude), std::sin(latitude)}};
    out.push_back(sum + angle_between(last, far));
  }
  return out;
}

/// Counts the crossings of each order, each of which must be the swept angle over pi.
std::map<std::uint32_t, std::size_t> check_orders(const std::string& scene) {
  std::map<std::uint32_t, std::size_t> counts;
  const Traced traced = trace_text(scene);
  for (const RayOfPicture& ray : by_ray(traced)) {
    const std::vector<double> angles = swept_angles(traced, ray);
    for (std::size_t i = 0; i < ray.hits.size(); ++i) {
      const double turns = angles.at(i) / kPi;
      if (std::fabs(turns - std::round(turns)) < 1e-5 && turns > 0.5) continue;  // at a caustic
      EXPECT_EQ(ray.hits[i].order, static_cast<std::uint32_t>(turns))
          << turns << " at " << ray.x << " " << ray.y;
      ++counts[ray.hits[i].order];
    }
  }
  return counts;
}

TEST(Order, IsTheSweptAngleAboutABlackHole) {
  // Past the edge of the shadow from r = 20, off all planes of the chart.
  const double r = 20, edge = kDegrees * std::asin(5.196152422706632 * std::sqrt(1 - 2 / r) / r);
  const std::string shell =
      R"({"name": "shell", "transparent": true, "shape": {"type": "sphere", "radius": 12}, "placing": {"type":
    "coordinate", "centre": [0, 0, 0]}}, )" +
      kSky;
  const std::string observer = R"("observer": {"event": [0, 12, 16, 0]}, "accuracy": "reference")";
  const double centre = kDegrees * std::atan2(-16, -12);
  std::map<std::uint32_t, std::size_t> counts;
  for (const double fov : {20.0, 0.4, 0.01}) {
    const std::string camera = R"("type": "perspective", "resolution": )" +
                               std::string(kSanitized ? "[12, 3]" : "[60, 5]") + R"(, "azimuth_deg": )" +
                               text_of(centre + edge) + R"(, "elevation_deg": )" + text_of(0.2 * fov) +
                               R"(, "fov_deg": )" + text_of(fov);
    for (const auto& [order, count] : check_orders(scene_of("kerr_schild", camera, shell, observer)))
      counts[order] += count;
  }
  EXPECT_GT(counts[0], 20U);
  EXPECT_GT(counts[1], 20U);
  EXPECT_GT(counts[2], kSanitized ? 0U : 5U);
}

TEST(Order, IsTheSweptAngleAboutAWormhole) {
  // From l = 5: near the rim of the other side, sin psi = 1/sqrt(26), rays wind about the throat.
  const double l = 5, rho = 0.5 * (l + std::sqrt(l * l + 1)), rim = kDegrees * std::asin(1 / std::sqrt(26.0));
  const std::string shell =
      R"({"name": "shell", "transparent": true, "shape": {"type": "sphere", "radius": 3}, "placing": {"type":
    "coordinate", "centre": [0, 0, 0]}}, {"name": "here", "shape": {"type": "sky"}})";
  std::map<std::uint32_t, std::size_t> counts;
  for (const double fov : {10.0, 0.1, 0.001}) {
    const std::string camera = R"("type": "perspective", "resolution": )" +
                               std::string(kSanitized ? "[12, 1]" : "[60, 3]") + R"(, "azimuth_deg": )" +
                               text_of(180 + rim) + R"(, "elevation_deg": )" + text_of(0.1 * fov) +
                               R"(, "fov_deg": )" + text_of(fov);
    for (const auto& [order, count] : check_orders(
             scene_of("ellis_wormhole", camera, shell,
                      R"("accuracy": "reference", "observer": {"event": [0, )" + text_of(rho) + ", 0, 0]}")))
      counts[order] += count;
  }
  EXPECT_GT(counts[1], kSanitized ? 2U : 20U);
  EXPECT_GT(counts[2], kSanitized ? 0U : 5U);
}

TEST(Order, EndsWhereTheSceneSaysSo) {
  const std::string camera = R"("type": "panorama", "fov_deg": [360, 40], "resolution": [120, 13])";
  const std::string objects = local_object("ball", sphere(0.25), {{0.7, 0.3, 0}}, kTransparent);
  const std::string observer = R"("observer": {"event": [0, 0.1, -0.1, 0]})";
  const auto all = by_ray(trace_text(scene_of("goedel", camera, objects, observer))),
             low = by_ray(
                 trace_text(scene_of("goedel", camera, objects, observer + R"(, "records": {"order": 1})")));
  std::size_t dropped = 0, kept = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto end = std::ranges::find_if(all[i].hits, [](const HitRecord& hit) { return hit.order > 1; });
    ASSERT_EQ(low[i].hits.size(), static_cast<std::size_t>(end - all[i].hits.begin()));
    kept += low[i].hits.size();
    dropped += all[i].hits.size() - low[i].hits.size();
    EXPECT_EQ(low[i].status, Status::lookback_reached);
  }
  EXPECT_GT(kept, 50U);
  EXPECT_GT(dropped, 50U);
}

}  // namespace
}  // namespace nullcone::test
