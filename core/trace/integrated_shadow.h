// Shadows along integrated rays: how much of a lamp's light gets through the objects between it and an event.
#pragma once

#include "core/trace/march.h"

NULLCONE_KERNEL_BEGIN

/// What shadows are made of.
template <Metric M>
struct ShadowSetting {
  const MarchSetting<M>* march;  ///< objects, accuracy
  const double* opacity;         ///< by object number - 1
  std::uint32_t lamp_body = 0;   ///< number of the object that casts no shadow; 0: none

  double opacity_of(const MarchObject<M>& object) const { return opacity[object.number - 1]; }
  bool casts(const MarchObject<M>& object) const {
    return object.number != lamp_body && opacity_of(object) > 0;
  }
};

template <class S>
struct Shade {
  S through;     ///< part of the light that gets through, 0 to 1
  Mask<S> lost;  ///< the ray was given up: this means nothing
};

/// Where rays are among the objects, by place in the list.
template <class S>
struct ShadowTrail {
  Alongside<S> alongside;
  Mask<S> is_free;  ///< the next crossing is that of the start with the surface it lies on
};

/// At the start of rays, of which those on the object `own` lie on its surface.
template <class S, Metric M>
ShadowTrail<S> shadow_trail(const MarchObject<M>& object, const Phase<S>& at, const Phase<S>& rate,
                            bool own) {
  return with_type(object.marched, [&](const auto& marched) {
    const auto& shape = marched.shape;
    const Located<S> here = marched.map.locate(at.x, rate.x);
    const S sheet(shape.is_sheet() ? 1.0 : 0.0);
    ShadowTrail<S> out;
    out.alongside.after = S(0.0);
    if (own) {
      const auto outwards = dot(shape.outward(here.X), here.slope) > S(0.0);
      out.alongside.side = S(-1.0);
      out.is_free = outwards | (sheet > S(0.0));
    } else {
      const Mask<S> inside = shape.is_sheet() ? sheet < S(0.0) : shape.holds(here.X);
      out.alongside.side = select(inside, S(-1.0), S(1.0));
      out.is_free = inside & !inside;
    }
    return out;
  });
}

/// What an object lets through of light that crosses it within a step from `start` on.
template <class S, Metric M, std::size_t n>
S through_object(const MarchObject<M>& object, double opacity, const StepStates<S, n>& step, const S& start,
                 const S& length, const Mask<S>& wanted, ShadowTrail<S>& trail, Mask<S>& lost) {
  return object.with_curve(step.at, step.rate, length, [&](const auto& curve, const auto& shape) {
    const S resolution = resolution_of(step, length);
    S through(1.0);
    Mask<S> goes_on = wanted;
    for (int i = 0; any(goes_on); ++i) {
      const Search<S> search = trail.alongside.cross(curve, shape, start, length, resolution, goes_on);
      lost = lost | search.given_up;
      through = select(search.met & !trail.is_free, S(1 - opacity) * through, through);
      trail.is_free = trail.is_free & !search.met;
      goes_on = search.met & (through > S(0.0));
      if (i == kMostInAStep) lost = lost | search.met, goes_on = goes_on & !goes_on;
    }
    return through;
  });
}

/// Light to events from where past-directed rays with these chart tangents, frequency 1 at the events, come
/// to at lambda = length. The events lie on the surface of the object number `own`, or on none (0): a ray
/// does not meet the surface that it leaves, but may come back to it. Rays that are not `wanted` let all
/// through.
template <class Stepper, Metric M, class S>
Shade<S> light_through(Stepper& stepper, const ShadowSetting<M>& setting, std::uint32_t own,
                       const Vec4<S>& event, const Vec4<S>& tangent, const S& length, const Mask<S>& wanted) {
  const MarchSetting<M>& march = *setting.march;
  const M& metric = march.system.metric;
  Flight<S> flight;
  flight.y = to_state(Phase<S>{event, metric.g(event) * tangent}), flight.dy = march.system.rate(flight.y);
  flight.h = first_step<Stepper::kRoots>(metric, flight.y, flight.dy, march.accuracy.rtol);
  const std::unique_ptr<ShadowTrail<S>[]> trails(new ShadowTrail<S>[march.count]);
  for (std::size_t k = 0; k < march.count; ++k)
    trails[k] = shadow_trail(march.objects[k], to_phase(flight.y), to_phase(flight.dy),
                             march.objects[k].number == own);
  Mask<S> active = wanted & (flight.lambda < length);
  Shade<S> out{S(1.0), Mask<S>(active & !active)};
  while (any(active)) {
    const S rest = length - flight.lambda;
    const Attempt<S> a =
        attempt(stepper, march.system, march.accuracy, flight, next_step(metric, flight, rest));
    const State<S> y = flight.y;
    const Phase<S> from = to_phase(y), rate = to_phase(flight.dy), to = to_phase(a.y1),
                   end_rate = to_phase(a.dy1);
    const Mask<S> moves = active & a.accepted;
    const Capsule<S> capsule(spatial(from.x), spatial(rate.x), spatial(to.x), spatial(end_rate.x), a.h);
    for (std::size_t k = 0; k < march.count; ++k) {
      const MarchObject<M>& object = march.objects[k];
      const Mask<S> near = moves & object.may_come_near(capsule, from, rate, to, end_rate, a.h);
      if (!setting.casts(object) || !any(near)) continue;
      const StepStates<S, states_of_step<Stepper>()> step(stepper, march.system, y, a.y1, a.h);
      out.through = out.through * through_object(object, setting.opacity_of(object), step, flight.lambda, a.h,
                                                 near, trails[k], out.lost);
    }
    learn(flight, a, active);
    const S progress = a.h * norm(spatial(rate.x));
    const auto stuck = active & !a.accepted & !(progress > S(1e-14) * length_scale(metric, from.x));
    flight.y = select(moves, a.y1, flight.y);
    flight.dy = select(moves, a.dy1, flight.dy);
    // Rounding must not leave a last step of nothing: no curve can be laid through it.
    flight.lambda = select(moves, select(a.h == rest, length, flight.lambda + a.h), flight.lambda);
    out.lost = out.lost | stuck | (active & (flight.steps >= S(kStepLimit)));
    active = active & !out.lost & (out.through > S(0.0)) & (flight.lambda < length);
  }
  return out;
}

NULLCONE_KERNEL_END
