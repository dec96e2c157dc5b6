// The world tube of an object on a course: where in the chart it is, and when.
#pragma once

#include <algorithm>
#include <memory>
#include <numbers>

#include "core/trace/course_body.h"

NULLCONE_KERNEL_BEGIN

/// How far the rest frame at tau may be trusted. An event at X in it grows late at the rate 1 + a.X as the
/// object goes on; where that comes to zero, simultaneity ends.
template <Metric M>
double reach_of(const CourseBody<M>& body, double ball, double tau) {
  using D = Dual<double, 1>;
  const auto rate = [&](const Vec3<double>& X) {
    const Vec4<double> event = body.event(tau, X);
    return body.local(convert<D>(event), D::variable(tau, 0)).first.d[0];
  };
  const double there = rate({});
  const auto a = Vec3<double>::map([&](std::size_t i) {
    Vec3<double> X{};
    X[i] = ball;
    return (rate(X) / there - 1) / ball;
  });
  return min(max(0.5 / norm(a), 1.25 * ball), 0.95 / norm(a));
}

/// From one proper time to another: what a part of the tube must hold is looked up at some points of the
/// object's bounding ball, and a little is added for what lies between them.
template <Metric M>
TubePart tube_part(const CourseBody<M>& body, double ball, double from, double until) {
  constexpr int kTimes = 7, kPoints = 32;
  constexpr double kRoom = 1.1;
  std::array<Vec4<double>, kTimes*(kPoints + 1)> events;
  Vec4<double> least{{kFar, kFar, kFar, kFar}}, most = -least;
  for (int i = 0; i < kTimes; ++i)
    for (int n = 0; n <= kPoints; ++n) {
      const Vec3<double> X = n < kPoints ? ball * golden_point(n, kPoints) : Vec3<double>{};
      const Vec4<double> x = body.event(from + (until - from) * i / (kTimes - 1), X);
      for (std::size_t c = 0; c < 4; ++c) least[c] = min(least[c], x[c]), most[c] = max(most[c], x[c]);
      events[static_cast<std::size_t>(i * (kPoints + 1) + n)] = x;
    }
  const Vec4<double> middle = 0.5 * (least + most);
  TubePart out{spatial(middle),     0, middle[0], kRoom * (most[0] - middle[0]), 0.5 * (from + until),
               0.5 * (until - from)};
  for (const Vec4<double>& x : events) out.radius = max(out.radius, norm(spatial(x) - out.centre));
  out.radius = kRoom * out.radius + 1e-12 * norm(out.centre);
  const double t0 = body.event(from, Vec3<double>{})[0], t1 = body.event(until, Vec3<double>{})[0];
  const double per_t = (until - from) / (t1 - t0);
  if (t1 != t0 && std::isfinite(per_t)) out.per_t = per_t;
  for (const double tau : {from, 0.5 * (from + until), until})
    out.reach = min(out.reach, reach_of(body, ball, tau));
  return out;
}

/// Whether in a part of its way every point of the bounding sphere can move with the object, into its future.
template <Metric M>
bool moves_timelike(const CourseBody<M>& body, const TubePart& part, double ball) {
  return part.reach > ball && moves_timelike(body.metric, body, ball, part.tau);
}
template <Metric M>
bool moves_timelike(const M&, const CourseBody<M>& body, double ball) {
  for (std::size_t i = 0; i < body.tube.count; ++i)
    if (!moves_timelike(body, body.tube.parts[i], ball)) return false;
  return true;
}

/// Of a way that the object cannot go to its end, for it gets too fast for its size, what is about proper
/// time 0.
template <Metric M>
void keep_what_fits(const CourseBody<M>& body, double ball, Tube& tube) {
  std::size_t begin = 0;
  while (begin + 1 < tube.count && tube.parts[begin].tau + tube.parts[begin].half_tau <= 0) ++begin;
  std::size_t end = begin + 1;
  const auto fits = [&](std::size_t i) { return moves_timelike(body, tube.parts[i], ball); };
  while (fits(begin) && begin > 0 && fits(begin - 1)) --begin;
  while (end < tube.count && fits(end)) ++end;
  tube.parts += begin, tube.count = end - begin;
  tube.first = tube.parts[0].tau - tube.parts[0].half_tau;
  tube.last = tube.parts[tube.count - 1].tau + tube.parts[tube.count - 1].half_tau;
}

/// Of motion on a circle: how many parts a turn has.
inline std::size_t parts_of_turn(const Course& course, double around) {
  return static_cast<std::size_t>(std::clamp(std::ceil(2.5 * around / course.pace), 8.0, 256.0));
}

