// Integrated rays, many at a time: they take steps in rounds; those whose step comes near an object wait
// until a whole pack of them is looked at closely; those that have ended make room. A ray's numbers depend on
// nothing but the ray.
#pragma once

#include "core/trace/curve.h"
#include "core/trace/integrate.h"
#include "core/trace/kernel.h"
#include "core/trace/march_object.h"

NULLCONE_KERNEL_BEGIN

/// Most attempts of a step that a ray may take; beyond it the pixel is marked doubtful.
inline constexpr double kStepLimit = 20000;

/// Rays on their way, as columns. `y` is where the last step that was looked at closely began, once a ray has
/// hit: the crossing then lies `delta` further.
struct Flights {
  std::size_t count;
  std::unique_ptr<double[]> memory;
  std::array<double*, 8> y{}, y1{};  ///< y1: end of the step that waits to be looked at
  double *lambda, *h, *growth, *steps, *error, *length, *delta;
  std::unique_ptr<std::uint32_t[]> object, list, waiting;
  std::unique_ptr<Status[]> status;
  std::size_t listed = 0, waits = 0;

  explicit Flights(std::size_t rays)
      : count(rays),
        memory(new double[23 * rays]()),
        object(new std::uint32_t[rays]()),
        list(new std::uint32_t[rays]),
        waiting(new std::uint32_t[rays]),
        status(new Status[rays]()) {
    double* next = memory.get();
    const auto column = [&] { return std::exchange(next, next + rays); };
    for (std::size_t i = 0; i < 8; ++i) y[i] = column(), y1[i] = column();
    lambda = column(), h = column(), growth = column(), steps = column(), error = column(), length = column(),
    delta = column();
  }
};

template <class S>
State<S> load(const Group<S>& group, const std::array<double*, 8>& columns) {
  return State<S>::map([&](std::size_t i) { return group.load(columns[i]); });
}
template <class S>
void store(const Group<S>& group, const State<S>& y, const std::array<double*, 8>& columns) {
  for (std::size_t i = 0; i < 8; ++i) group.store(y[i], columns[i]);
}

/// All that a march needs to know; the same for every ray.
template <Metric M>
struct MarchSetting {
  HamiltonSystem<M> system;
  Accuracy accuracy;
  double lookback;
  const MarchObject<M>* objects;
  std::size_t count;
  std::array<std::uint32_t, 2> sky;  ///< numbers of the skies' objects, 0 for none
  double reach;         ///< coordinates of every object lie within this distance of the origin …
  double inside;        ///< … and farther than this from it
  bool moving = false;  ///< not all objects are at rest: they may be met far away
};

/// How a ray that stands at y ends, as a number of the scalar; `none` if it goes on. A ray may not escape
/// before it has passed all objects.
template <Metric M, class S>
S ending_of(const MarchSetting<M>& setting, const State<S>& y, const State<S>& dy) {
  const Phase<S> at = to_phase(y);
  const S end = ending(setting.system.metric, at, to_phase(dy), setting.accuracy.rtol);
  const S distance2 = dot(spatial(at.x), spatial(at.x));
  const auto too_early =
      ((end == as_scalar<S>(Ending::sky)) & (distance2 < S(setting.reach * setting.reach))) |
      ((end == as_scalar<S>(Ending::second_sky)) & (distance2 > S(setting.inside * setting.inside)));
  return select(too_early, S(0.0), end);
}

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

/// Takes a group of rays up to `rounds` attempts further. Those that go on are listed again, those that come
/// near an object wait.
template <class Stepper, Metric M, class S>
void advance_group(Stepper& stepper, const MarchSetting<M>& setting, const Group<S>& group, int rounds,
                   Flights& flights, std::size_t& left) {
  const auto& system = setting.system;
  Flight<S> flight;
  flight.y = load(group, flights.y);
  flight.dy = system.rate(flight.y);
  flight.lambda = group.load(flights.lambda);
  flight.h = group.load(flights.h);
  flight.steps = group.load(flights.steps);
  flight.error = group.load(flights.error);
  flight.growth = group.load(flights.growth);
  S end(0.0), length(0.0);
  State<S> y1 = flight.y;
  auto active = flight.lambda == flight.lambda, waits = active & !active, given_up = waits;
  const S limit(setting.lookback);
  for (int i = 0; i < rounds && any(active); ++i) {
    const Attempt<S> a = attempt(stepper, system, setting.accuracy, flight,
                                 next_step(system.metric, flight, limit - flight.lambda));
    learn(flight, a, active);
    const auto taken = active & a.accepted;
    // A step may also become too short to get anywhere.
    const S progress = abs(a.h) * norm(spatial(to_phase(flight.dy).x));
    const auto stuck =
        active & !a.accepted & !(progress > S(1e-14) * length_scale(system.metric, to_phase(flight.y).x));
    auto near = waits & !waits;
    if (setting.count > 0 && any(taken)) {
      const Phase<S> from = to_phase(flight.y), rate = to_phase(flight.dy), to = to_phase(a.y1),
                     end_rate = to_phase(a.dy1);
      const Capsule<S> capsule(spatial(from.x), spatial(rate.x), spatial(to.x), spatial(end_rate.x), a.h);
      for (std::size_t k = 0; k < setting.count; ++k)
        near = near | setting.objects[k].may_come_near(capsule, from, rate, to, end_rate, a.h);
    }
    near = near & taken;
    waits = waits | near;
    y1 = select(near, a.y1, y1);
    length = select(near, a.h, length);
    const auto moves = taken & !near;
    flight.y = select(moves, a.y1, flight.y);
    flight.dy = select(moves, a.dy1, flight.dy);
    flight.lambda = select(moves, flight.lambda + a.h, flight.lambda);
    end = select(moves, ending_of(setting, flight.y, flight.dy), end);
    given_up = given_up | stuck | (active & (flight.steps >= S(kStepLimit)) & !near);
    active = active & !near & !given_up & (end == S(0.0)) & (flight.lambda < limit);
  }
  store(group, flight.y, flights.y);
  store(group, y1, flights.y1);
  group.store(flight.lambda, flights.lambda);
  group.store(flight.h, flights.h);
  group.store(flight.steps, flights.steps);
  group.store(flight.error, flights.error);
  group.store(flight.growth, flights.growth);
  group.store(length, flights.length);
  std::array<bool, Group<S>::kWidth> goes_on{}, waiting{}, doubtful{};
  Lanes<S>::store(active, goes_on.data());
  Lanes<S>::store(waits, waiting.data());
  Lanes<S>::store(given_up, doubtful.data());
  for (std::size_t lane = 0; lane < group.filled; ++lane) {
    const std::size_t ray = group.ray[lane];
    const double how = Lanes<S>::get(end, lane);
    if (goes_on[lane])
      flights.list[left++] = static_cast<std::uint32_t>(ray);
    else if (waiting[lane])
      flights.waiting[flights.waits++] = static_cast<std::uint32_t>(ray);
    else if (doubtful[lane])
      end_ray(setting, flights, ray, Status::step_limit, 0);
    else if (how != 0)
      end_ray(setting, flights, ray, status_of(how), how);
    else
      end_ray(setting, flights, ray, Status::lookback_reached, 0);
  }
}

