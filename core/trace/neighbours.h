// Integrated rays beside those that have met something: how the event changes from pixel to pixel.
#pragma once

#include "core/trace/details.h"
#include "core/trace/march.h"

NULLCONE_KERNEL_BEGIN

/// What makes a ray's first state.
template <Metric M>
struct Departure {
  Viewpoint<M> from;
  bool from_film;
  Matrix4<double> lowered{};  ///< rows: g e_a at the observer's event

  Departure(const Viewpoint<M>& viewpoint, bool film) : from(viewpoint), from_film(film) {
    const Matrix4<double> g = from.metric.g(from.event);
    for (std::size_t a = 0; a < 4; ++a) lowered[a] = g * from.tetrad.e[a];
  }

  template <class S>
  State<S> state(const RayStart<S>& ray) const {
    if (from_film) return to_state(Phase<S>{ray.event, from.momentum(ray)});
    Phase<S> start{convert<S>(from.event), {}};
    for (std::size_t a = 0; a < 4; ++a) start.p = start.p + ray.past[a] * convert<S>(lowered[a]);
    return to_state(start);
  }
};

/// Where rays come to that look for no objects.
template <class S>
struct Followed {
  State<S> y, dy;
  S end;         ///< an Ending
  Mask<S> lost;  ///< it did not come so far
};

/// Follows rays from y up to lambda = target, or (`to_sky`) until they have escaped; with the steps that they
/// would take anyway.
template <class Stepper, Metric M, class S>
Followed<S> follow(Stepper& stepper, const MarchSetting<M>& setting, const State<S>& y, const S& target,
                   bool to_sky) {
  const auto& metric = setting.system.metric;
  Flight<S> flight;
  flight.y = y, flight.dy = setting.system.rate(y);
  flight.h = first_step<Stepper::kRoots>(metric, y, flight.dy, setting.accuracy.rtol);
  auto active = flight.lambda < target;
  Followed<S> out{{}, {}, S(0.0), !active};
  const auto sky = S(as_scalar<S>(Ending::sky));
  while (any(active)) {
    const Attempt<S> a = attempt(stepper, setting.system, setting.accuracy, flight,
                                 next_step(metric, flight, target - flight.lambda));
    learn(flight, a, active);
    const S progress = a.h * norm(spatial(to_phase(flight.dy).x));
    const auto stuck =
        active & !a.accepted & !(progress > S(1e-14) * length_scale(metric, to_phase(flight.y).x));
    const auto moves = active & a.accepted;
    flight.y = select(moves, a.y1, flight.y);
    flight.dy = select(moves, a.dy1, flight.dy);
    flight.lambda = select(moves, flight.lambda + a.h, flight.lambda);
    out.end = select(moves, ending_of(setting, flight.y, flight.dy), out.end);
    const auto fallen = (out.end > S(0.0)) & (out.end < sky), escaped = out.end >= sky;
    out.lost = out.lost | stuck | (active & (fallen | (flight.steps >= S(kStepLimit))));
    active = active & !out.lost & (flight.lambda < target);
    if (to_sky) active = active & !escaped;
  }
  out.y = flight.y, out.dy = flight.dy;
  return out;
}

/// Half a pixel to either side: near enough for differences, and far enough for the errors of two rays.
inline constexpr double kBesideIntegrated = 0.5;

/// Events at lambda = target on rays; NaN for those that do not come so far.
template <class Stepper, Metric M, class S>
Vec4<S> event_at(Stepper& stepper, const MarchSetting<M>& setting, const Departure<M>& departure,
                 const RayStart<S>& ray, const S& target) {
  const Followed<S> found = follow(stepper, setting, departure.state(ray), target, false);
  const Vec4<S> none = Vec4<S>::map([](std::size_t) { return S(std::numeric_limits<double>::quiet_NaN()); });
  return select(found.lost, none, to_phase(found.y).x);
}

template <class Stepper, Metric M, class S>
EventChange<S> event_change(Stepper& stepper, const MarchSetting<M>& setting, const Departure<M>& departure,
                            const std::array<RayStart<S>, 4>& beside, const S& target) {
  const auto event = [&](std::size_t i) { return event_at(stepper, setting, departure, beside[i], target); };
  const S scale(0.5 / kBesideIntegrated);
  return {scale * (event(0) - event(1)), scale * (event(2) - event(3))};
}

/// The same for the direction to a sky, of length 1 (its time component is 0); NaN where a neighbour does not
/// see the same sky.
template <class Stepper, Metric M, class S>
EventChange<S> direction_change(Stepper& stepper, const MarchSetting<M>& setting,
                                const Departure<M>& departure, const std::array<RayStart<S>, 4>& beside,
                                double sky) {
  const auto direction = [&](std::size_t i) {
    const Followed<S> found = follow(stepper, setting, departure.state(beside[i]), S(setting.lookback), true);
    const Vec3<S> n =
        normalised(sky_direction(setting.system.metric, to_phase(found.y), to_phase(found.dy), S(sky)));
    const S none(std::numeric_limits<double>::quiet_NaN());
    const auto other = found.lost | (found.end != S(sky));
    return select(other, Vec4<S>{{none, none, none, none}}, Vec4<S>{{S(0.0), n[0], n[1], n[2]}});
  };
  const S scale(0.5 / kBesideIntegrated);
  return {scale * (direction(0) - direction(1)), scale * (direction(2) - direction(3))};
}

NULLCONE_KERNEL_END
