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
    const HamiltonSystem<M> system{metric};
    auto traveller = traveller_from(stepper, system, accuracy, event, k);
    traveller.ends_in_sky = true;
    traveller.go_to(limit);
    const Flight<double>& flight = traveller.flight;
    return Followed{to_phase(flight.y),
                    to_phase(flight.dy),
                    traveller.end,
                    flight.lambda,
                    flight.steps,
                    flight.error,
                    traveller.status == Status::step_limit};
  });
}

}  // namespace
}  // namespace nullcone::test
