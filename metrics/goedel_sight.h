// Bounds for the search of crossings in the Gödel universe: how long a ray surely stays clear of an object at
// rest, and how fast and how crookedly it can move as seen from one.
#pragma once

#include <numbers>

#include "core/trace/sight.h"
#include "metrics/goedel.h"

NULLCONE_KERNEL_BEGIN

/// When a ray is near the axis of its chart. In the plane every geodesic is a circle of H^2, and
/// |q|^2 = C - A cos 2(psi - psi_m): so the distance from the axis is below a given one in one window of
/// every period pi of psi, or never. In z the ray moves uniformly.
template <class S>
struct GoedelGuard {
  S psi_m, half_width, psi_rate;  ///< half_width < 0: never
  S z0, z_rate, ball;

  /// A first sieve without divisions and roots: false for rays whose least distance from the axis is surely
  /// greater than the ball, or that move away from it along z. Least |q|^2 <= u^2 means
  /// Im(conj(q0) w)^2 <= 2 C u^2 - u^4, here times (kappa k0)^2; or C <= u^2: rays that run along the axis
  /// may never be farther from it than u.
  static Mask<S> may_meet(const Goedel& metric, const Vec4<double>& start, const Vec4<S>& k,
                          double bounding_radius) {
    const Complex<double> q0 = metric.to_q(start);
    const double q2 = norm2(q0), p0 = cosh_of(q0) / Goedel::kSqrt2,
                 ball = padded(metric, q2, bounding_radius);
    const double u = 0.5 / metric.a * ball, u2 = u * u;
    const S kappa2 = k[0] * k[0] - S(0.5) * (k[1] * k[1] + k[2] * k[2]);
    const Complex<S> w = {S(p0) * k[1] + S(q0.im) * k[0], S(p0) * k[2] - S(q0.re) * k[0]};
    const S moment = S(q0.re) * w.im - S(q0.im) * w.re, w2 = norm2(w);
    const S twice_C = S(q2) * kappa2 + w2;
    const auto in_plane = (moment * moment <= twice_C * S(u2) - kappa2 * S(u2 * u2) + S(1e-14 * q2) * w2) |
                          (twice_C <= kappa2 * S(2 * u2));
    if (std::fabs(start[3]) <= ball) return in_plane;
    return in_plane & (S(start[3]) * k[3] < S(0.0));
  }
  /// The bounding radius with a little room for rounding at |q|^2 = q2.
  template <class T>
  static T padded(const Goedel& metric, const T& q2, double bounding_radius) {
    return T(bounding_radius * (1 + 1e-12)) + T(1e-13 * metric.a) * (T(1.0) + q2);
  }

  GoedelGuard(const Goedel::Path<S>& path, double bounding_radius) {
    const double a = path.metric->a;
    // Q = q0 cos psi + w sin psi (docs/physics.md), so |Q|^2 = C + D cos 2 psi + E sin 2 psi.
    const Complex<S> scaled = S(1 / Goedel::kSqrt2) * (path.p0 * path.nu);
    const Complex<S> w = (S(1.0) / path.kappa) * Complex<S>{scaled.re + path.q0.im, scaled.im - path.q0.re};
    const Complex<S> product = conj(path.q0) * w;
    const S q2 = norm2(path.q0), w2 = norm2(w);
    const S C = S(0.5) * (q2 + w2), D = S(0.5) * (q2 - w2), A = sqrt(D * D + product.re * product.re);
    // Least |Q|^2 without cancellation: C^2 - A^2 = Im(conj(q0) w)^2. A little room covers rounding.
    const S least = product.im * product.im / (C + A + S(1e-300));
    ball = padded(*path.metric, q2, bounding_radius);
    psi_rate = S(1 / (Goedel::kSqrt2 * a)) * path.kappa * abs(path.k0);
    z0 = path.z0;
    z_rate = path.n_z * path.k0;
    const S u = S(0.5 / a) * ball, room = u * u - least;
    const auto may_meet = (room > S(0.0)) & ((abs(z0) <= ball) | (z0 * z_rate < S(0.0)));
    half_width = S(-1.0);
    psi_m = S(0.0);
    if (!any(may_meet)) return;
    const S sine = min(sqrt(max(room, S(0.0)) / max(S(2.0) * A, S(1e-300))), S(1.0));
    half_width = select(may_meet, atan2(sine, sqrt((S(1.0) - sine) * (S(1.0) + sine))), half_width);
    psi_m = S(0.5) * (atan2(product.re, D) + S(std::numbers::pi));
    psi_m = select(path.k0 < S(0.0), -psi_m, psi_m);  // psi runs backwards along rays into the past
  }

  /// Affine length for which the ray surely stays farther than `ball` from the origin of its chart; 0 within
  /// the windows.
  S clearance(const S& lambda) const {
    constexpr double kPi = std::numbers::pi;
    const S psi = psi_rate * lambda - psi_m, x = psi - S(kPi) * floor(S(1 / kPi) * psi + S(0.5));
    const S to_window =
        select(x < -half_width, -half_width - x, select(x > half_width, S(kPi) - half_width - x, S(0.0)));
    const S by_plane = select(half_width < S(0.0), S(kFar), to_window / psi_rate);
    const S z = z0 + z_rate * lambda, approach = select(z < S(0.0), z_rate, -z_rate), gap = abs(z) - ball;
    const S by_z = select(gap > S(0.0), select(approach > S(0.0), gap / approach, S(kFar)), S(0.0));
    return max(by_plane, by_z);
  }
};

template <class S>
GoedelGuard<S> make_guard(const Goedel::Path<S>& path, double ball) {
  return {path, ball};
}

/// Bounds for objects at rest in the chart for the next `sight.valid` of lambda, all from the geodesic
/// equation (1.4): in-plane chart speeds lie between s/p and s p; |X''| <= s (sqrt2 p + 3/2 s u)/a for local
/// frequency 1.
template <class S>
NULLCONE_INLINE void bound_at_rest(const Goedel::Path<S>& path, const PathPoint<S>& P, Sight<S>& sight) {
  const double a = path.metric->a;
  const S frequency = abs(path.k0), s = sqrt(norm2(path.nu));
  const S u = sqrt(norm2(path.metric->to_q(P.event))), p = sqrt(S(1.0) + u * u);
  // Within the next a/2 of local length the ray stays within u_far: sinh(rho + 1/4).
  const S u_far = S(1.03142) * u + S(0.25262) * p, p_far = sqrt(S(1.0) + u_far * u_far);
  sight.valid = S(0.5 * a) / frequency;
  sight.slope_max = frequency * p_far;
  sight.slope_min = frequency / p_far;
  sight.bend_max = frequency * frequency * s * (S(Goedel::kSqrt2) * p_far + S(1.5) * s * u_far) * S(1 / a);
}

NULLCONE_KERNEL_END
