// Integrated rays with the derivatives of their states in two directions: the Jacobi fields of a bundle of
// rays from one event, by dual numbers through the stepper itself.
#pragma once

#include "core/trace/integrate.h"

NULLCONE_KERNEL_BEGIN

/// A state (x, p), and behind it its derivatives along two parameters.
template <class S>
using VariedState = Vec<S, 24>;

template <class S>
VariedState<S> to_varied(const Vec<Dual<S, 2>, 8>& y) {
  return VariedState<S>::map([&](std::size_t i) { return i < 8 ? y[i].v : y[i % 8].d[i / 8 - 1]; });
}
template <class S>
Vec<Dual<S, 2>, 8> to_dual(const VariedState<S>& y) {
  return Vec<Dual<S, 2>, 8>::map([&](std::size_t i) {
    return Dual<S, 2>(y[i], Vec<S, 2>{{y[i + 8], y[i + 16]}});
  });
}
/// Part 0: the state; parts 1 and 2: its derivatives.
template <class S>
State<S> part_of(const VariedState<S>& y, std::size_t part) {
  return State<S>::map([&](std::size_t i) { return y[i + 8 * part]; });
}

/// Hamilton's equations and their first variation, as Odeint calls them.
template <Metric M>
struct VariedSystem {
  HamiltonSystem<M> system;

  template <class S>
  void operator()(const VariedState<S>& y, VariedState<S>& dy, const S&) const {
    dy = to_varied(system.rate(to_dual(y)));
  }
};

/// Most attempts of a step that a ray may take on its way to a lamp.
inline constexpr double kShotLimit = 2000;

/// The angle in which the origin sees two points apart: 0 where one of them is the origin itself.
template <class S>
S angle_between(const Vec3<S>& a, const Vec3<S>& b) {
  const S sine = norm(cross(a, b)), cosine = dot(a, b);
  return atan2(sine, select((sine == S(0.0)) & (cosine == S(0.0)), S(1.0), cosine));
}

/// Where a ray comes to.
template <class S>
struct VariedEnd {
  VariedState<S> y, dy;
  S turning;        ///< angle that it has swept about the chart's origin, in radians
  Mask<S> arrived;  ///< else it did not come so far
};

/// Follows rays from y up to lambda = target. The steps are those of the ray alone.
template <class Stepper, Metric M, class S>
VariedEnd<S> follow_varied(Stepper& stepper, const HamiltonSystem<M>& system, const Accuracy& accuracy,
                           const VariedState<S>& y, const S& target, const Mask<S>& wanted) {
  const M& metric = system.metric;
  const VariedSystem<M> varied{system};
  VariedEnd<S> out{y, {}, S(0.0), wanted};
  varied(y, out.dy, S(0.0));
  Flight<S> flight;
  flight.y = part_of(y, 0), flight.dy = part_of(out.dy, 0);
  flight.h = first_step<Stepper::kRoots>(metric, flight.y, flight.dy, accuracy.rtol);
  auto active = wanted & (flight.lambda < target);
  while (any(active)) {
    Attempt<S> a;
    VariedState<S> y1, dy1, error;
    const S rest = target - flight.lambda;
    a.h = next_step(metric, flight, rest);
    stepper.step(varied, out.y, out.dy, a.h, y1, dy1, error);
    a.y1 = part_of(y1, 0);
    judge<Stepper>(metric, accuracy, flight, part_of(error, 0), a);
    learn(flight, a, active);
    const S progress = a.h * norm(spatial(to_phase(flight.dy).x));
    const auto stuck =
        active & !a.accepted & !(progress > S(1e-14) * length_scale(metric, to_phase(flight.y).x));
    const auto moves = active & a.accepted;
    const S angle = angle_between(spatial(to_phase(flight.y).x), spatial(to_phase(a.y1).x));
    out.turning = select(moves, out.turning + angle, out.turning);
    out.y = select(moves, y1, out.y);
    out.dy = select(moves, dy1, out.dy);
    flight.y = part_of(out.y, 0), flight.dy = part_of(out.dy, 0);
    flight.lambda = select(moves, select(a.h == rest, target, flight.lambda + a.h), flight.lambda);
    out.arrived = out.arrived & !stuck & !(active & (flight.steps >= S(kShotLimit)));
    active = active & out.arrived & (flight.lambda < target);
  }
  return out;
}

NULLCONE_KERNEL_END
