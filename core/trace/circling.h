// Circular motion.
#pragma once

#include "core/trace/travel.h"

namespace nullcone {

/// Circular motion about the chart's z axis: that of a symmetry, with u = (t', J x w, 0).
struct Circling {
  Event start;
  double time_rate, turning;  ///< a unit of proper time

  Event event(double tau) const;
  Event velocity(const Event& x) const { return {time_rate, -turning * x[2], turning * x[1], 0}; }
  Event acceleration(const Ground& ground, const Event& x) const;
};
/// Throws InputError, placed at `place`, where nobody can move so.
Circling circling(const Ground& ground, const Motion& motion, const std::string& place);

}  // namespace nullcone
