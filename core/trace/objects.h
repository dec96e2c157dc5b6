// From a scene's objects to bodies and shapes; which of them can be traced at all.
#pragma once

#include "core/scene/scene.h"
#include "core/trace/any_shape.h"
#include "core/trace/course_ray.h"
#include "core/trace/spacetime.h"

NULLCONE_KERNEL_BEGIN

/// Among static observers. (A member of Placing would be code that instruction sets share.)
inline bool stands_still(const Placing& placing) {
  return placing.worldline.is_static() && !placing.gyroscope_axes && placing.spin == 0;
}

/// Objects whose worldlines may start at any of their events, for nothing about them changes with time.
template <class M>
bool is_timeless(const Placing& placing) {
  return is_stationary<M>() && stands_still(placing);
}

/// The placing with a timeless worldline starting at the observation's time, so that proper times stay small
/// and keep their digits.
template <class M>
Placing from_observation(Placing placing, double observation) {
  if (is_timeless<M>(placing)) placing.worldline.event[0] = observation;
  return placing;
}

/// An object's clock.
struct Clock {
  double at_observation = 0;  ///< proper time since the worldline's event
  double origin = 0;          ///< what is taken off the body's proper times: they count from the observation
};
template <class M>
Clock clock_of(const Placing& placing, double at_observation) {
  return {at_observation, is_timeless<M>(placing) ? 0 : at_observation};
}

/// The same of an object on a course: its proper time is 0 at an event that may be far from the observation.
template <Metric M>
Clock clock_of(const CourseBody<M>& body, double observation) {
  const double now = proper_time_at(body, observation);
  return {now, now};
}

/// Whether every point of the bounding sphere can move with the object.
template <Metric M, class Body>
bool moves_timelike(const M& metric, const Body& body, double ball) {
  return moves_timelike(metric, body, ball, 0.0);
}

/// Where an event is in the object's frame; far away where that does not reach.
template <class Body>
Vec3<double> position_of(const Body& body, const Vec4<double>& event) {
  const Aboard<double> out = aboard(body, event, Vec4<double>{}, body.first_guess(event));
  if constexpr (requires { body.tube; }) {
    const Nearby<double> nearby = body.tube.near(event, 1.0, 1.0);
    if (nearby.clearance > 0 || !is_trusted(nearby, out)) return {{kOutOfReach, 0, 0}};
  }
  return out.X;
}

/// Why an object cannot be traced for an observer at an event of the object's chart; nothing if it can.
template <Metric M, class Body, class S>
const char* fault_of(const M& metric, const Body& body, const S& shape, const Shape& described,
                     const Vec4<double>& observer) {
  if (!moves_timelike(metric, body, shape.bounding_radius()))
    return "is too large: parts of it would have to move faster than light";
  if (!shape.hides(position_of(body, observer))) return nullptr;
  if constexpr (requires { shape.is_open(); })
    if (shape.is_open()) return "holds the observer in its surface";
  return described.dome ? "is a dome, but the observer stands outside it"
                        : "holds the observer; what is seen from inside needs \"dome\": true";
}

/// Whether an event, in the chart of the body, is inside of a shape that is seen from outside.
template <class Body, class S>
bool holds_event(const Body& body, const S& shape, const Vec4<double>& event) {
  return !shape.starts_inside() && shape.holds(position_of(body, event));
}

template <class Object>
Matrix3<double> axes_of(const Object& object) {
  return {Vec3<double>{object.axes[0]}, Vec3<double>{object.axes[1]}, Vec3<double>{object.axes[2]}};
}

/// The rigid body on a geodesic worldline from `start` on.
template <Metric M>
LocalBody<M> local_body(const M& metric, const Vec4<double>& start, const Placing& placing, double ball) {
  LocalFrame<M> frame{metric,
                      start,
                      four_velocity(Vec3<double>{placing.worldline.velocity}),
                      placing.gyroscope_axes,
                      {},
                      axes_of(placing),
                      {placing.spin_axis, placing.spin}};
  if (frame.gyroscope) frame.prepare();
  return {frame, make_orbit(frame, ball)};
}

/// Calls f with the shape in a type of the kernel. A quad is a box without height: one search for both. The
/// shape must outlive what f makes of it.
template <class F>
decltype(auto) with_shape(const Shape& shape, F&& f) {
  if (shape.type == ShapeType::sphere) return f(Sphere{shape.radius, shape.dome});
  if (shape.type == ShapeType::mesh) return f(AnyShape(MeshShape{view_of(*shape.mesh), shape.dome}));
  if (shape.type != ShapeType::solid)
    return f(AnyShape(Box{0.5 * shape.edges[0], 0.5 * shape.edges[1], 0.5 * shape.edges[2]}));
  const Solid& solid = *shape.solid;
  return f(AnyShape(
      SolidShape{solid.primitives.data(), solid.steps.data(), solid.steps.size(), solid.ball, shape.dome}));
}

NULLCONE_KERNEL_END