/// Lays the parts of a tube into `room`.
template <Metric M>
Tube lay_parts(const CourseBody<M>& body, double ball, std::unique_ptr<TubePart[]>& room) {
  constexpr std::size_t kMostParts = 256;  // each is looked at by every ray near the tube
  const CourseView& line = body.line;
  const Course& course = line.course();
  Tube out;
  if (!line.is_circle()) {
    const std::size_t legs_a_part = (line.count() + kMostParts - 1) / kMostParts;
    out.count = (line.count() + legs_a_part - 1) / legs_a_part;
    room.reset(new TubePart[out.count]);
    for (std::size_t i = 0; i < out.count; ++i) {
      const std::size_t first = i * legs_a_part, last = std::min(first + legs_a_part, line.count()) - 1;
      room[i] = tube_part(body, ball, line.legs()[first].from, line.legs()[last].until);
    }
  } else if (course.turning != 0) {
    const double around = 2 * std::numbers::pi / std::fabs(course.turning);
    out.count = parts_of_turn(course, around);
    out.period_tau = around, out.period_t = around * course.time_rate;
    room.reset(new TubePart[out.count]);
    const double length = around / static_cast<double>(out.count);
    for (std::size_t i = 0; i < out.count; ++i) {
      const double from = length * static_cast<double>(i);
      room[i] = tube_part(body, ball, from, from + length);
    }
  } else {  // it rests
    out.count = 1;
    room.reset(new TubePart[1]{tube_part(body, ball, 0.0, 0.0)});
    room[0].half_t = room[0].half_tau = kFar, room[0].per_t = 1 / course.time_rate;
  }
  out.parts = room.get();
  if (!line.is_circle()) keep_what_fits(body, ball, out);
  return out;
}

/// A ball about all parts.
inline void enclose(Tube& tube) {
  Vec3<double> least{{kFar, kFar, kFar}}, most = -least;
  for (std::size_t i = 0; i < tube.count; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      least[c] = min(least[c], tube.parts[i].centre[c]);
      most[c] = max(most[c], tube.parts[i].centre[c]);
    }
  tube.centre = 0.5 * (least + most);
  for (std::size_t i = 0; i < tube.count; ++i)
    tube.radius = max(tube.radius, norm(tube.parts[i].centre - tube.centre) + tube.parts[i].radius);
}

/// The body of an object on a course, whose event stands at the time `begin`; it has no tube yet.
template <Metric M>
CourseBody<M> course_body(const M& metric, const Course& course, const Placing& placing) {
  const CourseView line(course, placing.worldline.event[0]);
  const Matrix3<double> axes = {Vec3<double>{placing.axes[0]}, Vec3<double>{placing.axes[1]},
                                Vec3<double>{placing.axes[2]}};
  return {metric, line, axes, line.turn(), {placing.spin_axis, placing.spin}};
}

/// The proper time of an object at about a chart time.
template <Metric M>
double proper_time_at(const CourseBody<M>& body, double t) {
  const Course& course = body.line.course();
  if (body.line.is_circle()) return course.time_rate == 0 ? 0 : (t - body.line.begin()) / course.time_rate;
  const TubePart* nearest = body.tube.parts;
  for (std::size_t i = 1; i < body.tube.count; ++i)
    if (std::fabs(body.tube.parts[i].t - t) < std::fabs(nearest->t - t)) nearest = body.tube.parts + i;
  return nearest->tau;
}

/// A body with its tube, which stands in `room`. (What variants hold must be copied plainly: moves would
/// bring code that instruction sets share.)
template <Metric M>
CourseBody<M> body_on_course(const M& metric, const Course& course, const Placing& placing, double ball,
                             std::unique_ptr<TubePart[]>& room) {
  CourseBody<M> body = course_body(metric, course, placing);
  body.tube = lay_parts(body, ball, room);
  enclose(body.tube);
  return body;
}

/// The largest relative error of lengths within the object: where there is an isometry, none.
template <Metric M>
double distortion_of(const CourseBody<M>& body, double ball) {
  double worst = 0;
  if constexpr (!HasIsometry<M>)
    for (std::size_t part = 0; part < body.tube.count; ++part) {
      const double tau = body.tube.parts[part].tau;
      const auto axes = body.line.at(tau).axes;
      for (int n = 0; n < 32; ++n)
        worst = max(worst, skewness(body.metric.g(body.event(tau, ball * golden_point(n, 32))), axes));
    }
  return 0.5 * worst;  // lengths are roots
}

NULLCONE_KERNEL_END
