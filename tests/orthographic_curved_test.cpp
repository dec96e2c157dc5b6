// Films in curved spacetime: against an isometry written down on its own, single geodesics, and a shadow.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "core/base/boost.h"
#include "metrics/goedel.h"
#include "tests/film.h"

namespace nullcone::test {
namespace {

using namespace host;

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

TEST(OrthographicCurved, InTheGoedelUniverseAnIsometryCarriesTheFilm) {
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
TEST(OrthographicCurved, SingleRaysAreTheTracers) {
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

TEST(OrthographicCurved, ClosedAndIntegratedPathsAgree) {
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
TEST(OrthographicCurved, DifferentialsAreThoseBetweenRays) {
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
TEST(OrthographicCurved, WithoutIsometriesToFirstOrder) {
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
TEST(OrthographicCurved, WhereThereIsNoObserverThereIsNoRay) {
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
TEST(OrthographicCurved, AHolesShadowHasItsRadius) {
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

}  // namespace
}  // namespace nullcone::test
