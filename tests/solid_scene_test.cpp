// Solids in scenes, record for record against twins that are traced by other code or in other pieces, at
// rest, fast and falling, where light is straight and where it is bent; and what the reader says.
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/by_ray.h"

namespace nullcone::test {
namespace {

using namespace host;

struct World {
  std::string metric, more, placing;
};

/// Where shapes of an extent of about 1/2 stand well.
std::vector<World> worlds() {
  const std::string pixels = kSanitized ? R"("resolution": [40, 20]})" : R"("resolution": [160, 80]})";
  const std::string
      around = R"("camera": {"type": "sphere", )" + pixels,
      full =
          R"(, "records": {"channels": ["order", "uv", "shift", "t", "tau", "mu", "N", "K", "P", "duv"]}, )";
  const std::string ahead =
      R"("camera": {"type": "perspective", "azimuth_deg": 180, "fov_deg": 40, )" + pixels;
  const auto local = [](const std::string& kind, const std::string& event, const std::string& more) {
    return R"("placing": {"type": "local", "worldline": {"type": ")" + kind + R"(", "event": )" + event +
           more + R"(}, "z_axis": [0.4, -0.3, 1], "y_axis": [0.2, 1, 0.1]})";
  };
  const std::string fast = local("geodesic", "[0, 1, 0.5, -0.3]", R"(, "velocity": [-0.5, 0.6, 0.4])"),
                    falling = local("geodesic", "[0, -0.4, 0.5, 0.1]", R"(, "velocity": [0.2, 0.1, -0.2])");
  const std::string here = R"("observer": {"event": [0.5, 0.1, -0.2, 0.1]}, )";
  return {
      {"minkowski",
       R"("observer": {"event": [1, 0.1, 0.2, 0.1], "velocity": [0.1, 0.3, 0]}, )" + around + full, fast},
      {"minkowski", R"("observer": {"event": [1, 0.1, 0.2, 0.1]}, "paths": "integrated", )" + around + full,
       fast},
      {"goedel", here + R"("max_lookback": 9, )" + around + full, local("static", "[0, 0.9, 0.1, 0]", "")},
      {"goedel", here + R"("max_lookback": 9, )" + around + full, falling},
      {"goedel", here + R"("paths": "integrated", "max_lookback": 9, )" + around + full,
       local("static", "[0, 0.9, 0.1, 0]", "")},
      {"kerr_schild", R"("observer": {"event": [0, 12, 0, 2]}, )" + ahead + full,
       R"("placing": {"type": "local", "worldline": {"type": "static", "event": [0, 5, 2, 1]}, "z_axis": [0.4, -0.3, 1]})"},
      {"ellis_wormhole", R"("observer": {"event": [0, 6, 0, 1]}, )" + ahead + full,
       R"("placing": {"type": "coordinate", "centre": [1, 1, 0.5], "z_axis": [0.4, -0.3, 1]})"}};
}

std::string scene_with(const World& world, const std::string& shape, bool transparent) {
  return R"({"metric": {"name": ")" + world.metric + R"("}, )" + world.more +
         R"("objects": [{"name": "thing", "shape": )" + shape + (transparent ? kTransparent : "") + ", " +
         world.placing + "}]}";
}

/// The largest difference of anything in two crossings, angles and ratios as they are.
double difference(const HitRecord& a, const HitRecord& b, const HitDetail& A, const HitDetail& B) {
  double out = 0;
  for (const double off :
       {a.Z / b.Z - 1, a.u - b.u, a.v - b.v, a.shift / b.shift - 1, a.t - b.t, a.tau - b.tau, a.mu - b.mu})
    out = std::max(out, std::fabs(off));
  for (std::size_t i = 0; i < 3; ++i)
    out = std::max({out, std::fabs(A.N[i] - B.N[i]), std::fabs(A.K[i] - B.K[i]), std::fabs(A.P[i] - B.P[i])});
  const double size = std::hypot(A.duv[0], A.duv[1], A.duv[2]) + std::fabs(A.duv[3]);
  for (std::size_t i = 0; i < 4; ++i) out = std::max(out, 1e-3 * std::fabs(A.duv[i] - B.duv[i]) / size);
  return out;
}

/// Traces a shape and its twin; rays that graze may meet one and not the other.
void expect_twins(const std::string& one, const std::string& other, double tolerance) {
  for (const World& world : worlds())
    for (const bool transparent : {false, true}) {
      SCOPED_TRACE(scene_with(world, one, transparent));
      const auto a = by_ray(trace_text(scene_with(world, one, transparent))),
                 b = by_ray(trace_text(scene_with(world, other, transparent)));
      std::size_t met = 0, apart = 0;
      double worst = 0;
      for (std::size_t i = 0; i < a.size(); ++i) {
        if (a[i].hits.size() != b[i].hits.size()) {
          ++apart;
          continue;
        }
        for (std::size_t n = 0; n < a[i].hits.size(); ++n) {
          if (a[i].hits[n].mu < 0.02) continue;
          ++met;
          worst = std::max(worst, difference(a[i].hits[n], b[i].hits[n], a[i].details[n], b[i].details[n]));
        }
      }
      EXPECT_LE(apart, 1U);
      EXPECT_GT(met, kSanitized ? 3U : 60U);
      EXPECT_LT(worst, tolerance);
    }
}

TEST(SolidScene, RoundEllipsoidsAreSpheres) {
  expect_twins(sphere(0.3), R"({"type": "ellipsoid", "semi_axes": [0.3, 0.3, 0.3]})", 1e-10);
}

TEST(SolidScene, WhatTakesNothingAwayChangesNothing) {
  const std::string box = R"({"type": "box", "edges": [0.5, 0.3, 0.4]})";
  expect_twins(box, R"({"type": "intersection", "of": [)" + box + R"(, {"type": "sphere", "radius": 3}]})",
               1e-10);
  const std::string can = R"({"type": "cylinder", "radius": 0.2, "height": 0.5})";
  expect_twins(can,
               R"({"type": "difference", "of": [{"type": "union", "of": [)" + can +
                   R"(, {"type": "sphere", "radius": 0.1, "centre": [0.02, 0, 0.05]}]},
                        {"type": "box", "edges": [1, 1, 1], "centre": [0, 0, 2]}]})",
               1e-10);
}

