// Bounds for the search of crossings in flat spacetime: everything is straight, so the first bound is the
// answer.
#pragma once

#include "core/trace/local_frame.h"
#include "core/trace/sight.h"
#include "metrics/minkowski.h"

NULLCONE_KERNEL_BEGIN

template <class S>
void bound_at_rest(const Minkowski::Path<S>& path, const PathPoint<S>&, double, bool, Sight<S>& sight) {
  sight.slope_min = sight.slope_max = abs(path.k[0]);
  sight.bend_max = S(0.0);
  sight.valid = S(kFar);
  sight.clearance = S(0.0);
}

/// A uniformly moving object: in its frame the ray is straight, and moves at the frequency k.u.
struct MinkowskiOrbit {
  static constexpr double farthest = kFar, stretch = 1, bend = 0;
  Vec4<double> start, u;

  bool fits() const { return true; }
  double largest_ball() const { return farthest; }
  double proper_time(const Vec4<double>& event) const { return boost(u, event - start)[0]; }

  template <class S>
  struct Ray {
    S frequency;
    S clearance(const S&, S& tau) const {
      tau = S(0.0);  // simultaneity is linear in tau: Newton's method needs no guess
      return S(0.0);
    }
  };
  template <class S>
  Ray<S> ray(const Vec4<double>&, const Vec4<S>& k) const {
    return {abs(boost(convert<S>(u), k)[0])};
  }
};

inline MinkowskiOrbit make_orbit(const LocalFrame<Minkowski>& frame, double) {
  return {frame.start, frame.u};
}

NULLCONE_KERNEL_END
