// The way of an object that is on no geodesic of a closed form: made before rays are traced, looked up by
// kernels.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace nullcone {

class Spacetime;

/// A part of a course: event, 4-velocity and axes as sums of Chebyshev polynomials of the proper time.
struct CourseLeg {
  static constexpr std::size_t kNumbers = 20, kTerms = 10;
  using Terms = std::array<std::array<double, kNumbers>, kTerms>;

  double from = 0, until = 0;
  Terms value{}, rate{};  ///< rate: of the derivatives along proper time
};

/// Where something is at each proper time, and how its axes stand. Times count from that of the event at
/// which its proper time is 0. Vectors stand in the static tetrad where an isometry carries the object along
/// (MetricDescription::isometric), elsewhere in the chart.
struct Course {
  std::vector<CourseLeg> legs;  ///< by proper time, without gaps; none: circular motion, as follows

  Event start{};
  std::array<Event, 4> axes{};  ///< 4-velocity and axes at the start
  double time_rate = 1;         ///< dt/dtau
  double turning = 0;           ///< dphi/dtau about the chart's z axis, which carries all vectors along
  /// Against the vectors that are carried along, gyroscopes (or axes that keep their directions) turn about
  /// this axis (components along `axes`), by so many radians a unit of proper time.
  Triple turn_axis = {0, 0, 1};
  double turn_rate = 0;
  double pace = 0;  ///< proper time in which a 4-velocity may change by its size: 1/|acceleration|
};

/// Chart times between which an object can be seen.
struct TimeSpan {
  double least = 0, most = 0;
};

/// The course of a motion, as far as it is within the time span. Polynomials agree with what they stand for
/// to some 1e-13. Throws InputError, placed at `place`, where the motion is none of an observer.
std::shared_ptr<const Course> make_course(const Spacetime& spacetime, std::span<const double> parameters,
                                          const Motion& motion, bool gyroscope, const TimeSpan& seen,
                                          const std::string& place);

/// Gives a course to the objects that need one; the observer must have been settled.
void settle_objects(const Spacetime& spacetime, std::span<const double> parameters, Scene& scene,
                    const std::string& place);

}  // namespace nullcone