TEST(SolidScene, PartsStandWhereTheySay) {
  // A box turned and moved within an intersection, and the same box as the placing turns it.
  const World flat = worlds()[0];
  const auto twisted = trace_text(R"({"metric": {"name": "minkowski"}, )" + flat.more +
                                  R"("objects": [{"name": "thing", "shape": {"type": "union", "of": [
        {"type": "ellipsoid", "semi_axes": [0.1, 0.2, 0.3], "centre": [0.4, 0.1, -0.2], "z_axis": [1, 1, 0], "y_axis": [0, 0, 1]},
        {"type": "sphere", "radius": 0.01, "centre": [0.4, 0.1, -0.2]}]},
      "placing": {"type": "local", "worldline": {"type": "static", "event": [0, 1, 0.5, -0.3]}}}]})");
  const auto plain = trace_text(
      R"({"metric": {"name": "minkowski"}, )" + flat.more +
      R"("objects": [{"name": "thing", "shape": {"type": "ellipsoid", "semi_axes": [0.1, 0.2, 0.3]},
      "placing": {"type": "local", "worldline": {"type": "static", "event": [0, 1.4, 0.6, -0.5]},
                  "z_axis": [1, 1, 0], "y_axis": [0, 0, 1]}}]})");
  const auto a = by_ray(twisted), b = by_ray(plain);
  std::size_t met = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].hits.size(), b[i].hits.size());
    if (a[i].hits.empty()) continue;
    ++met;
    EXPECT_NEAR(a[i].hits[0].Z, b[i].hits[0].Z, 1e-11);
    EXPECT_NEAR(a[i].hits[0].u, b[i].hits[0].u, 1e-9);
    EXPECT_NEAR(a[i].hits[0].v, b[i].hits[0].v, 1e-9);
  }
  EXPECT_GT(met, kSanitized ? 1U : 15U);
}

