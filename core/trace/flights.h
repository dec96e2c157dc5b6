// Integrated rays under way, as columns, and packs of them.
#pragma once

#include "core/trace/band.h"
#include "core/trace/integrate.h"

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
  std::array<double*, 3> axis{};  ///< about which turns are counted (turns.h)
  double* turns;                  ///< so far, where the ray stands
  std::unique_ptr<std::uint32_t[]> object, list, waiting;
  std::unique_ptr<Status[]> status;  ///< other than `hit` from the start: not followed
  std::unique_ptr<double[]>
      inside;  ///< object by object, 1 for rays that start inside of it; null: none does
  std::size_t listed = 0, waits = 0;

  explicit Flights(std::size_t rays)
      : count(rays),
        memory(new double[27 * rays]()),
        object(new std::uint32_t[rays]()),
        list(new std::uint32_t[rays]),
        waiting(new std::uint32_t[rays]),
        status(new Status[rays]()) {
    double* next = memory.get();
    const auto column = [&] { return std::exchange(next, next + rays); };
    for (std::size_t i = 0; i < 8; ++i) y[i] = column(), y1[i] = column();
    lambda = column(), h = column(), growth = column(), steps = column(), error = column(), length = column(),
    delta = column(), turns = column();
    for (double*& component : axis) component = column();
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

template <class S>
Flight<S> load_flight(const Group<S>& group, const Flights& flights) {
  Flight<S> out;
  out.y = load(group, flights.y);
  out.lambda = group.load(flights.lambda);
  out.h = group.load(flights.h);
  out.growth = group.load(flights.growth);
  out.steps = group.load(flights.steps);
  out.error = group.load(flights.error);
  return out;
}

NULLCONE_KERNEL_END
