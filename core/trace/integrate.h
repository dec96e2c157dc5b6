// Rays that are integrated: one attempt of a step, with a step size, an error and a verdict for each lane.
#pragma once

#include "core/scene/scene.h"
#include "core/trace/hamilton.h"
#include "core/trace/steppers.h"

NULLCONE_KERNEL_BEGIN

template <class S>
Phase<S> to_phase(const State<S>& y) {
  return {{{y[0], y[1], y[2], y[3]}}, {{y[4], y[5], y[6], y[7]}}};
}
template <class S>
State<S> to_state(const Phase<S>& at) {
  return {{at.x[0], at.x[1], at.x[2], at.x[3], at.p[0], at.p[1], at.p[2], at.p[3]}};
}

/// Hamilton's equations as Odeint calls them.
template <Metric M>
struct HamiltonSystem {
  M metric;

  template <class S>
  NULLCONE_INLINE void operator()(const State<S>& y, State<S>& dy, const S&) const {
    dy = to_state(rhs(metric, to_phase(y).x, to_phase(y).p));
  }
  template <class S>
  State<S> rate(const State<S>& y) const {
    State<S> dy;
    (*this)(y, dy, S(0.0));
    return dy;
  }
};

/// Limits of the controller, measured (docs/accuracy.md): a step is at most kGrowth times as long as the last
/// one, and moves by at most a part of the length scale, lest it jump over what it cannot know; away from the
/// origin, where fields get weaker, it may move farther.
inline constexpr double kGrowth = 5, kShrink = 0.2, kSafety = 0.8, kReachInwards = 0.4, kReachOutwards = 1;

/// Rays on their way.
template <class S>
struct Flight {
  State<S> y, dy;
  S lambda{}, h{};        ///< how far it has come, and how long the next step shall be
  S steps{}, error{};     ///< attempts so far; sum of the estimated local errors of the steps taken, relative
  S growth = S(kGrowth);  ///< how many times longer the next step may be: not at all after a refusal
};

template <class S>
struct Attempt {
  State<S> y1, dy1;
  S h, error;  ///< length of the step, and its relative local error
  S factor;    ///< by which the next step should be longer
  Mask<S> accepted, finite;
};

/// A first step that is surely not too long by much: the controller makes it longer soon. Positive. (Roots
/// alone: pow would bring code that instruction sets share.)
template <int kRoots, Metric M, class S>
S first_step(const M& metric, const State<S>& y, const State<S>& dy, double rtol) {
  const S speed = max(norm(spatial(to_phase(dy).x)), abs(dy[0]));
  double part = max(rtol, 1e-14);
  for (int i = 0; i < kRoots; ++i) part = sqrt(part);
  return S(0.5 * part) * length_scale(metric, to_phase(y).x) / max(speed, S(1e-300));
}

/// Judges an attempt by the estimated error of its state. Errors of position are measured against the
/// metric's length scale, those of momentum against the largest component; a step is accepted if all are
/// below rtol (positions: plus atol), and all finite.
template <class Stepper, Metric M, class S>
NULLCONE_INLINE void judge(const M& metric, const Accuracy& accuracy, const Flight<S>& from,
                           const State<S>& error, Attempt<S>& out) {
  const auto largest = [](const State<S>& v, std::size_t first) {
    return max(max(abs(v[first]), abs(v[first + 1])), max(abs(v[first + 2]), abs(v[first + 3])));
  };
  const S scale = length_scale(metric, to_phase(from.y).x);
  const double rtol = Stepper::kEstimate * accuracy.rtol;
  const S allowed_x = S(Stepper::kEstimate * accuracy.atol) + S(rtol) * scale;
  const S allowed_p = S(rtol) * largest(from.y, 4);
  const S e = max(max(largest(error, 0) / allowed_x, largest(error, 4) / allowed_p), S(1e-10));
  // max drops NaN, so finiteness is asked for apart.
  S sum = out.y1[0];
  for (std::size_t i = 1; i < 8; ++i) sum = sum + out.y1[i];
  const S nothing = (sum - sum) + (error[0] - error[0]) + (error[4] - error[4]);
  out.finite = nothing == S(0.0);
  out.accepted = (e <= S(1.0)) & out.finite;
  out.error = S(accuracy.rtol) * e;
  S root = sqrt(e);
  for (int i = 1; i < Stepper::kRoots; ++i) root = sqrt(root);
  out.factor = select(out.finite, max(S(kShrink), min(from.growth, S(kSafety) / root)), S(kShrink));
}

/// Tries a step of length h.
template <class Stepper, Metric M, class S>
NULLCONE_INLINE Attempt<S> attempt(Stepper& stepper, const HamiltonSystem<M>& system,
                                   const Accuracy& accuracy, const Flight<S>& from, const S& h) {
  Attempt<S> out;
  State<S> error;
  out.h = h;
  stepper.step(system, from.y, from.dy, h, out.y1, out.dy1, error);
  judge<Stepper>(system.metric, accuracy, from, error, out);
  return out;
}

/// How long the next step shall be, where `rest` is left to go.
template <Metric M, class S>
S next_step(const M& metric, const Flight<S>& flight, const S& rest) {
  const Vec3<S> X = spatial(to_phase(flight.y).x), V = spatial(to_phase(flight.dy).x);
  const S reach = select(dot(X, V) > S(0.0), S(kReachOutwards), S(kReachInwards));
  const S cap = reach * length_scale(metric, to_phase(flight.y).x) / max(norm(V), S(1e-300));
  return min(min(flight.h, cap), rest);
}

/// What every attempt changes in a flight: all but where it stands.
template <class S>
void learn(Flight<S>& flight, const Attempt<S>& a, const Mask<S>& active) {
  flight.steps = select(active, flight.steps + S(1.0), flight.steps);
  flight.h = select(active, a.h * a.factor, flight.h);
  flight.growth = select(active, select(a.accepted, S(kGrowth), S(1.0)), flight.growth);
  flight.error = select(active & a.accepted, flight.error + a.error, flight.error);
}

/// Calls f with a stepper of the integrator's type, for states Y.
template <class S, class Y = State<S>, class F>
auto with_stepper(Integrator integrator, F&& f) {
  switch (integrator) {
    case Integrator::dopri5: {
      DormandPrince5<S, Y> stepper;
      return f(stepper);
    }
    case Integrator::verner65: {
      Verner65<S, Y> stepper;
      return f(stepper);
    }
    case Integrator::fehlberg78: {
      Fehlberg78<S, Y> stepper;
      return f(stepper);
    }
    case Integrator::prince_dormand87:
      break;
  }
  PrinceDormand87<S, Y> stepper;
  return f(stepper);
}

NULLCONE_KERNEL_END
