// Objects on worldlines of flat spacetime against closed forms, ray by ray.
#include <gtest/gtest.h>

#include <map>

#include "core/trace/shapes.h"
#include "tests/known_lines.h"
#include "tests/random_rays.h"
#include "tests/reference_cases.h"
#include "tests/sanitized.h"
#include "tests/traced.h"

namespace nullcone::test {
namespace {

using namespace host;

constexpr int kScenes = kSanitized ? 2 : 6, kWidth = kSanitized ? 10 : 24;

/// An event in somebody's frame: the proper time at which it is simultaneous, and where it is.
struct Seen {
  L tau;
  Vec3<L> X;
};
Seen seen(const KnownLine& line, const Vec4<L>& x, L tau) {
  for (int i = 0; i < 60; ++i) {
    const Known at = line(tau);
    const L h = 1e-6L, late = product(at.u, x - at.P);
    const Known next = line(tau + h);
    const L step = late * h / (product(next.u, x - next.P) - late);
    tau -= step;
    if (std::fabs(step) < 1e-18L * (1 + std::fabs(tau))) break;
  }
  const Known at = line(tau);
  Seen out{tau, {}};
  for (std::size_t i = 0; i < 3; ++i) out.X[i] = -product(at.axes[i], x - at.P);
  return out;
}

/// When light that reaches `o` left the centre.
L retarded(const Moving& moving, const Vec4<L>& o) {
  L least = moving.least, most = moving.most;
  for (int i = 0; i < 200; ++i) {
    const L middle = (least + most) / 2;
    const Vec4<L> way = o - moving.line(middle).P;
    (way[0] > norm(spatial(way)) ? least : most) = middle;
  }
  return least;
}

/// A sphere of radius R on a worldline, and a ray that goes by it: o + lambda k.
struct Passing {
  const Moving& moving;
  Vec4<L> o, k;
  L R, tau_r, lambda_r;  ///< the latter two where the ray is about as far as the centre

  Seen at(L lambda, L guess) const { return seen(moving.line, o + lambda * k, guess); }
  /// A twentieth of the radius on the ray.
  L step() const { return L(0.05) * R / -product(moving.line(tau_r).u, k); }

  struct Place {
    L lambda, tau, distance;
  };
  /// Where the ray is next to the centre: from the retarded place to both sides, then finer.
  Place nearest() const {
    Place best{0, tau_r, kFar};
    for (const L way : {step(), -step()}) {
      L guess = tau_r;
      for (int i = 0; i < 300; ++i) {
        const Seen here = at(lambda_r + i * way, guess);
        const L d = norm(here.X);
        if (d < best.distance) best = {lambda_r + i * way, here.tau, d};
        if (!(d < 5 * R)) break;
        guess = here.tau;
      }
    }
    const L middle_tau = best.tau;
    for (L part = step(); part > 1e-12L * step(); part *= L(0.5))
      for (const L lambda : {best.lambda - part, best.lambda + part})
        if (const Seen here = at(lambda, middle_tau); norm(here.X) < best.distance)
          best = {lambda, here.tau, norm(here.X)};
    return best;
  }
  /// Where the ray comes into the sphere, from a place inside.
  Place entry(const Place& inside) const {
    L in = inside.lambda, out = inside.lambda, tau = inside.tau;
    for (int i = 0; i < 400 && in == out; ++i) {
      const L before = out - step();
      const Seen back = at(before, tau);
      norm(back.X) > R ? in = before : in = out = before;
      tau = back.tau;
    }
    for (int i = 0; i < 100; ++i) {
      const L middle = (in + out) / 2;
      (norm(at(middle, tau).X) > R ? in : out) = middle;
    }
    return {in, at(in, tau).tau, R};
  }
};

/// The worst errors; where a ray grazes, all but the shift are as uncertain as 1 / mu.
struct Figures {
  double Z = 0, tau = 0, shift = 0, mu = 0, uv = 0;
  std::size_t hits = 0, missed = 0, ghosts = 0, skipped = 0;

