// Films in flat space, where parallel rays are known; what they pierce, and what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "tests/film.h"

namespace nullcone::test {
namespace {

using namespace host;

/// In flat space a film shows a sphere at rest as the disc of its radius, wherever it stands.
TEST(Orthographic, ASphereIsADiscOfItsRadius) {
  for (const double far : {3.0, 30.0, 3e4}) {
    const json forward = {0.6, 0.48, 0.64};
    const Vec3<double> n = {{0.6, 0.48, 0.64}}, C = far * n + Vec3<double>{{0.5, -0.3, 0.2}};
    const Traced traced =
        trace_text(scene_of("minkowski", film(4, 64, 48, forward),
                            {placed({{"type", "sphere"}, {"radius", 1.1}}, {C[0], C[1], C[2]})})
                       .dump());
    expect_no_doubts(traced);
    std::size_t met = 0;
    for (const Seen& one : seen(traced)) {
      const Vec3<double> X = place_of(traced, one), to = C - X;
      const Vec3<double> aside = cross(to, n);
      const double along = dot(to, n), room = 1.1 * 1.1 - dot(aside, aside);
      ASSERT_GT(room, 0);
      const double Z = along - std::sqrt(room), rounding = 1e-16 * far * (1 + 1 / std::sqrt(room)) + 1e-13;
      ASSERT_NEAR(one.hit.Z, Z, 10 * rounding) << far;
      ASSERT_NEAR(one.hit.t, -Z, 10 * rounding);
      ASSERT_EQ(one.hit.shift, 1);
      ASSERT_LT(norm(Vec3<double>{one.detail.P} - (X + Z * n)), 10 * rounding);
      ++met;
    }
    std::size_t inside = 0;
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 64; ++x)
        inside += norm(cross(C - place_on_film(traced.scene.camera, x + 0.5, y + 0.5), n)) < 1.1;
    EXPECT_EQ(met, inside);
    EXPECT_GT(met, 900U);  // 3.8 of 12, in 3072 pixels
  }
}

/// The edge of that disc, found by halving: the pixel of a film with two stands at a quarter of its extent.
TEST(Orthographic, TheSilhouetteIsExact) {
  for (const double far : {2.0, 700.0}) {
    double hits = 0.1, misses = 10;
    for (int i = 0; i < 60; ++i) {
      const double extent = 0.5 * (hits + misses);
      const auto traced = trace_text(scene_of("minkowski", film(extent, 2, 1),
                                              {placed({{"type", "sphere"}, {"radius", 0.7}}, {far, 0, 0})})
                                         .dump(),
                                     1);
      (traced.hits() == 2 ? hits : misses) = extent;
    }
    EXPECT_NEAR(0.25 * hits, 0.7, 1e-12) << far;
  }
}

TEST(Orthographic, ACubeHasNoPerspective) {
  std::vector<std::pair<double, double>> first;
  for (const double far : {2.0, 11.0, 1024.0}) {
    const Traced traced =
        trace_text(scene_of("minkowski", film(3, 60, 40),
                            {placed({{"type", "box"}, {"edges", {1, 1.2, 0.8}}}, {far, 0.1, 0.2})})
                       .dump());
    std::vector<std::pair<double, double>> pixels;
    for (const Seen& one : seen(traced)) {
      ASSERT_NEAR(one.hit.Z, far - 0.5, 1e-15 * far);  // the side faces are not seen
      ASSERT_NEAR(one.hit.mu, 1, 1e-15);
      pixels.emplace_back(one.x, one.y);
      // Across a cell of three times two.
      const auto& d = one.detail.duv;
      ASSERT_NEAR(std::fabs(d[0]) + std::fabs(d[1]), 3.0 / 60 / 1.2 / 3, 1e-12);
      ASSERT_NEAR(std::fabs(d[2]) + std::fabs(d[3]), 3.0 / 60 / 0.8 / 2, 1e-12);
    }
    EXPECT_EQ(pixels.size(), 24U * 16U);
    if (first.empty()) first = pixels;
    EXPECT_EQ(pixels, first);
  }
}

/// A film at rest sees each point of a moving sphere where it was when its light left.
TEST(Orthographic, AMovingSphereIsSeenWhereItWas) {
  const double v = 0.8, R = 1, gamma = 1 / std::sqrt(1 - v * v);
  json scene = scene_of(
      "minkowski", film(9, 90, 40),
      {{{"name", "ball"},
        {"shape", {{"type", "sphere"}, {"radius", R}}},
        {"placing",
         {{"type", "local"},
          {"worldline", {{"type", "geodesic"}, {"event", {-8, 8, 0, 0}}, {"velocity", {0, v, 0}}}}}}}});
  for (const char* paths : {"closed", "integrated"}) {
    scene["paths"] = paths;
    scene["accuracy"] = "reference";
    const Traced traced = trace_text(scene.dump());
    expect_no_doubts(traced);
    const double allowed = paths[0] == 'c' ? 1e-12 : 1e-9;
    std::size_t met = 0;
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 90; ++x) {
        // gamma^2 (D + v Z)^2 + (Z - 8)^2 + z^2 = R^2 with t = -Z and D = y - 8 v.
        const Vec3<double> X = place_on_film(traced.scene.camera, x + 0.5, y + 0.5);
        const double g2 = gamma * gamma, D = X[1] - 8 * v, a = 1 + g2 * v * v, b = 8 - g2 * v * D,
                     c = 64 + g2 * D * D + X[2] * X[2] - R * R;
        met += b * b > a * c;
      }
    EXPECT_EQ(traced.hits(), met);
    EXPECT_GT(met, 100U);
    for (const Seen& one : seen(traced)) {
      const Vec3<double> X = place_of(traced, one);
      const double g2 = gamma * gamma, D = X[1] - 8 * v, a = 1 + g2 * v * v, b = 8 - g2 * v * D,
                   c = 64 + g2 * D * D + X[2] * X[2] - R * R, root = std::sqrt(b * b - a * c);
      ASSERT_NEAR(one.hit.Z, (b - root) / a, allowed * (1 + 10 / root)) << paths;
      ASSERT_NEAR(one.hit.shift, 1 / gamma, allowed);  // across the line of sight
    }
  }
}

