// A step of a march that comes near objects: what is known of it, and where it first meets one.
#pragma once

#include "core/trace/flights.h"
#include "core/trace/march_object.h"
#include "core/trace/turns.h"

NULLCONE_KERNEL_BEGIN

/// All that a march needs to know; the same for every ray.
template <Metric M>
struct MarchSetting {
  HamiltonSystem<M> system;
  Accuracy accuracy;
  double lookback;
  const MarchObject<M>* objects;
  std::size_t count;
  std::array<std::uint32_t, 2> sky;  ///< numbers of the skies' objects, 0 for none
  double reach;   ///< coordinates of every object lie within this distance of the origin …
  double inside;  ///< … and farther than this from it
  std::uint32_t max_hits =
      0;                    ///< crossings of a ray that ends it; 0: the first with an object that ends rays
  double earliest = -kFar;  ///< time at which rays end
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

/// Evenly spaced states of a step, both ends included, and their rates.
template <class S, std::size_t n>
struct StepStates {
  std::array<Phase<S>, n> at, rate;

  template <class Stepper, Metric M>
  StepStates(Stepper& stepper, const HamiltonSystem<M>& system, const State<S>& y, const State<S>& y1,
             const S& length) {
    const State<S> dy = system.rate(y);
    at[0] = to_phase(y), rate[0] = to_phase(dy);
    for (std::size_t k = 1; k < n; ++k) {
      const S part(static_cast<double>(k) / (n - 1));
      const State<S> here = k + 1 == n ? y1 : stepper.move(system, y, dy, part * length);
      at[k] = to_phase(here), rate[k] = to_phase(system.rate(here));
    }
  }
};

/// What a close look at a step finds.
template <class S>
struct Look {
  S delta, number;  ///< where an object is met, and its place in the list
  Mask<S> met, lost;
  S end;  ///< an Ending, at the end of the step
};

/// States that a curve through a step needs to be as good as the step.
template <class Stepper>
constexpr std::size_t states_of_step() {
  return Stepper::kOrder > 6 ? 4 : 3;
}

/// Where a step first meets object number i, before `limit`, on rays some of which may have started inside.
template <Metric M, class S, std::size_t n>
Search<S> first_crossing(const MarchSetting<M>& setting, const StepStates<S, n>& step, const Group<S>& group,
                         const Flights& flights, std::size_t i, const S& length, const S& limit) {
  const MarchObject<M>& object = setting.objects[i];
  if (!flights.inside) return object.first_crossing(step.at, step.rate, length, limit);
  const Mask<S> inside = group.load(flights.inside.get() + i * flights.count) > S(0.0);
  return object.with_curve(step.at, step.rate, length, [&](const auto& curve, const auto& shape) {
    const Onward<S, std::decay_t<decltype(shape)>> onward{shape, inside};
    return NULLCONE_ISA::first_crossing(curve, onward, limit, S(1e-13) * length);
  });
}

/// Where does a step first meet an object at which rays end?
template <Metric M, class S, std::size_t n>
Look<S> look_closely(const MarchSetting<M>& setting, const StepStates<S, n>& step, const Group<S>& group,
                     const Flights& flights, const State<S>& y1, const S& length) {
  Look<S> out{length, S(0.0), length != length, length != length,
              ending_of(setting, y1, to_state(step.rate[n - 1]))};
  for (std::size_t i = 0; i < setting.count; ++i) {
    if (!setting.objects[i].ends_rays) continue;
    const Search<S> search = first_crossing(setting, step, group, flights, i, length, out.delta);
    out.delta = select(search.met, search.lambda, out.delta);
    out.number = select(search.met, S(static_cast<double>(i)), out.number);
    out.met = out.met | search.met;
    out.lost = out.lost | search.given_up;
  }
  return out;
}

NULLCONE_KERNEL_END
