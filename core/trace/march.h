// Integrated rays, many at a time: they take steps in rounds; those whose step comes near an object wait
// until a whole pack of them is looked at closely; those that have ended make room. A ray's numbers depend on
// nothing but the ray.
#pragma once

#include "core/trace/march_onward.h"

NULLCONE_KERNEL_BEGIN

/// One ray has ended.
template <Metric M>
void end_ray(const MarchSetting<M>& setting, Flights& flights, std::size_t ray, Status status, double end) {
  flights.status[ray] = status;
  if (end < as_scalar<double>(Ending::sky)) return;
  flights.object[ray] = setting.sky[end > as_scalar<double>(Ending::sky) ? 1 : 0];
}
inline Status status_of(double end) {
  return end == as_scalar<double>(Ending::captured)     ? Status::captured
         : end == as_scalar<double>(Ending::left_chart) ? Status::left_chart
                                                        : Status::sky;
}

/// The rays of a group while they take steps; lanes that are no longer active stand still.
template <class S>
struct Marching {
  Flight<S> flight;
  State<S> y1;  ///< where the step ends that comes near an object, and how long it is
  S length = S(0.0);
  S end = S(0.0);  ///< an Ending
  Mask<S> active, near, given_up, broken;
  Turning<S> turning;

  Marching(const Flight<S>& from, const Turning<S>& turned) : flight(from), y1(from.y), turning(turned) {
    active = from.lambda == from.lambda;
    near = given_up = broken = active & !active;
  }
};

/// Whether a step may meet any object.
template <Metric M, class S>
Mask<S> comes_near(const MarchSetting<M>& setting, const Flight<S>& flight, const Attempt<S>& a) {
  const Phase<S> from = to_phase(flight.y), rate = to_phase(flight.dy), to = to_phase(a.y1),
                 end_rate = to_phase(a.dy1);
  const Capsule<S> capsule(spatial(from.x), spatial(rate.x), spatial(to.x), spatial(end_rate.x), a.h);
  auto near = a.accepted & !a.accepted;
  for (std::size_t k = 0; k < setting.count; ++k)
    near = near | setting.objects[k].may_come_near(capsule, from, rate, to, end_rate, a.h);
  return near & a.accepted;
}

/// Whether a ray has come as far as it shall. What rounding leaves is no step: no curve can be laid through
/// it.
template <Metric M, class S>
Mask<S> is_at_end(const MarchSetting<M>& setting, const S& lambda, const S& t) {
  return (lambda >= S((1 - 4e-15) * setting.lookback)) | (t < S(setting.earliest));
}

/// One attempt of a step for every active lane.
template <class Stepper, Metric M, class S>
void try_step(Stepper& stepper, const MarchSetting<M>& setting, Marching<S>& m) {
  const auto& metric = setting.system.metric;
  const S limit(setting.lookback);
  Flight<S>& flight = m.flight;
  const Attempt<S> a = attempt(stepper, setting.system, setting.accuracy, flight,
                               next_step(metric, flight, limit - flight.lambda));
  learn(flight, a, m.active);
  // A step may also become too short to get anywhere.
  const S progress = a.h * norm(spatial(to_phase(flight.dy).x));
  const auto stuck =
      m.active & !a.accepted & !(progress > S(1e-14) * length_scale(metric, to_phase(flight.y).x));
  const auto near = m.active & comes_near(setting, flight, a), moves = m.active & a.accepted & !near;
  m.near = m.near | near;
  m.y1 = select(near, a.y1, m.y1);
  m.length = select(near, a.h, m.length);
  flight.y = select(moves, a.y1, flight.y);
  flight.dy = select(moves, a.dy1, flight.dy);
  flight.lambda = select(moves, flight.lambda + a.h, flight.lambda);
  m.end = select(moves, ending_of(setting, flight.y, flight.dy), m.end);
  if constexpr (is_central<M>())
    m.turning.turns = select(moves, m.turning.at(spatial(to_phase(flight.y).x)), m.turning.turns);
  m.broken = m.broken | (stuck & !a.finite);
  m.given_up = m.given_up | stuck | (m.active & (flight.steps >= S(kStepLimit)) & !near);
  m.active =
      m.active & !near & !m.given_up & (m.end == S(0.0)) & !is_at_end(setting, flight.lambda, flight.y[0]);
}

template <class S>
void store(const Group<S>& group, const Marching<S>& m, const Flights& flights) {
  store(group, m.flight.y, flights.y);
  store(group, m.y1, flights.y1);
  group.store(m.flight.lambda, flights.lambda);
  group.store(m.flight.h, flights.h);
  group.store(m.flight.growth, flights.growth);
  group.store(m.flight.steps, flights.steps);
  group.store(m.flight.error, flights.error);
  group.store(m.length, flights.length);
  group.store(m.turning.turns, flights.turns);
}

