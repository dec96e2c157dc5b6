// Rays among objects on courses: far steps by their world tubes, near ones by the curve in their own frame.
#pragma once

#include "core/trace/course_tube.h"
#include "core/trace/crossing.h"
#include "core/trace/curve.h"

NULLCONE_KERNEL_BEGIN

/// A ray at one lambda in the chart, and bounds for the next `valid` of lambda.
template <class S>
struct Underway {
  Vec4<S> event, tangent;
  S speed, pace, valid;  ///< speed: of |dx/dlambda|; pace: of |dt/dlambda|
  Mask<S> straight;
};

/// A closed-form path.
template <class M, class S>
struct PathWay {
  const M* metric;
  decltype(std::declval<M>().path(Vec4<S>{}, Vec4<S>{})) path;

  Underway<S> at(const S& lambda) const {
    const PathPoint<S> P = path.at(lambda);
    Sight<S> bounds;
    bound_at_rest(path, P, bounds);
    const S frequency2 = P.local[0] * P.local[0];
    const S pace = abs(P.tangent[0]) + S(metric->bend_of_time()) * frequency2 * bounds.valid;
    return {P.event, P.tangent, bounds.slope_max, pace, bounds.valid, bounds.bend_max == S(0.0)};
  }
};

/// A step of an integrated ray: the polynomial through its states.
template <class S, std::size_t n>
struct StepWay {
  Curve<S, n> space;
  std::array<S, 2 * n> time;  ///< coefficients, as those of `space`
  S bend_of_time;

  template <class Phases>
  StepWay(const Phases& at, const Phases& rate, const S& length)
      : space(map_of(at), map_of(rate), length), bend_of_time(S(0.0)) {
    static constexpr auto kMatrix = hermite_coefficients<n>();
    for (std::size_t j = 0; j < 2 * n; ++j) {
      time[j] = S(0.0);
      for (std::size_t k = 0; k < n; ++k)
        time[j] = time[j] + S(kMatrix[j][k]) * at[k].x[0] + (S(kMatrix[j][n + k]) * length) * rate[k].x[0];
      bend_of_time = bend_of_time + S(static_cast<double>(j * (j - (j > 0)))) * abs(time[j]);
    }
    bend_of_time = bend_of_time / (length * length);
  }

  Underway<S> at(const S& delta) const {
    const Sight<S> here = space.at(delta);
    const S now = norm(here.slope), valid = min(here.valid, S(0.5) * now / max(space.bend_max, S(1e-300)));
    const S s = delta / space.length;
    S t = time[2 * n - 1], slope = S(static_cast<double>(2 * n - 1)) * t;
    for (std::size_t j = 2 * n - 1; j-- > 0;) t = time[j] + s * t;
    for (std::size_t j = 2 * n - 1; j-- > 1;) slope = S(static_cast<double>(j)) * time[j] + s * slope;
    slope = slope / space.length;
    return {{{t, here.X[0], here.X[1], here.X[2]}},
            {{slope, here.slope[0], here.slope[1], here.slope[2]}},
            now + space.bend_max * valid,
            abs(slope) + bend_of_time * valid,
            valid,
            here.bend_max < S(0.0)};
  }

 private:
  template <class Phases>
  static std::array<Vec3<S>, n> map_of(const Phases& phases) {
    std::array<Vec3<S>, n> out;
    for (std::size_t k = 0; k < n; ++k) out[k] = spatial(phases[k].x);
    return out;
  }
};

/// Whether an object may be met where it seems to be.
template <class S>
Mask<S> is_trusted(const Nearby<S>& nearby, const Aboard<S>& found) {
  const S size = norm(found.X);
  return (size < nearby.reach) &
         (abs(found.tau - nearby.tau) <= S(2.0) * nearby.half_tau + S(4.0) * nearby.radius) &
         (abs(found.late) <= S(1e-6) * (size + nearby.radius));
}

/// How fast a ray moves past an object at its proper time tau: its frequency there.
template <Metric M, class S>
S frequency(const CourseBody<M>& body, const S& tau, const Vec4<S>& tangent) {
  const CoursePoint<S> P = body.line.at(tau);
  Vec4<S> u = P.axes[0];
  if constexpr (HasIsometry<M>) u = static_tetrad(body.metric, P.event).to_chart(u);
  return max(abs(inner(body.metric.g(P.event), u, tangent)), S(1e-300));
}

/// What `advance` (crossing.h) walks along.
template <class S, class Body, class Way>
struct CourseRay {
  const Body* body;
  double ball;  ///< bounding radius of the shape, or a little more
  Way way;

  S clearance(const S& lambda) const {
    S out;
    look(lambda, out);
    return out;
  }

