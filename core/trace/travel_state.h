// What travellers are made of: their states, and how these are integrated. For travel*.cpp alone.
#pragma once

#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/trace/ground.h"

namespace nullcone {

/// The start of a motion by a table of events.
std::unique_ptr<Traveller> set_out_by_table(const Ground& ground, const Motion& motion, ObserverFrame frame,
                                            const std::string& place);

namespace {

using host::Tetrad;
using host::V4;
using host::Vec3;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Vectors of four components, one behind the other. (GCC 12 takes Odeint's arrays for uninitialised.)
using State = std::vector<double>;

inline V4 part(const State& state, std::size_t number) {
  return V4::map([&](std::size_t i) { return state[4 * number + i]; });
}
inline void put(const V4& v, std::size_t number, State& state) {
  for (std::size_t i = 0; i < 4; ++i) state[4 * number + i] = v[i];
}

/// Takes a state from one proper time to another. rate(state, slope, tau) is the system.
template <class System>
void integrate(const System& rate, State& state, double from, double to, const std::string& place) {
  using namespace boost::numeric::odeint;
  if (from == to) return;
  constexpr double kRelative = 1e-13, kAbsolute = 1e-15;
  constexpr int kMostSteps = 20'000;
  int steps = 0;
  const auto count = [&](const State&, double) {
    if (++steps > kMostSteps)
      throw InputError(place, "takes too many steps to follow; expected less proper time");
  };
  try {
    integrate_adaptive(make_controlled(kAbsolute, kRelative, runge_kutta_fehlberg78<State>()), rate, state,
                       from, to, 0.01 * (to - from), count);
  } catch (const odeint_error&) {
    throw InputError(place,
                     "cannot be followed so far: it comes to the edge of the chart, or into a singularity");
  }
  for (const double x : state)
    if (!std::isfinite(x)) throw InputError(place, "cannot be followed so far: it leaves the chart");
}

/// The next of some sorted numbers before or behind tau.
inline double next_of(std::span<const double> sorted, double tau, bool ahead) {
  double out = ahead ? kNever : -kNever;
  for (const double x : sorted)
    if (ahead ? x > tau : x < tau) out = ahead ? std::min(out, x) : std::max(out, x);
  return out;
}

}  // namespace

}  // namespace nullcone
