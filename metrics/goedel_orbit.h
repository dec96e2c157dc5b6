// Freely falling objects in the Gödel universe: a bound on how long a ray stays clear of them.
#pragma once

#include <numbers>

#include "core/trace/local_frame.h"
#include "metrics/goedel_sight.h"

NULLCONE_KERNEL_BEGIN

/// The orbit of a freely falling object as its own axis sees it: in the chart about the centre C of its base
/// circle it moves as phi = phi_c + Omega (t - t_c), z = z_c + v (t - t_c) at constant rho, and its body is a
/// fixed region of the co-moving cylindrical coordinates (rho, phi - Omega t, z - v t). A box and a ball (of
/// H^2 x R) around that region tell how long a ray stays clear.
struct GoedelOrbit {
  Goedel metric;
  Vec4<double> centre;  ///< C: an event on the axis of the base circle
  double t_c = 0, phi_c = 0, z_c = 0, omega = 0, v = 0, dt_dtau = 1;
  Complex<double> q_c{};                ///< the object's place in the co-moving plane, on the real axis
  std::array<double, 3> low{}, high{};  ///< the box: u = sinh rho, |phi|, z
  double cosh_low = 1;                  ///< cosh rho at the inner edge of the box
  double reach = 0;                     ///< radius of the ball about the object's place
  double close = 0;                     ///< distance at which the search goes over to the rest frame
  double ball = 0;                      ///< bounding radius in the rest frame
  double farthest = 0;                  ///< |X| is less than this at distances below `close`
  double stretch = 1;  ///< |dX/dlambda| lies within [1/stretch, stretch] times the frequency k.K
  double bend = 0;     ///< |d2X/dlambda2| over the frequency squared

  GoedelOrbit() = default;
  GoedelOrbit(const LocalFrame<Goedel>& frame, double bounding_radius);

  /// Around the worldline the events that are simultaneous in the rest frame tilt against each other; at
  /// sqrt2 gamma^2 beta |X|/a = 1 an event has no unique proper time any more, and the local frame ends.
  bool fits() const { return tilt * farthest <= 0.9 && farthest <= 2 * metric.a; }
  /// About the largest bounding radius that would fit.
  double largest_ball() const { return ball / farthest * std::fmin(0.9 / tilt, 2 * metric.a); }
  /// At which the object is nearest to an event in its neighbourhood, roughly.
  template <class S>
  S proper_time(const Vec4<S>& event) const {
    return (metric.to_origin(convert<S>(centre), event)[0] - S(t_c)) * S(1 / dt_dtau);
  }
  double tilt = 0;  ///< sqrt2 gamma^2 beta / a

  template <class S>
  struct Ray {
    const GoedelOrbit* orbit;
    Goedel::Path<S> path;  ///< in the chart about C
    S frequency;           ///< |k.K|, K the Killing vector that is the object's 4-velocity on its worldline

    /// Distance from the object's place in the chart about it, in co-moving coordinates; `stretch` is its
    /// greatest rate a unit of distance in H^2 x R, from here inwards.
    S distance(const Complex<S>& q, const S& z, S& stretch) const;
    /// Affine length for which the body is surely not met, 0 close to it; and the object's proper time then.
    S clearance(const S& lambda, S& tau) const;
  };
  /// What all rays from one event have in common: the event in the chart about C, and how the tetrad turns.
  template <class S>
  struct Launch {
    Vec4<S> start;
    Complex<S> turn;
  };
  template <class S>
  Launch<S> launch(const Vec4<S>& event) const;
  /// The ray with past-directed tangent k (static tetrad) at the event.
  template <class S, class T>
  Ray<S> ray(const Launch<T>& launch, const Vec4<S>& k) const;

 private:
  void find_box(const LocalFrame<Goedel>& frame);
  void find_farthest(const LocalFrame<Goedel>& frame);
  struct Comoving {
    double u, phi, z;
    Complex<double> q;
  };
  Comoving comoving(const Vec4<double>& world) const;
};

template <class S>
GoedelOrbit::Launch<S> GoedelOrbit::launch(const Vec4<S>& event) const {
  const auto at = convert<S>(centre);
  return {metric.to_origin(at, event), metric.turn(at, event)};
}

template <class S, class T>
GoedelOrbit::Ray<S> GoedelOrbit::ray(const Launch<T>& launch, const Vec4<S>& k) const {
  const Vec4<S> x = convert<S>(launch.start), local = turned_about_e3(launch.turn, k);
  // k.K = dt/dtau (E + Omega L + v p_z), with the tangent's covariant components at the start.
  const Vec4<S> lower = convert<S>(metric.g(launch.start)) * static_tetrad(metric, x).to_chart(local);
  const S L = x[1] * lower[2] - x[2] * lower[1];
  return {this, metric.path(x, local), abs(S(dt_dtau) * (lower[0] + S(omega) * L + S(v) * lower[3]))};
}

