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
  Status status = Status::hit;  ///< changes where it cannot go on

  /// Goes on to lambda = target, away from 0.
  void go_to(double target) {
    while (status == Status::hit && flight.lambda != target) {
      const double rest = target - flight.lambda;
      const bool last = std::fabs(rest) <= std::fabs(flight.h);
      const double h = last ? rest : std::copysign(flight.h, rest);
      const auto a = attempt(stepper, system, accuracy, flight, h);
      flight.steps += 1;
      if (!last || !a.accepted) flight.h = std::fabs(h) * a.factor;
      if (a.accepted) {
        flight.y = a.y1, flight.dy = a.dy1;
        flight.lambda = last ? target : flight.lambda + h;
        flight.error += a.error;
        const double end = ending(system.metric, to_phase(flight.y), to_phase(flight.dy), accuracy.rtol);
        // Rays may be followed as far as one likes towards infinity, but not into a horizon.
        if (end != 0 && end < as_scalar<double>(Ending::sky)) status = status_of(end);
      } else if (flight.steps >= kStepLimit || !(std::fabs(h) > 1e-15 * std::fabs(flight.lambda))) {
        status = Status::step_limit;
      }
    }
  }
};

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
    using Stepper = std::remove_reference_t<decltype(stepper)>;
    const HamiltonSystem<M> system{metric};
    Flight<double> start;
    start.y = to_state(Phase<double>{event, metric.g(event) * k});
    start.dy = system.rate(start.y);
    start.h = first_step<Stepper::kOrder>(metric, start.y, start.dy, accuracy.rtol);
    Traveller<Stepper, M> past{stepper, system, accuracy, start}, future = past;
    for (const std::size_t i : order) {
      auto& traveller = lambda[i] < 0 ? past : future;
      traveller.go_to(lambda[i]);
      out[i] = {traveller.flight.lambda, to_phase(traveller.flight.y).x.c, to_phase(traveller.flight.dy).x.c,
                traveller.status};
    }
  });
  return out;
}

NULLCONE_KERNEL_END