TEST(SolidScene, DomesAreSeenFromInside) {
  const auto inside = [](const std::string& shape) {
    return trace_text(scene_of("minkowski", R"("type": "sphere", "resolution": [64, 32])",
                               local_object("dome", shape, {{0.1, 0.05, 0}}),
                               kAtOrigin + R"(, "max_lookback": 50)"));
  };
  for (const char* shape : {R"({"type": "box", "edges": [1, 2, 3], "dome": true})",
                            R"({"type": "cylinder", "radius": 1, "height": 2, "dome": true})",
                            R"({"type": "ellipsoid", "semi_axes": [1, 2, 3], "dome": true})",
                            R"({"type": "difference", "of": [{"type": "sphere", "radius": 2},
                               {"type": "box", "edges": [1, 1, 1], "centre": [1.5, 0, 0]}], "dome": true})"}) {
    const Traced traced = inside(shape);
    EXPECT_EQ(traced.rays_with(Status::hit), 64U * 32U) << shape;
  }
  // The walls of a room, in closed form.
  const Traced room = inside(R"({"type": "box", "edges": [1, 2, 3], "dome": true})");
  room.for_each_hit([&](const HitRecord& hit, std::size_t x, std::size_t y) {
    const auto m = room.look(x, y);
    const double expected =
        std::min({(0.5 + std::copysign(0.1, m[0])) / std::fabs(m[0]),
                  (1 + std::copysign(0.05, m[1])) / std::fabs(m[1]), 1.5 / std::fabs(m[2])});
    ASSERT_NEAR(hit.Z, expected, 1e-13 * expected);
  });
}

TEST(SolidScene, ReaderRefuses) {
  const auto complaint = [](const std::string& shape) -> std::string {
    try {
      trace_text(scene_of("minkowski", R"("type": "sphere", "resolution": [4, 2])",
                          local_object("thing", shape, {{9, 0, 0}}), kAtOrigin));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const auto nested = [](int levels) {
    std::string out = R"({"type": "sphere", "radius": 1})";
    for (int i = 0; i < levels; ++i)
      out = R"({"type": "union", "of": [)" + out + R"(, {"type": "sphere", "radius": 1}]})";
    return out;
  };
  std::string many = R"({"type": "union", "of": [{"type": "sphere", "radius": 1})";
  for (int i = 0; i < 64; ++i) many += R"(, {"type": "sphere", "radius": 1})";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"({"type": "ellipsoid", "semi_axes": [1, 2]})", "semi_axes"},
      {R"({"type": "ellipsoid", "semi_axes": [1, 2, 0]})", "semi_axes/2"},
      {R"({"type": "cylinder", "radius": 1})", "height"},
      {R"({"type": "cylinder", "radius": 1, "height": -1})", "height"},
      {R"({"type": "ring", "radius": 1, "inner_radius": 1})", "inner_radius"},
      {R"({"type": "disk", "radius": 1, "dome": true})", "dome"},
      {R"({"type": "cylinder", "radius": 1, "height": 1, "open": true, "dome": true})", "dome"},
      {R"({"type": "union", "of": [{"type": "sphere", "radius": 1}]})", "at least two"},
      {R"({"type": "union", "of": [{"type": "sphere", "radius": 1}, {"type": "disk", "radius": 1}]})",
       "of/1/type"},
      {R"({"type": "union", "of": [{"type": "sphere", "radius": 1}, {"type": "cylinder", "radius": 1, "height": 1, "open": true}]})",
       "of/1/open"},
      {R"({"type": "union", "of": [{"type": "sphere", "radius": 1}, {"type": "sphere", "radius": 1, "dome": true}]})",
       "of/1/dome"},
      {R"({"type": "sphere", "radius": 1, "centre": [0, 0, 0]})", "centre"},
      {nested(16), "nested too deep"},
      {many + "]}", "one body too many"},
      {R"({"type": "cylinder", "radius": 10, "height": 30})", "holds the observer"},
      {R"({"type": "cylinder", "radius": 1, "height": 1, "dome": true})", "outside"}};
  for (const auto& [shape, words] : cases)
    EXPECT_NE(complaint(shape).find(words), std::string::npos) << shape << complaint(shape);
  EXPECT_EQ(complaint(nested(15)), "");
}

}  // namespace
}  // namespace nullcone::test