  Sight<S> at(const S& lambda) const {
    Sight<S> out;
    Underway<S> here;
    const Nearby<S> nearby = look(lambda, out.clearance, &here);
    if (all(out.clearance > S(0.0))) return out;
    const Aboard<S> first = aboard(*body, here.event, here.tangent, nearby.tau);
    const auto trusted = is_trusted(nearby, first);
    const S off = max(max(S(body->tube.first) - first.tau, first.tau - S(body->tube.last)), S(0.0));
    Mask<S> there = trusted & (off == S(0.0));
    const S clearance = out.clearance;
    out = curve_from(lambda, here, nearby, first, there);
    // Where its rest frame does not reach, before and behind its time, and about kinks, steps are careful.
    const S past =
        S(0.25) * max(nearby.reach - S(ball), S(0.1 * ball)) / frequency(*body, nearby.tau, here.tangent);
    const S gap = max(norm(first.X) - S(ball), S(0.04 * ball)) / max(norm(first.slope), S(1e-300));
    const S waits = off / max(abs(first.tau_slope), S(1e-300));
    const S careful = select(off > S(0.0), S(0.5) * waits + S(0.01 * ball) / here.speed, S(0.25) * gap);
    const S soon = min(min(past, S(0.2) * nearby.radius / here.speed), here.valid);
    out.clearance =
        select(there | (clearance > S(0.0)), clearance, select(trusted, min(soon, careful), soon));
    return out;
  }

 private:
  /// The ray as the object sees it from `first` on: a curve through a few points, as far as it may be
  /// trusted. Takes away from `there` what cannot be.
  Sight<S> curve_from(const S& lambda, const Underway<S>& here, const Nearby<S>& nearby,
                      const Aboard<S>& first, Mask<S>& there) const {
    const S speed = max(norm(first.slope), S(1e-300)), pace = max(abs(first.tau_slope), S(1e-300));
    S length = S(0.5) * max(norm(first.X) - S(ball), S(ball)) / speed;
    length = min(length, min(S(0.5) * nearby.reach / speed, S(0.5) * nearby.half_tau / pace));
    length = min(length, S(0.25) / max(S(abs(body->spin.rate)) * pace, S(1e-300)));
    length = select(there & (length > S(0.0)), min(length, here.valid), S(ball) / here.speed);
    constexpr std::size_t n = 3;
    std::array<Vec3<S>, n> X = {first.X}, slope = {first.slope};
    for (std::size_t k = 1; k < n; ++k) {
      const S delta = S(static_cast<double>(k) / (n - 1)) * length;
      const Underway<S> next = way.at(lambda + delta);
      const Aboard<S> on = aboard(*body, next.event, next.tangent, first.tau + delta * first.tau_slope);
      X[k] = on.X, slope[k] = on.slope;
      there = there & (norm(on.X) < S(2.0) * (nearby.reach + S(ball))) &
              (abs(on.late) <= S(1e-6) * (norm(on.X) + S(ball)));
    }
    Sight<S> out = Curve<S, n>(X, slope, length).at(S(0.0));
    out.X = first.X, out.slope = first.slope;
    return out;
  }

  /// How far off the object surely is.
  Nearby<S> look(const S& lambda, S& clearance, Underway<S>* where = nullptr) const {
    const Underway<S> here = way.at(lambda);
    if (where) *where = here;
    const Tube& tube = body->tube;
    const Vec3<S> from_tube = spatial(here.event) - convert<S>(tube.centre);
    const S distance = norm(from_tube), gap = distance - S(tube.radius);
    // What recedes on a straight line never comes back.
    const auto gone = here.straight & (gap > S(0.0)) & (dot(from_tube, spatial(here.tangent)) > S(0.0));
    Nearby<S> out{gap / here.speed, S(0.0), S(0.0), S(0.0), S(0.0)};
    const auto outside = gap > S(tube.radius);
    if (!all(outside)) {
      const S by_ball = out.clearance;
      out = tube.near(here.event, here.speed, here.pace);
      out.clearance = select(outside, by_ball, out.clearance);  // whatever the neighbours do
    }
    clearance = select(gone, S(kFar), max(min(out.clearance, here.valid), S(0.0)));
    return out;
  }
};

/// For the search along closed-form paths: an object on a course.
template <Metric M>
struct CoursePlacing {
  CourseBody<M> body;  ///< of round shapes without their spin: nothing is seen of it
  double ball;

  template <class S>
  using Ray = CourseRay<S, CourseBody<M>, PathWay<M, S>>;
  template <class S>
  struct Launch {
    Vec4<S> start;
  };
  template <class S>
  Launch<S> launch(const Vec4<S>& event) const {
    return {event};
  }
  template <class S, class T>
  Mask<S> may_meet(const Launch<T>&, const Vec4<S>& k) const {
    return k[0] == k[0];
  }
  template <class S, class T>
  auto path(const Launch<T>& launch, const Vec4<S>& k) const {
    return body.metric.path(convert<S>(launch.start), k);
  }
  template <class S, class T>
  Ray<S> ray(const Launch<T>& launch, const Vec4<S>& k) const {
    return {&body, ball, {&body.metric, path(launch, k)}};
  }
  template <class S>
  Vec4<S> scene_event(const Vec4<S>& event) const {
    return event;
  }
  template <class S>
  Vec4<S> scene_vector(const Vec4<S>&, const Vec4<S>& v) const {
    return v;
  }
};

NULLCONE_KERNEL_END
