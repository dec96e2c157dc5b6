// A million random rays against spheres of radius 1e-6 to 1: no crossing is missed, none is invented.
//
// The oracle knows nothing of the search: it halves [0, limit] until bounds that follow from the line element
// alone exclude a piece, or a point of it lies inside the sphere.
#include <cstdlib>
#include <functional>

#include "core/trace/crossing.h"
#include "metrics/goedel_kernel.h"
#include "metrics/minkowski_kernel.h"
#include "tests/random_rays.h"
#include "tests/reference_cases.h"
#include "tests/sanitized.h"

namespace nullcone::test {
namespace {

using namespace nullcone::host;

/// How many of `full` cases to run: a fraction under sanitizers, a multiple in scripts/soak.sh.
int rays(int full) {
  if (kSanitized) return full / 50;
  const char* soak = std::getenv("NULLCONE_SOAK");
  return full * (soak ? std::max(1, std::atoi(soak)) : 1);
}

constexpr Matrix3<double> kAxes = {{{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}};

/// asinh |q|: half the distance from the axis in units of a.
template <class S>
S asinh_of(const Complex<S>& q) {
  const S u2 = norm2(q), u = sqrt(u2);
  return log(u + sqrt(S(1.0) + u2));
}

/// Entry of the first piece of [from, to] with depth(lambda) < 0, or -1. `reach(lambda, half)` is true if the
/// sphere may be met within half of lambda.
double oracle(double from, double to, const std::function<double(double)>& depth,
              const std::function<bool(double, double)>& reach) {
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  if (!reach(middle, half) || half < 1e-14 * (1 + to)) return -1;
  if (depth(middle) < 0) {  // the entry lies before it
    const double earlier = oracle(from, middle - 1e-3 * half, depth, reach);
    if (earlier >= 0) return earlier;
    double outside = from, inside = middle;
    for (int i = 0; i < 60; ++i) {
      const double x = 0.5 * (outside + inside);
      (depth(x) < 0 ? inside : outside) = x;
    }
    return inside;
  }
  const double left = oracle(from, middle, depth, reach);
  return left >= 0 ? left : oracle(middle, to, depth, reach);
}

struct Tally {
  int rays = 0, hits = 0, missed = 0, invented = 0, misplaced = 0, given_up = 0;

  /// `graze` is the least depth over R that must not be missed; `depth_at` tells how deep a claimed crossing
  /// lies.
  void compare(double expected, const Search<double>& found, double tolerance,
               const std::function<double(double)>& depth, double radius) {
    ++rays;
    hits += expected >= 0;
    given_up += found.given_up;
    if (expected >= 0 && !found.met) {
      // A crossing whose chord is within rounding of nothing may be called either way.
      double deepest = 0;
      for (int i = 0; i <= 64; ++i) deepest = std::min(deepest, depth(expected + 1e-6 * radius * i));
      missed += deepest < -1e-10 * radius;
    }
    if (expected < 0 && found.met) invented += depth(found.lambda) > 1e-9 * radius + 1e-14;
    if (expected >= 0 && found.met) misplaced += std::fabs(found.lambda - expected) > tolerance;
  }
  void expect_clean() const {
    EXPECT_EQ(missed, 0);
    EXPECT_EQ(invented, 0);
    EXPECT_EQ(misplaced, 0);
    EXPECT_EQ(given_up, 0);
    EXPECT_GT(hits, rays / 8) << "the rays should be aimed well";
    EXPECT_LT(hits, rays * 7 / 8);
  }
};

struct RayStart {
  Vec4<double> event, k;
};

/// A ray of random length that passes within about 2 R of the event `target`: traced to the future from
/// there.
template <class M>
RayStart ray_through(const M& metric, const Vec4<double>& target, double lambda, Random& random) {
  const auto P = metric.path(target, moving(random.direction())).at(lambda);
  return {P.event, -P.local};
}

/// How near a root can be told: |X|^2 - R^2 is known to rounding of the coordinates, and grazing roots are
/// double.
double root_tolerance(double radius, double scale) {
  return std::max(1e-11 * scale, 3 * std::sqrt(radius * 1e-15 * scale));
}

double product_distance(const Goedel& metric, const Vec4<double>& x) {
  const double plane = 2 * metric.a * asinh_of(metric.to_q(x));
  return std::hypot(plane, x[3]);
}

TEST(Crossings, StaticSpheresInGoedel) {
  Random random(1);
  Tally tally;
  for (int n = 0; n < rays(400'000); ++n) {
    const Goedel metric{random.uniform(0.5, 5)};
    const double R = random.logarithmic(1e-6, 1), limit = 10 * metric.a;
    const Vec4<double> P = random.event(2 * metric.a);
    const Vec3<double> off = random.uniform(0, 2) * R * random.direction();
    const auto start = ray_through(metric, metric.from_origin(P, Vec4<double>{{0, off[0], off[1], off[2]}}),
                                   random.uniform(0, limit), random);
    const auto path =
        metric.path(metric.to_origin(P, start.event), turned_about_e3(metric.turn(P, start.event), start.k));
    const auto at = [&](double l) { return path.at(l).event; };
    if (norm(spatial(at(0))) <= R * 1.001) continue;
    const auto depth = [&](double l) { return norm(spatial(at(l))) - R; };
    // Local speed 1 in H^2 x R, whose ball holds the chart's ball; chart speed at most cosh(rho) on the way.
    const auto reach = [&](double l, double half) {
      const Vec4<double> x = at(l);
      const double speed = std::cosh(asinh_of(metric.to_q(x)) + 0.5 * half / metric.a);
      return product_distance(metric, x) - half * 1.0000001 < R &&
             norm(spatial(x)) - half * speed * 1.0000001 < R;
    };
    const Sphere sphere{R};
    const RestPlacing<Goedel> placing{metric, P, true, kAxes, R};
    tally.compare(oracle(0, limit, depth, reach),
                  first_crossing(placing.ray(placing.launch(start.event), start.k), sphere, limit,
                                 4e-15 * norm(spatial(start.event))),
                  root_tolerance(R, 10 * metric.a), depth, R);
  }
  tally.expect_clean();
  RecordProperty("rays", tally.rays);
}

TEST(Crossings, CoordinateSpheresInGoedel) {
  Random random(2);
  Tally tally;
  for (int n = 0; n < rays(150'000); ++n) {
    const Goedel metric{random.uniform(0.5, 5)};
    const double R = random.logarithmic(1e-6, 1), limit = 5 * metric.a;
    const Vec4<double> place = random.event(1.5 * metric.a);
    const Vec3<double> off = random.uniform(0, 2) * R * random.direction();
    const auto start = ray_through(metric, place + Vec4<double>{{0, off[0], off[1], off[2]}},
                                   random.uniform(0, limit), random);
    const auto path = metric.path(start.event, start.k);
    const auto depth = [&](double l) { return norm(spatial(path.at(l).event - place)) - R; };
    if (depth(0) <= 1e-3 * R) continue;
    const double speed =
        std::cosh(asinh_of(metric.to_q(start.event)) + 0.8814);  // chart speed on the whole ray
    const auto reach = [&](double l, double half) { return depth(l) - half * speed < 0; };
    const RestPlacing<Goedel> placing{metric, place, false, kAxes, R};
    tally.compare(oracle(0, limit, depth, reach),
                  first_crossing(placing.ray(placing.launch(start.event), start.k), Sphere{R}, limit,
                                 4e-15 * norm(spatial(start.event))),
                  root_tolerance(R, 10 * metric.a), depth, R);
  }
  tally.expect_clean();
  RecordProperty("rays", tally.rays);
}

/// Lipschitz bound of the distance in co-moving cylindrical coordinates about the centre of the object's
/// orbit: own local speed, plus the speed of rigid rotation at the greatest radius that the ray can reach.
TEST(Crossings, FallingSpheresInGoedel) {
  Random random(3);
  Tally tally;
  for (int object = 0; object < rays(500); ++object) {
    const Goedel metric{random.uniform(1, 5)};
    const double beta = random.uniform(0, 0.8), gamma = 1 / std::sqrt(1 - beta * beta);
    const double largest = std::min(1.0, 0.3 * metric.a / (std::numbers::sqrt2 * gamma * gamma * beta + 0.3));
    const double R = random.logarithmic(1e-6, largest), limit = 8 * metric.a;
    Vec3<double> direction = random.direction();
    if (object % 2) direction = normalised(Vec3<double>{{direction[0], direction[1], 0}});
    LocalFrame<Goedel> frame{metric, random.event(metric.a), four_velocity(beta * direction), true, {},
                             kAxes};
    frame.prepare();
    const GoedelOrbit orbit = make_orbit(frame, R);
    ASSERT_TRUE(orbit.fits()) << "beta " << beta << " R " << R << " a " << metric.a << " farthest "
                              << orbit.farthest;
    const MovingPlacing<Goedel> placing{frame, orbit, true};
    for (int n = 0; n < 300; ++n) {
      const Vec4<double> target =
          frame.event(random.uniform(-3, 3), random.uniform(0, 2) * R * random.direction());
      const auto start = ray_through(metric, target, random.uniform(0, limit), random);
      const auto ray = placing.ray(placing.launch(start.event), start.k);
      const auto rest_distance = [&](double l) {
        const Vec4<double> x = ray.path.at(l).event;
        return norm(spatial(frame.rest(x, proper_time(frame, x, orbit.proper_time(x)))));
      };
      const auto depth = [&](double l) { return rest_distance(l) - R; };
      const double rho_c = asinh_of(metric.to_q(metric.to_origin(orbit.centre, frame.start)));
      const auto apart =
          [&](double l) {  // in co-moving coordinates at the object's radius: a lower bound in H^2 x R
            const Vec4<double> x = ray.around.path.at(l).event;
            const double elapsed = x[0] - orbit.t_c, angle = orbit.omega * elapsed + orbit.phi_c;
            const Complex<double> q = metric.to_q(x) * Complex<double>{std::cos(angle), -std::sin(angle)};
            const Vec4<double> turned = {
                {0, 2 * metric.a * q.re, 2 * metric.a * q.im, x[3] - orbit.v * elapsed - orbit.z_c}};
            const Vec4<double> centre = {{0, 2 * metric.a * std::sinh(rho_c), 0, 0}};
            return product_distance(metric, metric.to_origin(centre, turned));
          };
      const double body = 2.5 * gamma * gamma * R;  // no point of the sphere is farther away at its own time
      if (apart(0) < body) continue;
      const auto reach = [&](double l, double half) {
        const double rho = asinh_of(metric.to_q(ray.around.path.at(l).event)) + 0.5 * half / metric.a;
        const double rotation = orbit.omega * (1 + std::numbers::sqrt2) * metric.a * std::sinh(2 * rho);
        const double speed = 1 + rotation + 2.5 * std::fabs(orbit.v);
        if (apart(l) - half * speed > body) return false;
        if (half * speed > 0.3 * body) return true;
        return rest_distance(l) - 4 * ray.around.frequency * half < R;
      };
      tally.compare(oracle(0, limit, depth, reach),
                    first_crossing(ray, Sphere{R}, limit, 4e-15 * norm(spatial(start.event))),
                    root_tolerance(R, 100 * metric.a), depth, R);
    }
  }
  tally.expect_clean();
  RecordProperty("rays", tally.rays);
}

TEST(Crossings, MovingSpheresInMinkowski) {
  Random random(4);
  Tally tally;
  const Minkowski metric;
  for (int n = 0; n < rays(400'000); ++n) {
    const double R = random.logarithmic(1e-6, 1), limit = 20;
    const Vec4<double> u = four_velocity(random.uniform(0, 0.99) * random.direction());
    const LocalFrame<Minkowski> frame{metric, random.event(3), u, false, {}, kAxes};
    const auto start =
        ray_through(metric, frame.event(random.uniform(-3, 3), random.uniform(0, 2) * R * random.direction()),
                    random.uniform(0, limit), random);
    // In the rest frame: a straight line and a quadratic, in long double.
    using L = long double;
    const Vec4<L> from = boost(convert<L>(u), convert<L>(start.event - frame.start)),
                  k = boost(convert<L>(u), convert<L>(start.k));
    const L b = dot(spatial(from), spatial(k)), kk = dot(spatial(k), spatial(k));
    const L c = dot(spatial(from), spatial(from)) - L(R) * L(R), discriminant = b * b - kk * c;
    if (c <= 0) continue;
    const L root = discriminant > 0 ? (-b - std::sqrt(discriminant)) / kk : L(-1);
    const double expected = root > 0 && root < limit ? static_cast<double>(root) : -1;
    const auto depth = [&](double l) {
      return static_cast<double>(norm(spatial(from) + L(l) * spatial(k))) - R;
    };
    const MovingPlacing<Minkowski> placing{frame, make_orbit(frame, R), true};
    tally.compare(expected,
                  first_crossing(placing.ray(placing.launch(start.event), start.k), Sphere{R}, limit,
                                 4e-15 * norm(spatial(start.event))),
                  root_tolerance(R, 100 * u[0] * u[0]), depth, R);
  }
  tally.expect_clean();
  RecordProperty("rays", tally.rays);
}

}  // namespace
}  // namespace nullcone::test