  void compare(const Passing& ray, const Passing::Place& entry, const HitRecord& hit, double tau_origin,
               double scale) {
    ++hits;
    const Seen here = ray.at(entry.lambda, entry.tau);
    const Known then = ray.moving.line(here.tau);
    const L frequency = -product(then.u, ray.k);
    Vec3<L> K;
    for (std::size_t i = 0; i < 3; ++i) K[i] = -product(then.axes[i], ray.k) / frequency;
    const double cos = static_cast<double>(-dot(K, here.X) / norm(here.X));
    const auto note = [](double& worst, double error) { worst = std::max(worst, std::fabs(error)); };
    note(Z, (hit.Z - static_cast<double>(entry.lambda)) * cos / scale);
    note(tau, (hit.tau + tau_origin - static_cast<double>(here.tau)) * cos / scale);
    note(shift, hit.shift * static_cast<double>(frequency) - 1);
    note(mu, (std::fabs(hit.mu) - std::fabs(cos)) * cos);
    const auto place =
        Sphere::uv(Vec3<double>::map([&](std::size_t i) { return static_cast<double>(here.X[i]); }));
    const double du = std::fabs(hit.u - place[0]), pole = std::sin(kPi * place[1]);
    note(uv, std::min(du, 1 - du) * cos * pole);
    note(uv, (hit.v - place[1]) * cos * pole);
  }
};

/// A scene with the sphere, seen by an observer at rest who looks at it.
Traced look_at(const Moving& moving, double radius, const Vec4<double>& at, const Vec4<L>& from, L distance) {
  const double fov = std::min(120.0, 120 / kPi * 3 * radius / static_cast<double>(distance));
  return trace_text(
      text(R"({"metric": {"name": "minkowski"}, "observer": {"event": [%.17g, %.17g, %.17g, %.17g]},
               "camera": {"type": "perspective", "fov_deg": %.17g, "resolution": [%d, %d],
               "forward": [%.17g, %.17g, %.17g], "up": [0.1, 0.2, 1]},)",
           at[0], at[1], at[2], at[3], fov, kWidth, kWidth, -static_cast<double>(from[1]),
           -static_cast<double>(from[2]), -static_cast<double>(from[3])) +
      text(R"("objects": [{"name": "ball", "shape": {"type": "sphere", "radius": %.17g},
               "placing": {"type": "local", "worldline": )",
           radius) +
      moving.json + "}}]}");
}

/// Traces a sphere that moves and compares every ray.
void compare(const Moving& moving, double radius, const Vec4<double>& at, Figures& worst) {
  const Vec4<L> o = convert<L>(at);
  const L tau_r = retarded(moving, o), R = radius;
  const Vec4<L> from = o - moving.line(tau_r).P;
  const L distance = norm(spatial(from));
  if (distance < 3 * R) return;
  const Traced traced = look_at(moving, radius, at, from, distance);
  EXPECT_EQ(traced.rays_with(Status::step_limit) + traced.rays_with(Status::not_finite), 0U);
  std::map<std::pair<std::size_t, std::size_t>, HitRecord> hits;
  traced.for_each_hit([&](const HitRecord& hit, std::size_t x, std::size_t y) { hits[{x, y}] = hit; });
  for (std::size_t y = 0; y < kWidth; ++y)
    for (std::size_t x = 0; x < kWidth; ++x) {
      const auto n = traced.look(x, y);
      const Passing ray{moving, o, {{-1, n[0], n[1], n[2]}}, R, tau_r, distance};
      const Passing::Place nearest = ray.nearest();
      const auto found = hits.find({x, y});
      // Where a line has a kink, an event may be simultaneous with two of its centres, or with none.
      if (std::ranges::any_of(moving.kinks, [&](L tau) { return std::fabs(nearest.tau - tau) < 12 * R; }) ||
          std::fabs(nearest.distance - R) < 1e-4L * R)
        ++worst.skipped;
      else if (nearest.distance > R)
        worst.ghosts += found != hits.end();
      else if (found == hits.end())
        ++worst.missed;
      else
        worst.compare(ray, ray.entry(nearest), found->second, traced.tau_origins[0],
                      static_cast<double>(distance) + std::fabs(at[0]) + 10);
    }
}

void report(const char* what, const Figures& worst, double limit, double radius) {
  std::printf("%s: %zu hits, worst Z %.1e, tau %.1e, shift %.1e, mu %.1e, uv %.1e; %zu skipped\n", what,
              worst.hits, worst.Z, worst.tau, worst.shift, worst.mu, worst.uv, worst.skipped);
  EXPECT_EQ(worst.missed, 0U);
  EXPECT_EQ(worst.ghosts, 0U);
  EXPECT_GT(worst.hits, kSanitized ? 50U : 1000U);
  EXPECT_LT(worst.Z, limit);
  EXPECT_LT(worst.tau, limit);
  EXPECT_LT(worst.shift, limit / radius);
  EXPECT_LT(worst.mu, limit / radius);
  EXPECT_LT(worst.uv, limit / radius);
}

TEST(Worldlines, CirclesInFlatSpace) {
  Random random(1);
  Figures worst;
  for (int i = 0; i < kScenes; ++i) {
    const double r = random.uniform(1, 5), v = random.uniform(0.1, 0.9);
    compare(on_circle(r, v, random.uniform(-1, 1), i % 2 == 1), 0.1, {{random.uniform(-20, 20), 9, 3, 2}},
            worst);
  }
  report("circles", worst, 1e-12, 0.1);
}

TEST(Worldlines, HyperbolasInFlatSpace) {
  Random random(2);
  Figures worst;
  for (int i = 0; i < kScenes; ++i) {
    const double a = random.uniform(0.05, 1);
    compare(on_hyperbola({{1, 2, 3}}, a, random.direction()), 0.1, {{random.uniform(2, 8), 2, -1, 1}}, worst);
  }
  report("hyperbolas", worst, 1e-12, 0.1);
}

TEST(Worldlines, PiecesInFlatSpace) {
  Random random(3);
  Figures worst;
  for (int i = 0; i < kScenes; ++i) {
    Pieces pieces;
    for (int k = 0; k < 4; ++k)
      pieces.emplace_back(random.uniform(0, 0.9) * random.direction(), random.uniform(1, 4));
    compare(in_pieces({{1, 2, 3}}, pieces), 0.05, {{random.uniform(0, 30), 12, -1, 1}}, worst);
  }
  report("pieces", worst, 1e-12, 0.05);
}

/// PHYSICS: a ray straight through the centre comes in one radius (times the ratio of frequencies) before it.
TEST(Worldlines, TheRetardedPosition) {
  for (const json& c : cases_of("sr_retarded_position")) {
    const Vec3<double> P = to_vec3(c["inputs"]["position_at_reception_time"]),
                       V = to_vec3(c["inputs"]["velocity"]), E = to_vec3(c["expected"]["emission_pos"]);
    const double t_e = c["expected"]["ct_emission"];
    const std::string event = text("[0, %.17g, %.17g, %.17g]", P[0], P[1], P[2]),
                      velocity = text("[%.17g, %.17g, %.17g]", V[0], V[1], V[2]),
                      before = text("[-1000, %.17g, %.17g, %.17g]", P[0] - 1000 * V[0], P[1] - 1000 * V[1],
                                    P[2] - 1000 * V[2]),
                      head = text(
                          R"({"metric": {"name": "minkowski"}, "observer": {"event": [0, 0, 0, 0]},
                              "camera": {"type": "perspective", "fov_deg": 1, "resolution": [1, 1],
                              "forward": [%.17g, %.17g, %.17g]}, "objects": [)",
                          E[0], E[1], E[2]),
                      at = R"("event": )" + event, v = R"("velocity": )" + velocity;
    const std::vector<std::string> lines = {
        R"({"type": "geodesic", )" + at + ", " + v + "}",
        R"({"type": "accelerated", "acceleration": [0, 0, 0], )" + at + ", " + v + "}",
        R"({"type": "piecewise", )" + at + R"(, "pieces": [{"duration": 9, )" + v + "}]}",
        R"({"type": "piecewise", )" + at + R"(, "pieces": [{"duration": 5, )" + v + R"(}, {"duration": 1}]})",
        R"({"type": "tabulated", "events": [)" + before + ", " + event + "]}"};
    for (const std::string& line : lines) {
      const Traced traced = trace_text(
          head + R"({"name": "ball", "shape": {"type": "sphere", "radius": 0.01}, "placing": {"type": "local",
                     "worldline": )" +
          line + "}}]}");
      ASSERT_EQ(traced.hits(), 1U) << line;
      traced.for_each_hit([&](const HitRecord& hit, std::size_t, std::size_t) {
        EXPECT_NEAR(hit.t - 0.01 * hit.shift, t_e, tolerance(c, t_e)) << line;
      });
    }
  }
}

}  // namespace
}  // namespace nullcone::test