/// Takes a group of rays up to `rounds` attempts further. Those that go on are listed again, from `left` on;
/// those that come near an object wait.
template <class Stepper, Metric M, class S>
void advance_group(Stepper& stepper, const MarchSetting<M>& setting, const Group<S>& group, int rounds,
                   Flights& flights, std::size_t& left) {
  Flight<S> flight = load_flight(group, flights);
  flight.dy = setting.system.rate(flight.y);
  Marching<S> m(flight, load_turning(group, flights));
  for (int i = 0; i < rounds && any(m.active); ++i) try_step(stepper, setting, m);
  store(group, m, flights);
  std::array<bool, Group<S>::kWidth> active{}, near{}, given_up{}, broken{};
  Lanes<S>::store(m.active, active.data());
  Lanes<S>::store(m.near, near.data());
  Lanes<S>::store(m.given_up, given_up.data());
  Lanes<S>::store(m.broken, broken.data());
  for (std::size_t lane = 0; lane < group.filled; ++lane) {
    const std::size_t ray = group.ray[lane];
    const double how = Lanes<S>::get(m.end, lane);
    if (active[lane])
      flights.list[left++] = static_cast<std::uint32_t>(ray);
    else if (near[lane])
      flights.waiting[flights.waits++] = static_cast<std::uint32_t>(ray);
    else if (given_up[lane])
      end_ray(setting, flights, ray, broken[lane] ? Status::not_finite : Status::step_limit, 0);
    else if (how != 0)
      end_ray(setting, flights, ray, status_of(how), how);
    else
      end_ray(setting, flights, ray, Status::lookback_reached, 0);
  }
}

/// Those whose step met nothing go on from its end.
template <Metric M, class S>
void settle(const MarchSetting<M>& setting, const Group<S>& group, const Look<S>& look, Flights& flights) {
  const S lambda = group.load(flights.lambda);
  if constexpr (is_central<M>()) {
    const Turning<S> turning = load_turning(group, flights);
    const S turned = turning.at(spatial(to_phase(load(group, flights.y1)).x));
    group.store(select(look.met, turning.turns, turned), flights.turns);
  }
  store(group, select(look.met, load(group, flights.y), load(group, flights.y1)), flights.y);
  group.store(select(look.met, lambda, lambda + group.load(flights.length)), flights.lambda);
  group.store(look.delta, flights.delta);
  std::array<bool, Group<S>::kWidth> met{}, lost{};
  Lanes<S>::store(look.met, met.data());
  Lanes<S>::store(look.lost, lost.data());
  for (std::size_t lane = 0; lane < group.filled; ++lane) {
    const std::size_t ray = group.ray[lane];
    const double how = Lanes<S>::get(look.end, lane);
    if (met[lane]) {
      flights.status[ray] = Status::hit;
      flights.object[ray] =
          setting.objects[static_cast<std::size_t>(Lanes<S>::get(look.number, lane))].number;
    } else if (lost[lane] || flights.steps[ray] >= kStepLimit) {
      end_ray(setting, flights, ray, Status::step_limit, 0);
    } else if (how != 0) {
      end_ray(setting, flights, ray, status_of(how), how);
    } else if (is_at_end(setting, flights.lambda[ray], flights.y[0][ray])) {
      end_ray(setting, flights, ray, Status::lookback_reached, 0);
    } else {
      flights.list[flights.listed++] = static_cast<std::uint32_t>(ray);
    }
  }
}

/// Looks closely at the waiting steps of a group.
template <class Stepper, Metric M, class S>
Look<S> look_at(Stepper& stepper, const MarchSetting<M>& setting, const Group<S>& group,
                const Flights& flights, Trails* trails) {
  constexpr std::size_t n = states_of_step<Stepper>();
  const S length = group.load(flights.length);
  const State<S> y1 = load(group, flights.y1);
  const StepStates<S, n> step(stepper, setting.system, load(group, flights.y), y1, length);
  Look<S> out = look_closely(setting, step, group, flights, y1, length);
  if (trails) look_onward(setting, step, group, flights, length, *trails, out);
  return out;
}

/// Follows all rays to their ends; `trails`, where they go on behind what they meet, else null.
template <class S, class Stepper, Metric M>
void march(Stepper& stepper, const MarchSetting<M>& setting, Flights& flights, Trails* trails) {
  constexpr int kRound = 12;
  flights.listed = 0;
  for (std::size_t i = 0; i < flights.count; ++i)
    if (flights.status[i] == Status::hit) flights.list[flights.listed++] = static_cast<std::uint32_t>(i);
  while (flights.listed > 0) {
    std::size_t left = 0;
    flights.waits = 0;
    for (std::size_t i = 0; i < flights.listed; i += Lanes<S>::count)
      advance_group(stepper, setting, Group<S>(flights.list.get(), i, flights.listed), kRound, flights, left);
    flights.listed = left;
    for (std::size_t i = 0; i < flights.waits; i += Lanes<S>::count) {
      const Group<S> group(flights.waiting.get(), i, flights.waits);
      settle(setting, group, look_at(stepper, setting, group, flights, trails), flights);
    }
  }
}

NULLCONE_KERNEL_END