/// Looks closely at the waiting steps of a group: where do they first meet an object? Those that meet none go
/// on.
template <class Stepper, Metric M, class S>
void look_closely(Stepper& stepper, const MarchSetting<M>& setting, const Group<S>& group, Flights& flights) {
  constexpr std::size_t n = Stepper::kOrder > 6 ? 4 : 3;
  const auto& system = setting.system;
  const S length = group.load(flights.length);
  std::array<Phase<S>, n> at, rate;  // evenly spaced along the step
  State<S> y = load(group, flights.y), dy = system.rate(y);
  at[0] = to_phase(y), rate[0] = to_phase(dy);
  for (std::size_t k = 1; k < n; ++k) {
    const State<S> here = k + 1 == n
                              ? load(group, flights.y1)
                              : stepper.move(system, y, dy, S(static_cast<double>(k) / (n - 1)) * length);
    at[k] = to_phase(here), rate[k] = to_phase(system.rate(here));
  }
  S delta = length, number(0.0);
  auto lost = delta != delta;
  for (std::size_t i = 0; i < setting.count; ++i) {
    const Search<S> search = setting.objects[i].first_crossing(at, rate, length, delta);
    delta = select(search.met, search.lambda, delta);
    number = select(search.met, S(static_cast<double>(i)), number);
    lost = lost | search.given_up;
  }
  const auto met = delta < length;
  const S lambda = group.load(flights.lambda);
  const State<S> y1 = to_state(at[n - 1]);
  const S end = ending_of(setting, y1, to_state(rate[n - 1]));
  store(group, select(met, y, y1), flights.y);
  group.store(select(met, lambda, lambda + length), flights.lambda);
  group.store(delta, flights.delta);
  std::array<bool, Group<S>::kWidth> hit{}, doubtful{};
  Lanes<S>::store(met, hit.data());
  Lanes<S>::store(lost, doubtful.data());
  for (std::size_t lane = 0; lane < group.filled; ++lane) {
    const std::size_t ray = group.ray[lane];
    const double how = Lanes<S>::get(end, lane);
    if (hit[lane]) {
      flights.status[ray] = Status::hit;
      flights.object[ray] = setting.objects[static_cast<std::size_t>(Lanes<S>::get(number, lane))].number;
    } else if (doubtful[lane] || flights.steps[ray] >= kStepLimit) {
      end_ray(setting, flights, ray, Status::step_limit, 0);
    } else if (how != 0) {
      end_ray(setting, flights, ray, status_of(how), how);
    } else if (!(flights.lambda[ray] < setting.lookback)) {
      end_ray(setting, flights, ray, Status::lookback_reached, 0);
    } else {
      flights.list[flights.listed++] = static_cast<std::uint32_t>(ray);
    }
  }
}

/// Follows all rays to their ends.
template <class S, class Stepper, Metric M>
void march(Stepper& stepper, const MarchSetting<M>& setting, Flights& flights) {
  constexpr int kRound = 12;
  for (std::size_t i = 0; i < flights.count; ++i) flights.list[i] = static_cast<std::uint32_t>(i);
  flights.listed = flights.count;
  while (flights.listed > 0) {
    std::size_t left = 0;
    flights.waits = 0;
    for (std::size_t i = 0; i < flights.listed; i += Lanes<S>::count)
      advance_group(stepper, setting, Group<S>(flights.list.get(), i, flights.listed), kRound, flights, left);
    flights.listed = left;
    for (std::size_t i = 0; i < flights.waits; i += Lanes<S>::count)
      look_closely(stepper, setting, Group<S>(flights.waiting.get(), i, flights.waits), flights);
  }
}

NULLCONE_KERNEL_END
