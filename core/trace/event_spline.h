// A smooth line through given events.
#pragma once

#include <span>
#include <vector>

#include "core/scene/scene.h"

namespace nullcone {

/// A cubic spline through at least two events, each different from the one before it, in the chart: two
/// continuous derivatives; its slopes at both ends are those of the cubic through the four events there. Its
/// parameter s is the sum of the chords' lengths in the chart (t counts as much as x).
class EventSpline {
 public:
  explicit EventSpline(std::span<const Event> events);

  struct Point {
    Event event, slope, bend;  ///< with the first and second derivative along s
  };
  Point at(double s) const;
  double knot(std::size_t i) const { return knots_[i]; }

 private:
  std::vector<double> knots_;
  std::vector<Event> events_, slopes_;
};

}  // namespace nullcone
