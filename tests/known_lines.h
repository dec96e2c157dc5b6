// Worldlines of flat spacetime in closed form, in long double, each with the JSON that says the same.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "core/base/boost.h"

namespace nullcone::test {
namespace {

using namespace host;
using L = long double;
constexpr double kPi = std::numbers::pi;

/// Somebody on a worldline of flat spacetime: event, 4-velocity and gyroscope axes.
struct Known {
  Vec4<L> P, u;
  std::array<Vec4<L>, 3> axes;
};
using KnownLine = std::function<Known(L tau)>;

/// A worldline as a scene's text and in closed form.
struct Moving {
  std::string json;
  KnownLine line;
  std::vector<L> kinks;      ///< proper times
  L least = -60, most = 60;  ///< proper times between which light leaves it that anybody sees
};

L product(const Vec4<L>& a, const Vec4<L>& b) { return a[0] * b[0] - dot(spatial(a), spatial(b)); }

/// printf into a string.
template <class... Values>
std::string text(const char* format, Values... values) {
  char out[1024];
  std::snprintf(out, sizeof out, format, values...);
  return out;
}

std::array<Vec4<L>, 3> boosted_axes(const Vec4<L>& u) {
  std::array<Vec4<L>, 3> out;
  for (std::size_t i = 0; i < 3; ++i) {
    Vec4<L> e{};
    e[i + 1] = 1;
    out[i] = boost(opposite(u), e);
  }
  return out;
}

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
  return {text(R"({"type": "circular", "event": [0, %.17g, 0, %.17g], "speed": %.17g, "clockwise": %s})", r,
               z, v, clockwise ? "true" : "false"),
          line,
          {},
          -400,
          400};
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
  return {text(R"({"type": "accelerated", "event": [0, %.17g, %.17g, %.17g],
                   "acceleration": [%.17g, %.17g, %.17g]})",
               start[0], start[1], start[2], push[0], push[1], push[2]),
          line,
          {},
          -25 / L(a),
          25 / L(a)};
}

/// Velocities against the frame of rest, and for how much proper time each.
using Pieces = std::vector<std::pair<Vec3<double>, double>>;

Moving in_pieces(const Vec3<double>& start, const Pieces& pieces) {
  std::vector<Known> begins;
  std::vector<L> from;
  Known at{{{0, start[0], start[1], start[2]}}, {}, {}};
  L tau = 0;
  std::string json;
  for (const auto& [velocity, duration] : pieces) {
    const Vec4<L> was = at.u;
    at.u = four_velocity(convert<L>(velocity));
    if (begins.empty())
      at.axes = boosted_axes(at.u);
    else  // parallel-transported through the boost from one 4-velocity to the next
      for (auto& e : at.axes) e = e - (product(e, at.u) / (1 + product(at.u, was))) * (at.u + was);
    begins.push_back(at), from.push_back(tau);
    at.P = at.P + L(duration) * at.u;
    tau += duration;
    json += text(R"(%s{"velocity": [%.17g, %.17g, %.17g], "duration": %.17g})", json.empty() ? "" : ", ",
                 velocity[0], velocity[1], velocity[2], duration);
  }
  const auto line = [=](L at_tau) {
    std::size_t i = 0;
    while (i + 1 < from.size() && at_tau > from[i + 1]) ++i;
    Known out = begins[i];
    out.P = out.P + (at_tau - from[i]) * out.u;
    return out;
  };
  return {text(R"({"type": "piecewise", "event": [0, %.17g, %.17g, %.17g], "pieces": [)", start[0], start[1],
               start[2]) +
              json + "]}",
          line,
          {from.begin() + 1, from.end()}};
}

}  // namespace
}  // namespace nullcone::test
