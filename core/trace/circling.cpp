#include "core/trace/circling.h"

#include <cmath>

#include "core/base/error.h"
#include "core/trace/ground.h"

namespace nullcone {

using host::V4;

namespace {

/// d/dphi about the chart's z axis.
V4 turning_at(const V4& x) { return {{0, -x[2], x[1], 0}}; }

/// The rate dphi/dt of a geodesic circle through x: the square of d/dt + omega d/dphi has no slope across it.
double free_rate(const Ground& ground, const V4& x, bool clockwise, const std::string& place) {
  const V4 time = {{1, 0, 0, 0}}, turn = turning_at(x), out = {{0, x[1], x[2], 0}};
  const auto along = [&](const V4& a) { return inner(ground, x, a, out); };
  const double c0 = along(connection(ground, x, time, time)), c1 = along(connection(ground, x, time, turn)),
               c2 = along(connection(ground, x, turn, turn) - out);
  const double root = std::sqrt(c1 * c1 - c0 * c2);
  const double omega = (-c1 + (clockwise == (c2 > 0) ? -root : root)) / c2;
  const V4 a{Circling{x.c, 1, omega}.acceleration(ground, x.c)};
  const double size = std::fabs(c0) + std::fabs(c1 * c1 / c2) + std::fabs(c2 * omega * omega);
  const double left = std::sqrt(std::fabs(inner(ground, x, a, a)) * -inner(ground, x, out, out));
  if (!(left < 1e-7 * size)) throw InputError(place, "there is no free circular motion through this event");
  return omega;
}

}  // namespace

Event Circling::event(double tau) const {
  const double c = std::cos(turning * tau), s = std::sin(turning * tau);
  return {start[0] + time_rate * tau, c * start[1] - s * start[2], s * start[1] + c * start[2], start[3]};
}

Event Circling::acceleration(const Ground& ground, const Event& x) const {
  const V4 u{velocity(x)}, bend = {{0, -turning * u[2], turning * u[1], 0}};
  return (bend + connection(ground, V4{x}, u, u)).c;
}

Circling circling(const Ground& ground, const Motion& motion, const std::string& place) {
  const V4 x{motion.event}, time = {{1, 0, 0, 0}}, turn = turning_at(x);
  const double way = motion.clockwise ? -1 : 1, tt = inner(ground, x, time, time),
               tp = inner(ground, x, time, turn), pp = inner(ground, x, turn, turn);
  double t = 0, phi = way;  // u up to its length
  if (motion.pace == Motion::Pace::free) {
    t = 1, phi = free_rate(ground, x, motion.clockwise, place);
  } else if (motion.pace == Motion::Pace::speed) {
    // e_0 + v n: n is d/dphi without its part along e_0.
    const double unit_t = 1 / std::sqrt(tt), across = std::sqrt(tp * tp / tt - pp);
    phi = way * motion.speed / across;
    t = unit_t - phi * tp / tt;
  }
  const double square = tt * t * t + 2 * tp * t * phi + pp * phi * phi;
  if (!(square > 0))
    throw InputError(place, motion.pace == Motion::Pace::closed
                                ? "there is no closed timelike circle through this event"
                                : "is not slower than light there");
  const double length = std::sqrt(square);
  return {x.c, t / length, phi / length};
}

}  // namespace nullcone
