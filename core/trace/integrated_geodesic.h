// One integrated geodesic at given affine parameters, for reports: one lane, forwards and backwards.
#pragma once

#include <algorithm>
#include <vector>

#include "core/trace/integrate.h"
#include "core/trace/march.h"

NULLCONE_KERNEL_BEGIN

/// A geodesic under way, one lane.
template <class Stepper, Metric M>
struct Traveller {
  Stepper& stepper;
  HamiltonSystem<M> system;
  Accuracy accuracy;
  Flight<double> flight;
  bool ends_in_sky = false;     ///< else it may be followed as far as one likes towards infinity
  Status status = Status::hit;  ///< changes where it cannot go on
  double end = 0;               ///< an Ending, where it stands

  /// Goes on to lambda = target >= 0.
  void go_to(double target) {
    while (status == Status::hit && flight.lambda < target) {
      const double wish = flight.h, rest = target - flight.lambda;
      const auto a = attempt(stepper, system, accuracy, flight, next_step(system.metric, flight, rest));
      learn(flight, a, true);
      if (a.accepted) {
        flight.y = a.y1, flight.dy = a.dy1;
        flight.lambda = a.h == rest ? target : flight.lambda + a.h;
        if (a.h == rest) flight.h = wish;  // cut short by the target, not by its error
        end = ending(system.metric, to_phase(flight.y), to_phase(flight.dy), accuracy.rtol);
        if (end != 0 && (ends_in_sky || end < as_scalar<double>(Ending::sky))) status = status_of(end);
      }
      const bool stuck = flight.steps >= kStepLimit || !(a.accepted || a.h > 1e-15 * flight.lambda);
      if (stuck && status == Status::hit) status = Status::step_limit;
    }
  }
};

/// At the start of the ray through `event` with chart tangent k.
template <class Stepper, Metric M>
Traveller<Stepper, M> traveller_from(Stepper& stepper, const HamiltonSystem<M>& system,
                                     const Accuracy& accuracy, const Vec4<double>& event,
                                     const Vec4<double>& k) {
  Flight<double> start;
  start.y = to_state(Phase<double>{event, system.metric.g(event) * k});
  start.dy = system.rate(start.y);
  start.h = first_step<Stepper::kRoots>(system.metric, start.y, start.dy, accuracy.rtol);
  return {stepper, system, accuracy, start};
}

/// The geodesic through `event` with chart tangent k, at each affine parameter in the order given. Points
/// that cannot be reached carry the status that says why, and the last state before.
template <Metric M>
std::vector<GeodesicPoint> integrated_geodesic(const M& metric, const Vec4<double>& event,
                                               const Vec4<double>& k, std::span<const double> lambda,
                                               const Accuracy& accuracy) {
  std::vector<GeodesicPoint> out(lambda.size());
  std::vector<std::size_t> order(lambda.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return std::fabs(lambda[i]) < std::fabs(lambda[j]); });
  with_stepper<double>(accuracy.integrator, [&](auto& stepper) {
    const HamiltonSystem<M> system{metric};
    for (const double way : {1.0, -1.0}) {  // into the past, lambda grows along the reversed tangent
      auto traveller = traveller_from(stepper, system, accuracy, event, way * k);
      for (const std::size_t i : order) {
        if (std::signbit(lambda[i]) != (way < 0)) continue;
        traveller.go_to(std::fabs(lambda[i]));
        const Flight<double>& flight = traveller.flight;
        out[i] = {way * flight.lambda, to_phase(flight.y).x.c, (way * to_phase(flight.dy).x).c,
                  traveller.status};
      }
    }
  });
  return out;
}

NULLCONE_KERNEL_END
