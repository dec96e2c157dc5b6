// Objects on worldlines: in flat spacetime against closed forms, ray by ray; elsewhere against other ways to
// the same motion.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "core/base/boost.h"
#include "core/trace/shapes.h"
#include "tests/random_rays.h"
#include "tests/reference_cases.h"
#include "tests/sanitized.h"
#include "tests/traced.h"

namespace nullcone::test {
namespace {

using namespace host;
using L = long double;

constexpr double kPi = std::numbers::pi;

/// Somebody on a worldline of flat spacetime, in closed form: event, 4-velocity and gyroscope axes.
struct Known {
  Vec4<L> P, u;
  std::array<Vec4<L>, 3> axes;
};
using KnownLine = std::function<Known(L tau)>;

std::array<Vec4<L>, 3> boosted_axes(const Vec4<L>& u) {
  std::array<Vec4<L>, 3> out;
  for (std::size_t i = 0; i < 3; ++i) {
    Vec4<L> e{};
    e[i + 1] = 1;
    out[i] = boost(opposite(u), e);
  }
  return out;
}
L product(const Vec4<L>& a, const Vec4<L>& b) { return a[0] * b[0] - dot(spatial(a), spatial(b)); }

/// A sphere as a ray sees it: the proper time at which an event is simultaneous with its centre, and where.
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
L retarded(const KnownLine& line, const Vec4<L>& o, L least, L most) {
  for (int i = 0; i < 200; ++i) {
    const L middle = (least + most) / 2;
    const Vec4<L> way = o - line(middle).P;
    (way[0] > norm(spatial(way)) ? least : most) = middle;
  }
  return least;
}

struct Moving {
  std::string json;
  KnownLine line;
  std::vector<L> kinks;
  L least = -60, most = 60;  ///< proper time
};

Moving on_circle(double r, double v, double z, bool clockwise) {
  const L gamma = 1 / std::sqrt((1 - L(v)) * (1 + L(v))), way = clockwise ? -1 : 1, w = way * gamma * v / r;
  const auto line = [=](L tau) {
    const L c = std::cos(w * tau), s = std::sin(w * tau);
    Known out{{{gamma * tau, r * c, r * s, z}}, {{gamma, -w * r * s, w * r * c, 0}}, {}};
    const auto b = boosted_axes(out.u);  // gyroscopes turn against these by -(gamma - 1) phi
    const L turn = -(gamma - 1) * w * tau;
    out.axes = {std::cos(turn) * b[0] + std::sin(turn) * b[1], std::cos(turn) * b[1] - std::sin(turn) * b[0],
                b[2]};
    return out;
  };
  char text[1024];
  std::snprintf(text, sizeof text,
                R"({"type": "circular", "event": [0, %.17g, 0, %.17g], "speed": %.17g, "clockwise": %s})", r,
                z, v, clockwise ? "true" : "false");
  return {text, line, {}, -400, 400};
}

Moving on_hyperbola(const Vec3<double>& start, double a, const Vec3<double>& n) {
  const auto line = [=](L tau) {
    const L s = std::sinh(a * tau), c = std::cosh(a * tau), half = std::sinh(a * tau / 2),
            c1 = 2 * half * half;
    Known out;
    out.P[0] = s / a, out.u[0] = c;
    for (std::size_t i = 0; i < 3; ++i) out.P[i + 1] = start[i] + n[i] * c1 / a, out.u[i + 1] = n[i] * s;
    for (std::size_t i = 0; i < 3; ++i) {
      out.axes[i][0] = n[i] * s;
      for (std::size_t k = 0; k < 3; ++k) out.axes[i][k + 1] = (i == k ? 1 : 0) + n[i] * n[k] * c1;
    }
    return out;
  };
  const Vec3<double> push = a * n;
  char text[1024];
  std::snprintf(
      text, sizeof text,
      R"({"type": "accelerated", "event": [0, %.17g, %.17g, %.17g], "acceleration": [%.17g, %.17g, %.17g]})",
      start[0], start[1], start[2], push[0], push[1], push[2]);
  return {text, line, {}, -25 / L(a), 25 / L(a)};
}

Moving in_pieces(const Vec3<double>& start, const std::vector<std::pair<Vec3<double>, double>>& pieces) {
  std::vector<Known> begins;
  Vec4<L> P = {{0, start[0], start[1], start[2]}};
  std::string json;
  std::array<Vec4<L>, 3> axes{};
  for (const auto& [velocity, duration] : pieces) {
    const Vec4<L> u = four_velocity(convert<L>(velocity));
    if (begins.empty())
      axes = boosted_axes(u);
    else
      for (auto& e : axes) {
        const Vec4<L> was = begins.back().u;
        e = e - (product(e, u) / (1 + product(u, was))) * (u + was);
      }
    begins.push_back({P, u, axes});
    P = P + L(duration) * u;
    char text[1024];
    std::snprintf(text, sizeof text, R"(%s{"velocity": [%.17g, %.17g, %.17g], "duration": %.17g})",
                  json.empty() ? "" : ", ", velocity[0], velocity[1], velocity[2], duration);
    json += text;
  }
  std::vector<L> from;
  L sum = 0;
  for (const auto& piece : pieces) from.push_back(sum), sum += piece.second;
  const auto line = [=](L tau) {
    std::size_t i = 0;
    while (i + 1 < from.size() && tau > from[i + 1]) ++i;
    Known out = begins[i];
    out.P = out.P + (tau - from[i]) * out.u;
    return out;
  };
  char text[1024];
  std::snprintf(text, sizeof text, R"({"type": "piecewise", "event": [0, %.17g, %.17g, %.17g], "pieces": [)",
                start[0], start[1], start[2]);
  return {text + json + "]}", line, {from.begin() + 1, from.end()}, -60, 60};
}

struct Figures {
  double Z = 0, tau = 0, shift = 0, mu = 0, uv = 0;
  std::size_t hits = 0, missed = 0, ghosts = 0, skipped = 0;
};

/// Traces a sphere that moves, from an observer at rest who looks at it, and compares every ray.
void compare(const Moving& moving, double radius, const Vec4<double>& at, Figures& worst) {
  const Vec4<L> o = convert<L>(at);
  const L tau_r = retarded(moving.line, o, moving.least, moving.most);
  const Vec4<L> from = o - moving.line(tau_r).P;
  const double distance = static_cast<double>(norm(spatial(from)));
  if (distance < 3 * radius) return;
  char head[1024];
  std::snprintf(head, sizeof head,
                R"({"metric": {"name": "minkowski"}, "observer": {"event": [%.17g, %.17g, %.17g, %.17g]},
                "camera": {"type": "perspective", "fov_deg": %.17g, "resolution": [24, 24], "forward": [%.17g, %.17g, %.17g], "up": [0.1, 0.2, 1]},)",
                at[0], at[1], at[2], at[3], std::min(120.0, 120 / kPi * 3 * radius / distance),
                -static_cast<double>(from[1]), -static_cast<double>(from[2]), -static_cast<double>(from[3]));
  if (getenv("SHOW")) std::printf("%s %s\n", head, moving.json.c_str());
  const Traced traced =
      trace_text(head +
                 (R"("objects": [{"name": "ball", "shape": {"type": "sphere", "radius": )" +
                  std::to_string(radius) + R"(}, "placing": {"type": "local", "worldline": )") +
                 moving.json + "}}]}");
  std::map<std::pair<std::size_t, std::size_t>, HitRecord> hits;
  traced.for_each_hit([&](const HitRecord& hit, std::size_t x, std::size_t y) { hits[{x, y}] = hit; });
  EXPECT_EQ(traced.rays_with(Status::step_limit) + traced.rays_with(Status::not_finite), 0U);
  const L R = radius;
  for (std::size_t y = 0; y < 24; ++y)
    for (std::size_t x = 0; x < 24; ++x) {
      const Vec4<L> k = {{-1, traced.look(x, y)[0], traced.look(x, y)[1], traced.look(x, y)[2]}};
      const auto X_at = [&](L lambda, L guess) { return seen(moving.line, o + lambda * k, guess); };
      // Where it is next to the centre: from where it passes the retarded place, to both sides.
      const L step = L(0.05) * R / -product(moving.line(tau_r).u, k);
      L best = kFar, best_lambda = 0, tau = tau_r;
      for (const L way : {step, -step}) {
        L guess = tau_r;
        for (int i = 0; i < 300; ++i) {
          const Seen here = X_at(L(distance) + i * way, guess);
          const L d = norm(here.X);
          if (d < best) best = d, best_lambda = L(distance) + i * way, tau = here.tau;
          if (!(d < 5 * R)) break;
          guess = here.tau;
        }
      }
      for (L part = step; part > 1e-12L * step; part *= L(0.5))
        for (const L lambda : {best_lambda - part, best_lambda + part})
          if (const L d = norm(X_at(lambda, tau).X); d < best) best = d, best_lambda = lambda;
      const bool kinked =
          std::ranges::any_of(moving.kinks, [&](L kink) { return std::fabs(tau - kink) < 12 * R; });
      const auto found = hits.find({x, y});
      if (kinked || std::fabs(best - R) < 1e-4L * R) {
        ++worst.skipped;
        continue;
      }
      worst.missed += best < R && found == hits.end();
      worst.ghosts += best > R && found != hits.end();
      if (best > R || found == hits.end()) continue;
      ++worst.hits;
      L in = best_lambda, out = best_lambda, tau_in = tau;
      for (int i = 0; i < 400 && in == out; ++i) {  // back to where it comes in
        const L before = out - step;
        const Seen back = X_at(before, tau_in);
        norm(back.X) > R ? in = before : in = out = before;
        tau_in = back.tau;
      }
      tau = tau_in;
      for (int i = 0; i < 100; ++i) {
        const L middle = (in + out) / 2;
        (norm(X_at(middle, tau).X) > R ? in : out) = middle;
      }
      const HitRecord& hit = found->second;
      const Seen here = X_at(in, tau);
      const Known then = moving.line(here.tau);
      const L frequency = -product(then.u, k);
      Vec3<L> K;
      for (std::size_t i = 0; i < 3; ++i) K[i] = -product(then.axes[i], k) / frequency;
      const double mu = static_cast<double>(-dot(K, here.X) / norm(here.X));
      const double scale = distance + std::fabs(at[0]) + 10;
      const auto note = [](double& worst_of, double error) {
        worst_of = std::max(worst_of, std::fabs(error));
      };
      note(worst.Z, (hit.Z - static_cast<double>(in)) * mu / scale);
      note(worst.tau, (hit.tau + traced.tau_origins[0] - static_cast<double>(here.tau)) * mu / scale);
      note(worst.shift, hit.shift * static_cast<double>(frequency) - 1);
      note(worst.mu, (std::fabs(hit.mu) - std::fabs(mu)) * mu);
      const auto uv =
          Sphere::uv(Vec3<double>::map([&](std::size_t i) { return static_cast<double>(here.X[i]); }));
      const double du = std::fabs(hit.u - uv[0]), pole = std::sin(kPi * uv[1]);
      note(worst.uv, std::min(du, 1 - du) * mu * pole);
      note(worst.uv, (hit.v - uv[1]) * mu * pole);
    }
}

void report(const char* what, const Figures& worst, double limit, double radius) {
  std::printf("%s: %zu hits, worst Z %.1e, tau %.1e, shift %.1e, mu %.1e, uv %.1e; %zu skipped\n", what,
              worst.hits, worst.Z, worst.tau, worst.shift, worst.mu, worst.uv, worst.skipped);
  EXPECT_EQ(worst.missed, 0U);
  EXPECT_EQ(worst.ghosts, 0U);
  EXPECT_GT(worst.hits, kSanitized ? 200U : 1000U);
  EXPECT_LT(worst.Z, limit);
  EXPECT_LT(worst.tau, limit);
  EXPECT_LT(worst.shift, limit / radius);
  EXPECT_LT(worst.mu, limit / radius);
  EXPECT_LT(worst.uv, limit / radius);
}

constexpr int kScenes = kSanitized ? 2 : 6;

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
    std::vector<std::pair<Vec3<double>, double>> pieces;
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
    char event[256], velocity[256], before[256], head[1024];
    std::snprintf(event, sizeof event, "[0, %.17g, %.17g, %.17g]", P[0], P[1], P[2]);
    std::snprintf(velocity, sizeof velocity, "[%.17g, %.17g, %.17g]", V[0], V[1], V[2]);
    std::snprintf(before, sizeof before, "[-1000, %.17g, %.17g, %.17g]", P[0] - 1000 * V[0],
                  P[1] - 1000 * V[1], P[2] - 1000 * V[2]);
    std::snprintf(head, sizeof head,
                  R"({"metric": {"name": "minkowski"}, "observer": {"event": [0, 0, 0, 0]}, "camera": {"type":
                  "perspective", "fov_deg": 1, "resolution": [1, 1], "forward": [%.17g, %.17g, %.17g]}, "objects": [)",
                  E[0], E[1], E[2]);
    const std::string at = std::string(R"("event": )") + event, v = std::string(R"("velocity": )") + velocity;
    const std::vector<std::string> lines = {
        R"({"type": "geodesic", )" + at + ", " + v + "}",
        R"({"type": "accelerated", "acceleration": [0, 0, 0], )" + at + ", " + v + "}",
        R"({"type": "piecewise", )" + at + R"(, "pieces": [{"duration": 9, )" + v + "}]}",
        R"({"type": "piecewise", )" + at + R"(, "pieces": [{"duration": 5, )" + v + R"(}, {"duration": 1}]})",
        std::string(R"({"type": "tabulated", "events": [)") + before + ", " + event + "]}"};
    for (const std::string& line : lines) {
      const Traced traced = trace_text(
          head +
          (R"({"name": "ball", "shape": {"type": "sphere", "radius": 0.01}, "placing": {"type": "local",
                  "worldline": )" +
           line + "}}]}"));
      ASSERT_EQ(traced.hits(), 1U) << line;
      traced.for_each_hit([&](const HitRecord& hit, std::size_t, std::size_t) {
        EXPECT_NEAR(hit.t - 0.01 * hit.shift, t_e, tolerance(c, t_e)) << line;
      });
    }
  }
}

}  // namespace
}  // namespace nullcone::test
