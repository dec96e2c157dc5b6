// One geodesic, and what can be told of its points.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/trace/spacetime.h"

namespace nullcone {

/// Through which event it passes, with which tangent, and how it is followed.
struct Ray {
  const Spacetime* spacetime;
  std::vector<double> parameters;
  Event event, k;                    ///< k: components in the tetrad of `frame`
  std::optional<Accuracy> accuracy;  ///< integrated with it; without it, by the closed form
  ObserverFrame frame = ObserverFrame::at_rest;

  std::vector<GeodesicPoint> at(std::span<const double> lambda) const;
  GeodesicPoint at(double lambda) const { return at({&lambda, 1})[0]; }
  std::vector<NamedValue> conserved(const GeodesicPoint& point) const;
  /// The square g(k, k) of the tangent at a point.
  double square(const GeodesicPoint& point) const;
};

/// "ok", or how the ray ended before it came so far.
std::string status_word(const GeodesicPoint& point);

/// Components of a chart vector in the static tetrad at an event; NaN where there is none.
Event in_static_tetrad(const Spacetime& spacetime, std::span<const double> parameters, const Event& event,
                       const Event& vector);

/// Throws InputError where no observer is at rest in the chart, so that directions mean nothing.
void check_tetrad(const Spacetime& spacetime, std::span<const double> parameters, const Event& event,
                  const std::string& place);

/// `count` (>= 2) numbers, evenly spaced from `from` to `to`, both included.
std::vector<double> evenly_spaced(double from, double to, int count);

}  // namespace nullcone