template <class S>
S GoedelOrbit::Ray<S>::clearance(const S& lambda, S& tau) const {
  const GoedelOrbit& o = *orbit;
  const double a = o.metric.a;
  const S k = abs(path.k0), s = max(k * sqrt(norm2(path.nu)), S(1e-290));
  const PathPoint<S> P = path.at(lambda);
  const S elapsed = P.event[0] - S(o.t_c);
  tau = elapsed * S(1 / o.dt_dtau);

  // Co-moving coordinates, and how far outside the box each of them stands.
  const Complex<S> q = o.metric.to_q(P.event);
  const auto angle = sincos(S(o.omega) * elapsed + S(o.phi_c));
  const Complex<S> turned = q * Complex<S>{angle.cos, -angle.sin};
  const S z = P.event[3] - S(o.z_c) - S(o.v) * elapsed, u = sqrt(norm2(q)), p = sqrt(S(1.0) + u * u);
  const S over_u = S(1.0) / max(u, S(1e-290)), sine = abs(turned.im) * over_u, cosine = turned.re * over_u;
  const S phi = select(cosine > S(0.0), sine, S(0.5 * std::numbers::pi) - cosine);  // at most |phi|
  const auto outside = [](const S& x, double low, double high) {
    return max(max(S(low) - x, x - S(high)), S(0.0));
  };
  const S gap_u = outside(u, o.low[0], o.high[0]), gap_z = outside(z, o.low[2], o.high[2]);
  const S gap_phi = max(phi - S(o.high[1]), S(0.0));

  // u = sinh rho, and rho moves at most with s/2a; z with its own speed minus the object's; phi and the
  // distance are bounded within a window of rho: |dt/dlambda| <= k + sqrt2 s. tanh rho = u/p is at most rho.
  const S tanh = u / p, window = min(S(0.125), S(0.5) * tanh);
  const S nearest = tanh - window, steepest = min(tanh + window, S(1.0));
  const S phi_speed = s * (S(0.5 / a) / nearest + S(Goedel::kSqrt2 * o.omega) * steepest) + S(o.omega) * k;
  const S dz = -P.tangent[3], approach = select(z < S(0.5 * (o.low[2] + o.high[2])), -dz, dz);
  const S time_speed = k + S(Goedel::kSqrt2) * s, z_speed = approach + S(std::fabs(o.v)) * time_speed;
  const S round = S(2 * a) * (S(1.00783) * u + S(0.12533) * p) * (S(1.00783) * p + S(0.12533) * u);
  S stretch;
  const S gap = distance(turned, z, stretch) - S(o.reach);
  const S speed = stretch * (k + time_speed * (S(o.omega) * round + S(std::fabs(o.v))));
  const S within = S(2 * a) * window / s;
  const S by_u = S(2 * a) * gap_u / (s * max(p, S(o.cosh_low)));
  const S by_z = select(z_speed > S(0.0), gap_z / z_speed, select(gap_z > S(0.0), S(kFar), S(0.0)));
  const S by_phi = min(gap_phi / phi_speed, within), by_distance = min(gap / speed, S(0.25 * a) / s);
  return select(gap <= S(o.close - o.reach), S(0.0), max(max(by_u, by_z), max(by_phi, by_distance)));
}

/// By (3.2), so that nothing cancels for a -> infinity.
template <class S>
S GoedelOrbit::Ray<S>::distance(const Complex<S>& q, const S& z, S& stretch) const {
  const Complex<S> q0 = {S(orbit->q_c.re), S(orbit->q_c.im)}, dq = q - q0, middle = q + q0;
  const S p0 = cosh_of(q0), p = cosh_of(q);
  const Complex<S> qh = p0 * dq - ((dq.re * middle.re + dq.im * middle.im) / (p + p0)) * q0;
  const S u2 = norm2(qh);
  stretch = sqrt(S(1.0) + u2);
  return sqrt(S(4 * orbit->metric.a * orbit->metric.a) * u2 + z * z);
}

