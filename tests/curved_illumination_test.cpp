// Light of lamps in the Gödel universe: flat limit, isometries, shadows along curved rays that return.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/trace/lamps.h"
#include "metrics/goedel_kernel.h"
#include "metrics/minkowski_kernel.h"
#include "tests/lit_scene.h"
#include "tests/random_rays.h"

namespace nullcone::test {
namespace {

using namespace host;

/// A camera that sees everything.
Camera all_round(int width) {
  Camera out = camera(width, width / 2, 1);
  out.type = CameraType::panorama;
  out.fov_horizontal = 2 * std::numbers::pi, out.fov_vertical = std::numbers::pi;
  return out;
}

Triple random_velocity(Random& random, double most) {
  return (random.uniform(0, most) * random.direction()).c;
}

/// A moving sphere, a box at rest and a moving lamp, at some distance from one another.
Scene random_scene(Random& random, double size, double speed, double turn_back = 3) {
  const auto event = [&] {
    const Vec3<double> X = size * random.uniform(0.5, 1) * random.direction();
    return Event{-random.uniform(0, turn_back) * size, X[0], X[1], X[2]};
  };
  Object box = ball(event(), 0);
  box.name = "box";
  box.shape.type = ShapeType::box;
  box.shape.edges = {0.2 * size, 0.3 * size, 0.15 * size};
  Scene out = scene_of(all_round(48), {ball(event(), 0.2 * size, random_velocity(random, speed)), box},
                       {point_lamp(event(), random_velocity(random, speed))});
  out.observer.velocity = random_velocity(random, speed);
  out.objects[0].placing.gyroscope_axes = true;  // static axes turn differently elsewhere
  return out;
}

TEST(CurvedIllumination, is_that_of_flat_space_for_a_huge_universe) {
  Random random(81);
  std::size_t lights = 0;
  for (int n = 0; n < 200; ++n) {
    Scene scene = random_scene(random, 1, 0.9);
    scene.lights.shadows = n % 2 == 0;
    const double a = 1e9;
    LightSink flat, curved;
    try {
      flat = lit(Minkowski{}, scene);
      scene.max_lookback = a;
      curved = lit(Goedel{a}, scene);
    } catch (const InputError&) {
      continue;  // an observer within the sphere
    }
    ASSERT_EQ(flat.hits.size(), curved.hits.size());
    for (std::size_t i = 0; i < flat.hits.size(); ++i) {
      const HitLight &one = flat.light(i), &other = curved.light(i);
      if (std::max(one.E, other.E) < 1e-3 || (one.E == 0) != (other.E == 0)) continue;  // rims
      ++lights;
      EXPECT_NEAR(other.E, one.E, 1e-6 * one.E + 1e-7);
      EXPECT_NEAR(other.shift, one.shift, 1e-7 * one.shift);
      EXPECT_NEAR(other.t, one.t, 1e-6);
      EXPECT_NEAR(other.tau + curved.tau_origin, one.tau + flat.tau_origin, 1e-6);
    }
  }
  EXPECT_GT(lights, 3000u);
}

/// The same scene elsewhere: everything carried from the origin to P by the isometry.
Scene carried(Scene scene, const Goedel& metric, const Vec4<double>& P) {
  const auto carry = [&](Worldline& line) {
    const Vec4<double> there = metric.from_origin(P, Vec4<double>{line.event});
    const Complex<double> turn = conj(metric.turn(P, there));
    const Vec4<double> v =
        turned_about_e3(turn, Vec4<double>{{0, line.velocity[0], line.velocity[1], line.velocity[2]}});
    line = {there.c, {v[1], v[2], v[3]}};
    return turn;
  };
  for (Object& object : scene.objects) {
    const Complex<double> turn = carry(object.placing.worldline);
    // Axes stand in the frame boosted from the static axes, which have turned.
    for (Triple& axis : object.placing.axes) {
      const Vec4<double> v = turned_about_e3(turn, Vec4<double>{{0, axis[0], axis[1], axis[2]}});
      axis = {v[1], v[2], v[3]};
    }
  }
  for (Lamp& lamp : scene.lights.lamps) carry(lamp.placing.worldline);
  scene.observer.event =
      metric.from_origin(P, Vec4<double>{scene.observer.event}).c;  // at the origin: no turn
  return scene;
}

TEST(CurvedIllumination, is_the_same_everywhere) {
  Random random(82);
  std::size_t lights = 0, differ = 0;
  const Goedel metric{1};
  for (int n = 0; n < 200; ++n) {
    Scene scene = random_scene(random, 0.8, 0.6);
    scene.max_lookback = 8;
    scene.lights.windings = 2;
    scene.lights.paths = 4;
    const Vec3<double> place = random.logarithmic(0.1, 5) * random.direction();
    try {
      const LightSink here = lit(metric, scene);
      const LightSink there = lit(metric, carried(scene, metric, {{3, place[0], place[1], place[2]}}));
      ASSERT_EQ(here.hits.size(), there.hits.size());
      for (std::size_t i = 0; i < here.hits.size(); ++i)
        for (std::size_t k = 0; k < here.paths; ++k) {
          const HitLight &one = here.light(i, k), &other = there.light(i, k);
          lights += one.E > 0;
          if (one.E == 0 && other.E == 0) continue;
          differ += std::fabs(one.E - other.E) > 1e-6 * (one.E + 1e-3) ||
                    std::fabs(one.shift - other.shift) > 1e-6 ||
                    std::fabs(one.tau + here.tau_origin - other.tau - there.tau_origin) > 1e-6;
        }
    } catch (const InputError&) {
    }
  }
  EXPECT_GT(lights, 5000u);
  EXPECT_LE(differ, lights / 1000);  // rims of shadows, and caustics
}

/// Whether a static ball stands in the way of light, by many points along it; and how near it comes.
double nearest(const Goedel& metric, const Connection<double>& c, const Vec4<double>& event,
               const Vec4<double>& centre, double from) {
  const auto path = metric.path(event, c.past);
  double least = 1e300;
  constexpr int kPoints = 4000;
  for (int i = 0; i <= kPoints; ++i) {
    const double lambda = from + (c.lambda - from) * i / kPoints;
    least = std::min(least, norm(spatial(metric.to_origin(centre, path.at(lambda).event))));
  }
  return least;
}

/// |grad r| of the chart's radius r.
double steepness_of_radius(const Goedel& metric, const Vec4<double>& x) {
  const Matrix4<double> up = inverse(metric.g(x));
  const double r = norm(spatial(x));
  const Vec4<double> gradient = {{0, x[1] / r, x[2] / r, x[3] / r}};
  return std::sqrt(-inner(up, gradient, gradient));
}

TEST(CurvedIllumination, shadows_follow_the_rays) {
  Random random(83);
  const Goedel metric{1};
  int dark = 0, free = 0, itself = 0;
  for (int n = 0; n < 120; ++n) {
    const auto place = [&] {
      const Vec3<double> X = random.uniform(0.4, 1.6) * random.direction();
      return Event{0, X[0], X[1], 0.3 * X[2]};
    };
    const Object lit_ball = ball(place(), 0.2), screen = ball(place(), 0.3);
    const Event lamp_event = place();
    Scene scene = scene_of(all_round(32), {lit_ball, screen}, {point_lamp(lamp_event)});
    scene.max_lookback = 8;
    scene.lights.windings = 2;
    scene.lights.paths = 4;
    LightSink found;
    try {
      found = lit(metric, scene);
    } catch (const InputError&) {
      continue;
    }
    const LampLine<Goedel> line = place_lamp(metric, scene.lights.lamps[0], 0).lines[0];
    for (std::size_t i = 0; i < found.hits.size(); ++i) {
      if (found.hits[i].id != 1) continue;
      const HitRecord& hit = found.hits[i];
      const double longitude = 2 * std::numbers::pi * (hit.u - 0.5),
                   latitude = std::numbers::pi * (hit.v - 0.5);
      const Vec3<double> N = {{std::cos(latitude) * std::cos(longitude),
                               std::cos(latitude) * std::sin(longitude), std::sin(latitude)}};
      const Vec4<double> centre{lit_ball.placing.worldline.event};
      const Vec4<double> event = metric.from_origin(
          centre, Vec4<double>{{hit.tau - centre[0] + 0, 0.2 * N[0], 0.2 * N[1], 0.2 * N[2]}});
      double sum = 0;
      bool doubtful = false;
      for (int branch = 0; branch < branches(metric, line, 2); ++branch) {
        const Connection<double> c = connect(metric, event, line, branch);
        if (!c.found) continue;
        const auto path = metric.path(event, c.past);
        const Vec4<double> away = metric.to_origin(centre, path.at(1e-6 * c.lambda).event);
        const double rises = norm(spatial(away)) - 0.2;
        if (rises < 1e-9) {
          doubtful |= rises > -1e-9;
          continue;  // comes from below the surface
        }
        const double other = nearest(metric, c, event, Vec4<double>{screen.placing.worldline.event}, 0) - 0.3,
                     own = nearest(metric, c, event, centre, 0.01 * c.lambda) - 0.2;
        doubtful |= std::fabs(other) < 1e-4 || std::fabs(own) < 1e-3;
        if (own < 0) ++itself;
        if (other < 0 || own < 0) continue;
        // The ball rests with the dust, so k.u = 1; its chart is not orthonormal where its surface is.
        const double slope = rises / (1e-6 * c.lambda) / steepness_of_radius(metric, away);
        sum += slope / std::fabs(c.det);
      }
      if (doubtful) continue;
      double E = 0;
      for (std::size_t k = 0; k < found.paths; ++k) E += found.light(i, k).E;
      ++(sum == 0 ? dark : free);
      EXPECT_NEAR(E, sum, 2e-3 * sum + 1e-5);
    }
  }
  std::printf("%d dark, %d lit, %d by itself\n", dark, free, itself);
  EXPECT_GT(dark, 200);
  EXPECT_GT(free, 500);
  EXPECT_GT(itself, 100);
}

}  // namespace
}  // namespace nullcone::test