/// A film that moves along itself: its points are simultaneous for the observer, and he sees aberrated light.
TEST(Orthographic, AMovingFilmIsSimultaneousInItsOwnFrame) {
  const double v = 0.6, gamma = 1.25;
  json scene = scene_of(
      "minkowski", film(4, 40, 10, {0, 1, 0}),
      {{{"name", "wall"},
        {"shape", {{"type", "quad"}, {"edges", {40, 20}}}},
        {"placing",
         {{"type", "coordinate"}, {"centre", {0, 7, 0}}, {"z_axis", {0, -1, 0}}, {"y_axis", {0, 0, 1}}}}}});
  scene["observer"] = {{"event", {3, 0, 0, 0}}, {"velocity", {v, 0, 0}}};
  for (const char* paths : {"closed", "integrated"}) {
    scene["paths"] = paths;
    scene["accuracy"] = "reference";
    const Traced traced = trace_text(scene.dump());
    ASSERT_EQ(traced.hits(), 400U);
    const double allowed = paths[0] == 'c' ? 1e-14 : 1e-11;
    for (const Seen& one : seen(traced)) {
      const double s = (one.x - 20) * 0.1, z = (5 - one.y) * 0.1;  // to the right, which is +x; and upwards
      // From (gamma v s, gamma s, 0, z) along (-gamma, -gamma v, 1, 0).
      ASSERT_NEAR(one.hit.Z, 7, 10 * allowed);
      ASSERT_NEAR(one.hit.t, gamma * (v * s - 7), 20 * allowed) << paths;
      ASSERT_NEAR(one.detail.P[0], gamma * (s - v * 7), 20 * allowed);
      ASSERT_NEAR(one.detail.P[1], 7, 20 * allowed);
      ASSERT_NEAR(one.detail.P[2], z, 20 * allowed);
      ASSERT_NEAR(one.hit.shift, 1 / gamma,
                  allowed);  // what comes across his way
      ASSERT_NEAR(one.hit.mu, 1 / gamma, allowed);
      ASSERT_NEAR(std::fabs(one.detail.duv[0]), gamma * 0.1 / 40, 1e-12);
    }
  }
}

TEST(Orthographic, TheSkyIsOneDirection) {
  for (const char* paths : {"closed", "integrated"}) {
    json scene = scene_of("minkowski", film(4, 9, 7, {0.6, 0, 0.8}),
                          {{{"name", "sky"}, {"shape", {{"type", "sky"}}}}});
    scene["paths"] = paths;
    const Traced traced = trace_text(scene.dump());
    ASSERT_EQ(traced.hits(), 63U);
    for (const Seen& one : seen(traced)) {
      EXPECT_NEAR(one.hit.u, 0.5, 1e-15);
      EXPECT_NEAR(one.hit.v, 0.5 + std::asin(0.8) / std::numbers::pi, 1e-12);
      for (const double d : one.detail.duv) EXPECT_NEAR(d, 0, 1e-12);
    }
  }
}