inline GoedelOrbit::GoedelOrbit(const LocalFrame<Goedel>& frame, double bounding_radius)
    : metric(frame.metric), ball(bounding_radius) {
  // The base circle: hyperbolic radius artanh(s/sqrt2), centre to the left of the motion (docs/physics.md).
  const auto path = frame.worldline<double>();
  const double a = metric.a, kappa = path.kappa, to_centre = a / std::sqrt(kappa * (1 + kappa));
  centre =
      metric.from_origin(frame.start, Vec4<double>{{0, -to_centre * path.nu.im, to_centre * path.nu.re, 0}});
  const Vec4<double> P = metric.to_origin(centre, frame.start);
  t_c = P[0];
  z_c = P[3];
  phi_c = atan2(P[2], P[1]);
  q_c = {std::sqrt(norm2(metric.to_q(P))), 0};
  omega = Goedel::kSqrt2 * kappa / (a * (2 * kappa - 1));
  dt_dtau = frame.u[0] * (2 * kappa - 1);
  v = frame.u[3] / dt_dtau;
  const double gamma = frame.u[0], beta = norm(spatial(frame.u)) / gamma;
  tilt = Goedel::kSqrt2 * gamma * gamma * beta / a;
  find_box(frame);
  find_farthest(frame);
  // Upper bounds of what 4,000 rays each at speeds up to 0.99 showed (tests/orbit_bounds_test.cpp).
  const double size = farthest / a, lean = tilt * farthest;
  stretch = std::exp(0.7 * size + 0.65 * lean);
  bend = (1.3 * tilt * a * std::exp(1.8 * lean) + 1.2 * size * std::exp(1.2 * size)) / a;
}

inline GoedelOrbit::Comoving GoedelOrbit::comoving(const Vec4<double>& world) const {
  const Vec4<double> x = metric.to_origin(centre, world);
  const double elapsed = x[0] - t_c;
  const auto [s, c] = sincos(omega * elapsed + phi_c);
  const Complex<double> q = metric.to_q(x) * Complex<double>{c, -s};
  return {std::sqrt(norm2(q)), std::fabs(atan2(q.im, q.re)), x[3] - z_c - v * elapsed, q};
}

/// Box and ball from 2,000 points of the bounding sphere; 3 % of room cover what lies between them, and
/// rounding in the chart about C is allowed for.
inline void GoedelOrbit::find_box(const LocalFrame<Goedel>& frame) {
  const double a = metric.a, u_c = q_c.re;
  const Ray<double> measure{this, {}, 0};
  low = {kFar, 0, kFar}, high = {-kFar, 0, -kFar};
  constexpr int kPoints = 2000;
  for (int n = 0; n < kPoints; ++n) {
    const Comoving y = comoving(frame.event(0.0, ball * golden_point(n, kPoints)));
    double stretched = 1;
    low[0] = std::fmin(low[0], y.u), high[0] = std::fmax(high[0], y.u);
    low[2] = std::fmin(low[2], y.z), high[2] = std::fmax(high[2], y.z);
    high[1] = std::fmax(high[1], y.phi);
    reach = std::fmax(reach, measure.distance(y.q, y.z, stretched));
  }
  if (high[1] > 1.5 || 2 * a * u_c < 1.3 * ball)
    low[0] = -1, high[1] = 4;  // the body may reach round the axis
  const Complex<double> q = metric.to_q(centre);
  const double rounding = 1e-14 * a * norm2(Complex<double>{cosh_of(q), std::sqrt(norm2(q))});
  const std::array<double, 3> room = {rounding / a, rounding / (a * std::fmax(u_c, 1e-3)), rounding};
  for (std::size_t i = 0; i < 3; ++i) {
    const double more = 0.015 * (high[i] - low[i]) + room[i];
    low[i] -= more, high[i] += more;
  }
  cosh_low = std::sqrt(1 + low[0] * low[0]);
  reach = 1.03 * reach + rounding;
  close = 1.3 * reach;
}

/// The greatest rest-frame distance |X| at co-moving distance `close`.
inline void GoedelOrbit::find_farthest(const LocalFrame<Goedel>& frame) {
  constexpr int kPoints = 200;
  const Vec4<double> place = {{t_c, 2 * metric.a * q_c.re, 0, 0}};
  for (int n = 0; n < kPoints; ++n) {
    const Vec3<double> direction = golden_point(n, kPoints);
    const Vec4<double> near =
        metric.from_origin(place, Vec4<double>{{0, close * direction[0], close * direction[1], 0}});
    const auto [s, c] = sincos(phi_c);
    const Vec4<double> x =
        metric.from_origin(centre, Vec4<double>{{t_c, c * near[1] - s * near[2], s * near[1] + c * near[2],
                                                 z_c + close * direction[2]}});
    const double distance = norm(spatial(frame.rest(x, nullcone::NULLCONE_ISA::proper_time(frame, x, 0.0))));
    farthest = distance <= kFar ? std::fmax(farthest, 1.1 * distance) : kFar;
  }
}

inline GoedelOrbit make_orbit(const LocalFrame<Goedel>& frame, double ball) { return {frame, ball}; }

NULLCONE_KERNEL_END
