// One integrated ray followed to its end, one lane.
#pragma once

#include "core/trace/integrated_geodesic.h"

namespace nullcone::test {
namespace {

struct Followed {
  host::Phase<double> at, rate;
  double end = 0;  ///< an Ending, 0 if the limit was reached first
  double lambda = 0, steps = 0, error = 0;
  bool given_up = false;
};

/// Follows the ray with chart tangent k from the event until the metric ends it, lambda reaches `limit`, or
/// it is given up.
template <class M>
Followed follow(const M& metric, const host::Vec4<double>& event, const host::Vec4<double>& k,
                const Accuracy& accuracy, double limit = 1e300) {
  using namespace host;
  return with_stepper<double>(accuracy.integrator, [&](auto& stepper) {
    using Stepper = std::remove_reference_t<decltype(stepper)>;
    const HamiltonSystem<M> system{metric};
    Flight<double> flight;
    flight.y = to_state(Phase<double>{event, metric.g(event) * k});
    flight.dy = system.rate(flight.y);
    flight.h = first_step<Stepper::kRoots>(metric, flight.y, flight.dy, accuracy.rtol);
    Followed out;
    while (out.end == 0 && !out.given_up && flight.lambda < limit) {
      const auto a =
          attempt(stepper, system, accuracy, flight, next_step(metric, flight, limit - flight.lambda));
      learn(flight, a, true);
      if (a.accepted) {
        flight.y = a.y1, flight.dy = a.dy1;
        flight.lambda += a.h;
        out.end = ending(metric, to_phase(flight.y), to_phase(flight.dy), accuracy.rtol);
      }
      out.given_up = flight.steps >= kStepLimit || !(a.h > 1e-16 * flight.lambda);
    }
    out.at = to_phase(flight.y), out.rate = to_phase(flight.dy);
    out.lambda = flight.lambda, out.steps = flight.steps, out.error = flight.error;
    return out;
  });
}

}  // namespace
}  // namespace nullcone::test
