// Films: rays that start at different events in one direction, against parallel rays in flat space, an
// isometry written down on its own, and single geodesics.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>

#include "core/base/boost.h"
#include "core/base/error.h"
#include "metrics/goedel.h"
#include "tests/sanitized.h"
#include "tests/traced.h"

namespace nullcone::test {
namespace {

using namespace host;
using nlohmann::json;

const json kAllChannels = {{"differentials", true},
                           {"channels", {"order", "uv", "shift", "t", "tau", "mu", "N", "K", "P"}}};

/// A film of square pixels, `extent` wide, that looks along `forward`.
json film(double extent, int width, int height, const json& forward = {1, 0, 0}) {
  return {
      {"type", "orthographic"}, {"extent", extent}, {"resolution", {width, height}}, {"forward", forward}};
}

json placed(const json& shape, const json& centre, const char* name = "it") {
  return {{"name", name}, {"shape", shape}, {"placing", {{"type", "coordinate"}, {"centre", centre}}}};
}

json scene_of(const std::string& metric, const json& camera, const std::vector<json>& objects) {
  return {{"metric", {{"name", metric}}},
          {"observer", {{"event", {0, 0, 0, 0}}}},
          {"camera", camera},
          {"objects", objects},
          {"records", kAllChannels}};
}

struct Seen {
  HitRecord hit;
  HitDetail detail;
  double x, y;  ///< picture coordinates
};

std::vector<Seen> seen(const Traced& traced) {
  std::vector<Seen> out;
  traced.for_each_hit([&](const HitRecord& hit, std::size_t x, std::size_t y) {
    const TracedBand& band = traced.bands[y / kBandLines];
    const auto i = static_cast<std::size_t>(&hit - band.hits.data());
    out.push_back({hit, band.details.at(i), static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5});
  });
  return out;
}

Vec3<double> place_of(const Traced& traced, const Seen& one) {
  return place_on_film(traced.scene.camera, one.x, one.y);
}

void expect_no_doubts(const Traced& traced) {
  EXPECT_EQ(traced.rays_with(Status::step_limit) + traced.rays_with(Status::not_finite), 0U);
}

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

std::vector<double> parameters_of(const Scene& scene) {
  std::vector<double> out;
  for (const auto& p : find_spacetime(scene.metric).description().parameters)
    out.push_back(scene.metric_parameters.at(std::string(p.name)));
  return out;
}

/// An event on the ray through a point of the picture: where to put objects that shall be seen.
Event on_ray(const json& scene, double x, double y, double lambda) {
  const auto metrics = metric_descriptions();
  const Scene read = read_scene(scene.dump(), "test", metrics);
  const Spacetime& spacetime = find_spacetime(read.metric);
  const auto parameters = parameters_of(read);
  const auto ray = spacetime.camera_ray(parameters, read.camera, read.observer, x, y);
  return spacetime.geodesic(parameters, ray.event, ray.past, {&lambda, 1}, nullptr, ray.frame)[0].event;
}
json place_on_ray(const json& scene, double x, double y, double lambda) {
  const Event event = on_ray(scene, x, y, lambda);
  return {event[1], event[2], event[3]};
}

/// In the Gödel universe, of observers at rest and in motion.
json goedel_scene(const json& velocity, const char* paths) {
  json scene = scene_of("goedel", film(1.6, 31, 21, {1, 0.5, 0.3}),
                        {placed({{"type", "sphere"}, {"radius", 0.25}}, {9, 9, 9}, "ball")});
  scene["observer"] = {{"event", {2, 0.4, 0.3, 0.1}}, {"velocity", velocity}};
  scene["paths"] = paths;
  scene["accuracy"] = "reference";
  const json ball = place_on_ray(scene, 15.5, 10.5, 0.9), box = place_on_ray(scene, 25, 6, 0.7),
             event = on_ray(scene, 6, 15, 0.6);
  scene["objects"][0]["placing"]["centre"] = ball;
  scene["objects"].push_back(placed({{"type", "box"}, {"edges", {0.3, 0.4, 0.3}}}, box, "box"));
  if (paths[0] == 'i') return scene;  // what moves has closed paths alone
  scene["objects"].push_back(
      {{"name", "thrown"},
       {"shape", {{"type", "sphere"}, {"radius", 0.15}}},
       {"placing",
        {{"type", "local"},
         {"axes", "gyroscope"},
         {"worldline", {{"type", "geodesic"}, {"event", event}, {"velocity", {0.3, -0.2, 0.1}}}}}}});
  return scene;
}

/// The event that the isometry of P makes of an event of the chart about it, in the Poincaré disc: as (3.1)
/// of docs/physics.md has it, a = 1.
Vec4<double> carried(const Vec4<double>& P, const Vec4<double>& x) {
  using C = std::complex<double>;
  const auto disc = [](const C& q) { return q / std::sqrt(4 + std::norm(q)); };
  const C w0 = disc({P[1], P[2]}), w = disc({x[1], x[2]}), one = 1.0 + std::conj(w0) * w, to = (w + w0) / one;
  const C q = 2.0 * to / std::sqrt(1 - std::norm(to));
  return {{P[0] + x[0] - 2 * std::sqrt(2) * std::arg(one), q.real(), q.imag(), P[3] + x[3]}};
}

TEST(Orthographic, InTheGoedelUniverseAnIsometryCarriesTheFilm) {
  for (const json& velocity : {json{0, 0, 0}, json{0.4, -0.3, 0.2}})
    for (const char* paths : {"closed", "integrated"}) {
      const Traced traced = trace_text(goedel_scene(velocity, paths).dump());
      expect_no_doubts(traced);
      const Vec4<double> O{traced.scene.observer.event},
          u = four_velocity(Vec3<double>{traced.scene.observer.velocity});
      const Vec4<double> past = -seen_photon(u, Vec3<double>{traced.scene.camera.forward});
      const double allowed = paths[0] == 'c' ? 1e-12 : 1e-9;
      std::array<std::size_t, 4> met{};
      for (const Seen& one : seen(traced)) {
        const Vec3<double> X = place_of(traced, one);
        const Vec4<double> start = boost(opposite(u), Vec4<double>{{0, X[0], X[1], X[2]}});
        const Vec4<double> event = carried(O, Goedel{}.path(start, past).at(one.hit.Z).event);
        ASSERT_NEAR(one.hit.t, event[0] - O[0], allowed) << paths;
        ASSERT_LT(norm(Vec3<double>{one.detail.P} - spatial(event - O)), allowed) << paths;
        ++met[one.hit.id];
      }
      for (std::size_t id = 1; id < (paths[0] == 'c' ? 4U : 3U); ++id) EXPECT_GT(met[id], 10U) << id;
    }
}

/// The tools' single rays start where the tracer's do.
TEST(Orthographic, SingleRaysAreTheTracers) {
  const double a = 1;
  for (const char* paths : {"closed", "integrated"})
    for (const bool normal : {false, true}) {
      if (normal && paths[0] == 'c') continue;
      json scene = goedel_scene({0.4, -0.3, 0.2}, paths);
      if (normal) scene["observer"]["frame"] = "normal";
      const Traced traced = trace_text(scene.dump());
      const Spacetime& goedel = find_spacetime("goedel");
      const Accuracy accuracy = kReference;
      for (const Seen& one : seen(traced)) {
        const auto ray = goedel.camera_ray({&a, 1}, traced.scene.camera, traced.scene.observer, one.x, one.y);
        const auto point = goedel.geodesic({&a, 1}, ray.event, ray.past, {&one.hit.Z, 1},
                                           paths[0] == 'c' ? nullptr : &accuracy, ray.frame)[0];
        const Vec4<double> event{point.event}, O{traced.scene.observer.event};
        ASSERT_NEAR(one.hit.t, event[0] - O[0], paths[0] == 'c' ? 1e-12 : 1e-9);
        ASSERT_LT(norm(Vec3<double>{one.detail.P} - spatial(event - O)), paths[0] == 'c' ? 1e-12 : 1e-9);
      }
    }
}

TEST(Orthographic, ClosedAndIntegratedPathsAgree) {
  json scene = goedel_scene({0.4, -0.3, 0.2}, "integrated");
  const auto integrated = seen(trace_text(scene.dump()));
  scene["paths"] = "closed";
  const auto closed = seen(trace_text(scene.dump()));
  ASSERT_EQ(closed.size(), integrated.size());
  for (std::size_t i = 0; i < closed.size(); ++i) {
    const HitRecord &a = closed[i].hit, &b = integrated[i].hit;
    ASSERT_EQ(a.pixel, b.pixel);
    ASSERT_EQ(a.id, b.id);
    const double oblique = 1 / a.mu;
    ASSERT_NEAR(a.Z, b.Z, 1e-9 * oblique);
    ASSERT_NEAR(a.u, b.u, 1e-9 * oblique);
    ASSERT_NEAR(a.v, b.v, 1e-9 * oblique);
    ASSERT_NEAR(a.shift, b.shift, 1e-9 * oblique);
    ASSERT_NEAR(a.tau, b.tau, 1e-9 * oblique);
  }
}

/// Changes from pixel to pixel are those between films with finer pixels: a 16th (closed), a half
/// (integrated).
TEST(Orthographic, DifferentialsAreThoseBetweenRays) {
  for (const char* paths : {"closed", "integrated"})
    for (const json& velocity : {json{0, 0, 0}, json{0.4, -0.3, 0.2}}) {
      const double pixel = 4e-3, part = paths[0] == 'c' ? 0.0625 : 0.5;
      json scene = goedel_scene(velocity, paths);
      scene["camera"] = film(3 * pixel, 3, 3, {1, 0.5, 0.3});
      const auto coarse = seen(trace_text(scene.dump()));
      scene["camera"] = film(3 * part * pixel, 3, 3, {1, 0.5, 0.3});
      const auto fine = seen(trace_text(scene.dump()));
      ASSERT_EQ(coarse.size(), 9U);
      ASSERT_EQ(fine.size(), 9U);
      const auto& duv = coarse[4].detail.duv;
      const std::array<double, 4> expected = {
          (fine[5].hit.u - fine[3].hit.u) / (2 * part), (fine[5].hit.v - fine[3].hit.v) / (2 * part),
          (fine[7].hit.u - fine[1].hit.u) / (2 * part), (fine[7].hit.v - fine[1].hit.v) / (2 * part)};
      for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(duv[i], expected[i], 2e-4 * pixel) << paths << i;  // its square; uv change by some pixels
    }
}

/// Without isometries: events along the observer's axes in the chart, tangents in the tetrad there.
TEST(Orthographic, WithoutIsometriesToFirstOrder) {
  for (const std::string metric : {"kerr_schild", "ellis_wormhole"}) {
    json scene = scene_of(metric, film(12, 25, 15, {-1, 0.1, -0.05}),
                          {placed({{"type", "sphere"}, {"radius", 2}}, {99, 99, 99}, "ball")});
    scene["observer"] = {{"event", {5, 16, 1, 2}}, {"velocity", {0.2, 0.5, -0.1}}};
    scene["accuracy"] = "reference";
    if (metric == "kerr_schild") scene["metric"]["spin"] = 0.8;
    const json ball = place_on_ray(scene, 8, 6, 25), box = place_on_ray(scene, 20, 10, 8);
    scene["objects"][0]["placing"]["centre"] = ball;
    scene["objects"].push_back(placed({{"type", "box"}, {"edges", {2, 3, 2}}}, box, "box"));
    const Traced traced = trace_text(scene.dump());
    expect_no_doubts(traced);
    const Spacetime& spacetime = find_spacetime(metric);
    const auto parameters = parameters_of(traced.scene);
    const Vec4<double> O{traced.scene.observer.event},
        u = four_velocity(Vec3<double>{traced.scene.observer.velocity});
    const Event past = (-seen_photon(u, Vec3<double>{traced.scene.camera.forward})).c;
    const auto axes = spacetime.static_tetrad(parameters, O.c);
    std::array<std::size_t, 3> met{};
    for (const Seen& one : seen(traced)) {
      const Vec3<double> X = place_of(traced, one);
      const Vec4<double> aside = boost(opposite(u), Vec4<double>{{0, X[0], X[1], X[2]}});
      Vec4<double> start = O;
      for (std::size_t i = 0; i < 4; ++i) start = start + aside[i] * Vec4<double>{axes[i]};
      const Accuracy accuracy = kReference;
      const auto point = spacetime.geodesic(parameters, start.c, past, {&one.hit.Z, 1}, &accuracy)[0];
      const Vec4<double> event{point.event};
      ASSERT_NEAR(one.hit.t, event[0] - O[0], 1e-7);
      ASSERT_LT(norm(Vec3<double>{one.detail.P} - spatial(event - O)), 1e-7);
      ++met[one.hit.id];
    }
    EXPECT_GT(met[1], 5U);
    EXPECT_GT(met[2], 20U);
  }
}

/// A film through a black hole: no observer is at rest in there, but those at right angles to t = const are.
TEST(Orthographic, WhereThereIsNoObserverThereIsNoRay) {
  json scene = scene_of("kerr_schild", film(10, 30, 30, {0, 0.001, 1}),
                        {{{"name", "sky"}, {"shape", {{"type", "sky"}}}}});
  scene["observer"]["event"] = {0, 3.03, 0, 0};
  scene["accuracy"] = "draft";
  const Traced traced = trace_text(scene.dump());
  expect_no_doubts(traced);
  // Of a hole of mass 1 at the origin; X is at right angles to the radius or along it, but for its stretch.
  const Spacetime& hole = find_spacetime("kerr_schild");
  const auto parameters = parameters_of(traced.scene);
  const auto axes = hole.static_tetrad(parameters, {0, 3.03, 0, 0});
  std::size_t none = 0;
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 30; ++x) {
      const Vec3<double> X = place_on_film(traced.scene.camera, x + 0.5, y + 0.5);
      Vec3<double> at = {{3.03, 0, 0}};
      for (std::size_t i = 0; i < 3; ++i)
        at = at + X[i] * Vec3<double>{{axes[i + 1][1], axes[i + 1][2], axes[i + 1][3]}};
      const auto status = traced.bands[static_cast<std::size_t>(y / kBandLines)]
                              .rays[static_cast<std::size_t>(y % kBandLines * 30 + x)]
                              .status;
      ASSERT_EQ(status == static_cast<std::uint32_t>(Status::outside), norm(at) < 2) << x << " " << y;
      none += norm(at) < 2;
    }
  EXPECT_GT(none, 20U);
  scene["observer"]["frame"] = "normal";
  const Traced normal = trace_text(scene.dump());
  EXPECT_EQ(normal.rays_with(Status::outside), 0U);
  EXPECT_EQ(normal.rays_with(Status::not_finite), 0U);
}

/// From afar the shadow of a black hole is a disc of radius 3 sqrt3 M: there parallel rays know their impact
/// parameter, to M/distance.
TEST(Orthographic, AHolesShadowHasItsRadius) {
  json scene =
      scene_of("kerr_schild", film(1, 2, 1, {-1, 0, 0}), {{{"name", "sky"}, {"shape", {{"type", "sky"}}}}});
  scene["observer"]["event"] = {0, 1e5, 0, 0};
  double falls = 1, escapes = 60;
  for (int i = 0; i < 30; ++i) {
    const double extent = 0.5 * (falls + escapes);
    scene["camera"]["extent"] = extent;
    const Traced traced = trace_text(scene.dump(), 1);
    (traced.rays_with(Status::captured) == 2 ? falls : escapes) = extent;
  }
  EXPECT_NEAR(0.25 * falls, 3 * std::sqrt(3), 2e-4);  // some M/distance
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