/// Films pierce objects: rays that start inside meet the surface from inside.
TEST(Orthographic, RaysThatStartInsideLeave) {
  const std::vector<json> shapes = {{{"type", "sphere"}, {"radius", 1}},
                                    {{"type", "box"}, {"edges", {2, 2, 2}}},
                                    {{"type", "cylinder"}, {"radius", 1}, {"height", 2}},
                                    {{"type", "sphere"}, {"radius", 1}, {"dome", true}},
                                    {{"type", "box"}, {"edges", {2, 2, 2}}, {"dome", true}}};
  for (const std::string metric : {"minkowski", "goedel"})
    for (const char* paths : {"closed", "integrated"})
      for (const bool transparent : {false, true})
        for (const json& shape : shapes) {
          // The observer of a dome is inside; the film reaches beyond.
          const bool dome = shape.contains("dome");
          json scene = scene_of(metric, film(8, 40, 24), {placed(shape, {0.2, dome ? 0 : 2, 0})});
          scene["objects"][0]["transparent"] = transparent;
          if (metric == "goedel") scene["metric"]["a"] = 1e5;  // flat to 1e-5
          scene["paths"] = paths;
          scene["accuracy"] = "reference";
          scene["max_lookback"] = 50;
          const Traced traced = trace_text(scene.dump());
          expect_no_doubts(traced);
          const double allowed = metric == "goedel" ? 1e-3 : paths[0] == 'c' ? 1e-12 : 1e-8;
          // Half of what of a parallel to x lies in the shape; NaN: nothing does.
          const auto half_at = [&](const Vec3<double>& X) {
            const double y = X[1] - (dome ? 0 : 2), z = X[2], none = std::nan("");
            if (shape["type"] == "sphere") return std::sqrt(1 - y * y - z * z);
            if (std::fabs(y) > 1 || std::fabs(z) > 1) return none;
            return shape["type"] == "cylinder" ? std::sqrt(1 - y * y) : 1.0;
          };
          std::size_t expected = 0, met = 0;
          for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 40; ++x) {
              const double half = half_at(place_on_film(traced.scene.camera, x + 0.5, y + 0.5));
              if (half >= 0) expected += transparent && half < 0.2 ? 2 : 1;
            }
          for (const Seen& one : seen(traced)) {
            // The nearer surface lies behind the film where the film cuts the shape.
            const double half = half_at(place_of(traced, one)), rounding = allowed * (1 + 1 / (half + 1e-3));
            const double nearer = 0.2 - half, farther = 0.2 + half;
            const bool is_nearer = nearer > 0 && std::fabs(one.hit.Z - nearer) < rounding;
            const bool is_farther = (nearer < 0 || transparent) && std::fabs(one.hit.Z - farther) < rounding;
            ASSERT_TRUE(is_nearer || is_farther) << metric << paths << shape << one.hit.Z << " " << nearer;
            ++met;
          }
          EXPECT_EQ(met, expected) << metric << paths << shape;
          EXPECT_GT(met, 60U) << shape;
        }
}

/// Time counts from the observation, not from where the ray starts.
TEST(Orthographic, LookbackInTimeCountsFromTheObservation) {
  json scene = scene_of(
      "minkowski", film(40, 40, 2, {0, 1, 0}),
      {{{"name", "wall"},
        {"shape", {{"type", "quad"}, {"edges", {400, 20}}}},
        {"placing",
         {{"type", "coordinate"}, {"centre", {0, 7, 0}}, {"z_axis", {0, -1, 0}}, {"y_axis", {0, 0, 1}}}}}});
  scene["observer"] = {{"event", {3, 0, 0, 0}}, {"velocity", {0.6, 0, 0}}};
  scene["max_lookback"] = {{"t", 8}};
  for (const char* paths : {"closed", "integrated"}) {
    scene["paths"] = paths;
    const Traced traced = trace_text(scene.dump());
    std::size_t expected = 0, too_early = 0, stay = 0;
    for (int x = 0; x < 40; ++x) too_early += 1.25 * 0.6 * (x + 0.5 - 20) < -8 ? 2 : 0;
    for (const TracedBand& band : traced.bands)
      for (const RayRecord& ray : band.rays) stay += ray.steps == 0;
    EXPECT_EQ(stay, too_early);
    EXPECT_GT(too_early, 10U);
    for (int x = 0; x < 40; ++x) expected += 1.25 * (0.6 * (x + 0.5 - 20) - 7) >= -8 ? 2 : 0;
    EXPECT_EQ(traced.hits(), expected) << paths;
    EXPECT_EQ(traced.rays_with(Status::lookback_reached), 80 - expected);
    EXPECT_GT(expected, 10U);
  }
}

TEST(Orthographic, WhatIsWrongIsRefused) {
  const auto complaint = [](const json& camera) -> std::string {
    try {
      const auto metrics = metric_descriptions();
      read_scene(
          scene_of("minkowski", camera, {placed({{"type", "sphere"}, {"radius", 1}}, {5, 0, 0})}).dump(),
          "file", metrics);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  };
  const json good = film(3, 4, 4);
  EXPECT_EQ(complaint(good), "");
  for (const auto& [changes, place] : {std::pair<json, std::string>{{{"extent", 0}}, "/extent"},
                                       {{{"extent", nullptr}}, "/extent"},
                                       {{{"extent", {1, 2}}}, "/extent"},
                                       {{{"fov_deg", 60}}, "/fov_deg"},
                                       {{{"type", "perspective"}, {"fov_deg", 60}}, "/extent"}}) {
    json changed = good;
    changed.update(changes);
    EXPECT_EQ(complaint(changed).find("file: /camera" + place + ": "), 0U) << complaint(changed);
    EXPECT_EQ(complaint(changed).find('\n'), std::string::npos);
  }
  // The observer himself may not stand inside.
  json scene = scene_of("minkowski", good, {placed({{"type", "sphere"}, {"radius", 1}}, {0.5, 0, 0})});
  EXPECT_THROW(trace_text(scene.dump()), InputError);
}

}  // namespace
}  // namespace nullcone::test
