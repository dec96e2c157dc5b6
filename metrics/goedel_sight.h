// Bounds for the search of crossings in the Gödel universe: how long a ray surely stays clear of an object,
// and how fast and how crookedly it can move as seen from one.
#pragma once

#include "core/trace/sight.h"
#include "metrics/goedel.h"

NULLCONE_KERNEL_BEGIN

/// asinh |q|: half the distance from the axis in units of a.
template <class S>
S asinh_of(const Complex<S>& q) {
  const S u2 = norm2(q), u = sqrt(u2);
  return log(u + sqrt(S(1.0) + u2));
}

/// Bounds for objects at rest in the chart (see at_rest() below), all from the geodesic equation (1.4):
/// in-plane chart speeds lie between s/p and s p; |X''| <= s (sqrt2 p + 3/2 s u)/a for local frequency 1.
template <class S>
void bound_at_rest(const Goedel::Path<S>& path, const PathPoint<S>& P, double ball, bool centred,
                   Sight<S>& sight) {
  const double a = path.metric->a;
  const S frequency = abs(path.k0), s = sqrt(norm2(path.nu));
  const Complex<S> q = path.metric->to_q(P.event);
  const S u = sqrt(norm2(q)), p = sqrt(S(1.0) + u * u);
  // Within the next a/2 of local length the ray stays within u_far: sinh(rho + 1/4).
  const S u_far = S(1.03142) * u + S(0.25262) * p, p_far = sqrt(S(1.0) + u_far * u_far);
  sight.valid = S(0.5 * a) / frequency;
  sight.slope_max = frequency * p_far;
  sight.slope_min = frequency / p_far;
  sight.bend_max = frequency * frequency * s * (S(Goedel::kSqrt2) * p_far + S(1.5) * s * u_far) * S(1 / a);

  // In z the ray moves uniformly; in the plane at most with local speed 1, so distances in H^2 x R are safe
  // steps.
  const S distance_z = abs(sight.X[2]);
  const S approach = select(sight.X[2] < S(0.0), sight.slope[2], -sight.slope[2]);
  const S gap_z = distance_z - S(ball);
  const S by_z = select(gap_z > S(0.0), select(approach > S(0.0), gap_z / approach, S(kFar)), S(0.0));
  const S hyperbolic = S(2 * a) * log(u + p);
  const S distance = centred ? sqrt(hyperbolic * hyperbolic + distance_z * distance_z) : norm(sight.X);
  const S by_distance =
      centred ? (distance - S(ball)) / frequency : min((distance - S(ball)) / sight.slope_max, sight.valid);
  const auto far = (distance > S(1.5 * ball)) | (gap_z > S(0.5 * ball));
  sight.clearance = select(far, max(max(by_z, by_distance), S(0.0)), S(0.0));
}

NULLCONE_KERNEL_END
