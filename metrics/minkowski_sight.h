// Bounds for the search of crossings in flat spacetime: everything is straight, so the first bound is the
// answer.
#pragma once

#include "core/trace/local_frame.h"
#include "core/trace/sight.h"
#include "metrics/minkowski.h"

NULLCONE_KERNEL_BEGIN

/// When a straight ray is within a ball about the origin of its chart.
template <class S>
struct MinkowskiGuard {
  S entry, exit;  ///< in lambda; an empty interval: never

  static Mask<S> may_meet(const Minkowski&, const Vec4<double>& start, const Vec4<S>& k,
                          double bounding_radius) {
    const Vec3<double> X = spatial(start);
    const Vec3<S> direction = spatial(k), moment = cross(convert<S>(X), direction);
    const S ball(bounding_radius * (1 + 1e-9) + 1e-14 * norm(X));
    return dot(moment, moment) <= ball * ball * dot(direction, direction);
  }

  MinkowskiGuard(const Minkowski::Path<S>& path, double bounding_radius) {
    const Vec3<S> X = spatial(path.start), k = spatial(path.k), moment = cross(X, k);
    const S ball = S(bounding_radius * (1 + 1e-12)) + S(4e-15) * norm(X), k2 = dot(k, k);
    const S room = ball * ball * k2 - dot(moment, moment), half = sqrt(max(room, S(0.0)));
    const S along = -dot(X, k);
    entry = select(room > S(0.0), (along - half) / k2, S(kFar));
    exit = select(room > S(0.0), (along + half) / k2, -S(kFar));
  }
  S clearance(const S& lambda) const { return select(lambda > exit, S(kFar), max(entry - lambda, S(0.0))); }
};
template <class S>
MinkowskiGuard<S> make_guard(const Minkowski::Path<S>& path, double ball) {
  return {path, ball};
}

template <class S>
NULLCONE_INLINE void bound_at_rest(const Minkowski::Path<S>& path, const PathPoint<S>&, Sight<S>& sight) {
  sight.slope_min = sight.slope_max = abs(path.k[0]);
  sight.bend_max = S(0.0);
  sight.valid = S(kFar);
}

/// A uniformly moving object: in its frame the ray is straight, and moves at the frequency k.u.
struct MinkowskiOrbit {
  static constexpr double farthest = kFar, stretch = 1, bend = 0;
  Vec4<double> start, u;

  bool fits() const { return true; }
  double largest_ball() const { return farthest; }
  template <class S>
  S proper_time(const Vec4<S>& event) const {
    return boost(convert<S>(u), event - convert<S>(start))[0];
  }

  template <class S>
  struct Ray {
    S frequency;
    S clearance(const S&, S& tau) const {
      tau = S(0.0);  // simultaneity is linear in tau: Newton's method needs no guess
      return S(0.0);
    }
  };
  struct Launch {};
  template <class S>
  Launch launch(const Vec4<S>&) const {
    return {};
  }
  template <class S>
  Ray<S> ray(const Launch&, const Vec4<S>& k) const {
    return {abs(boost(convert<S>(u), k)[0])};
  }
};

inline MinkowskiOrbit make_orbit(const LocalFrame<Minkowski>& frame, double) {
  return {frame.start, frame.u};
}

NULLCONE_KERNEL_END
