// Times count from the observation: a scene long after t = 0 loses no digits, and looks the same to the last
// bit.
#include <gtest/gtest.h>

#include <bit>

#include "tests/by_ray.h"

namespace nullcone::test {
namespace {

/// Everything about the crossings of a scene, in full precision.
std::vector<double> numbers_of(const Traced& traced) {
  std::vector<double> out;
  for (const RayOfPicture& ray : by_ray(traced)) {
    out.insert(out.end(),
               {static_cast<double>(ray.x), static_cast<double>(ray.y), static_cast<double>(ray.status)});
    for (std::size_t i = 0; i < ray.hits.size(); ++i) {
      const HitRecord& h = ray.hits[i];
      out.insert(out.end(), {static_cast<double>(h.id), static_cast<double>(h.order), h.Z, h.u, h.v, h.shift,
                             h.t, h.tau, h.mu});
      for (const double x : ray.details[i].duv) out.push_back(x);
      for (const Triple& X : {ray.details[i].N, ray.details[i].K, ray.details[i].P})
        out.insert(out.end(), X.begin(), X.end());
    }
  }
  return out;
}

/// A scene observed at time `now`, whose static worldlines start at `anchor`, and moving ones 3 before `now`.
std::string scene_at(const std::string& metric, double now, double anchor, bool moves,
                     const std::string& more) {
  const std::string rest =
      R"({"name": "rest", "transparent": true, "shape": {"type": "sphere", "radius": 0.4}, "placing": {"type":
    "local", "worldline": {"type": "static", "event": [)" +
      text_of(anchor) + R"(, 2.6, 4, 0.2]}}})";
  const std::string card =
      R"(, {"name": "card", "shape": {"type": "quad", "edges": [2, 1]}, "placing": {"type": "local",
    "worldline": {"type": "static", "event": [)" +
      text_of(anchor) + R"(, 3, 2.5, 0]}, "z_axis": [1, 0.3, 0.2]}})";
  const std::string fixed =
      R"(, {"name": "fixed", "shape": {"type": "sphere", "radius": 0.3}, "placing": {"type": "coordinate",
    "centre": [3.5, 3.4, -0.4]}})";
  const std::string falling =
      R"(, {"name": "falling", "shape": {"type": "sphere", "radius": 0.2}, "placing": {"type": "local",
    "worldline": {"type": "geodesic", "event": [)" +
      text_of(now - 3) + R"(, 3.2, 3.2, 0.5], "velocity": [0.1, -0.3, 0]}}})";
  return scene_of(metric,
                  R"("type": "panorama", "fov_deg": [180, 90], "azimuth_deg": 80, "resolution": )" +
                      std::string(kSanitized ? "[20, 10]" : "[60, 30]"),
                  rest + card + fixed + (moves ? falling : ""),
                  R"("observer": {"event": [)" + text_of(now) +
                      R"(, 2.8, 3, 0.1]}, "max_lookback": 9, "records": {"differentials":
      true, "channels": ["N", "K", "P"]})" +
                      more);
}

void expect_same(const std::string& metric, bool moves, const std::string& more) {
  const Traced at_zero = trace_text(scene_at(metric, 0, 0, moves, more));
  const std::vector<double> expected = numbers_of(at_zero);
  EXPECT_GT(at_zero.hits(), kSanitized ? 10U : 100U);
  for (const double now : kSanitized ? std::vector{1e9} : std::vector{1e9, -37.25})
    for (const double anchor : kSanitized ? std::vector{0.0} : std::vector{0.0, now, 1e9 + 5}) {
      const Traced traced = trace_text(scene_at(metric, now, anchor, moves, more));
      const std::vector<double> found = numbers_of(traced);
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t i = 0; i < found.size(); ++i)
        ASSERT_EQ(std::bit_cast<std::uint64_t>(found[i]), std::bit_cast<std::uint64_t>(expected[i]))
            << metric << " at " << now << ", " << anchor << ": " << found[i] << ", not " << expected[i];
    }
}

TEST(ObservationTime, ChangesNothing) {
  expect_same("minkowski", true, "");
  expect_same("minkowski", true, R"(, "paths": "integrated")");
  expect_same("goedel", true, "");
  expect_same("goedel", false, R"(, "paths": "integrated")");
  expect_same("kerr_schild", false, "");
}

TEST(ObservationTime, ProperTimesStillCountFromTheWorldlinesEvent) {
  for (const std::string metric : {"minkowski", "goedel", "kerr_schild"}) {
    const auto metrics = metric_descriptions();
    Scene scene = read_scene(scene_at(metric, 1e9, 12, metric != "kerr_schild", ""), "test", metrics);
    const auto tracer = prepare_scene(find_spacetime(metric), scene, "test");
    const double distance = std::sqrt(2.6 * 2.6 + 16 + 0.04);
    const double rate = metric == "kerr_schild" ? std::sqrt(1 - 2 / distance) : 1;
    EXPECT_NEAR(tracer->tau_origin(0), (1e9 - 12) * rate, 1e-6);
    EXPECT_EQ(tracer->tau_origin(2), 1e9);
    if (metric == "minkowski") {
      EXPECT_NEAR(tracer->tau_origin(3), 3 * std::sqrt(1 - 0.1), 1e-14);
    }
  }
}

}  // namespace
}  // namespace nullcone::test
