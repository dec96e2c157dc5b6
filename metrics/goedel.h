// The Gödel universe in pseudo-Cartesian coordinates (docs/physics.md; Kajari et al. 2004,
// Grave & Buser 2008). Rotating dust, homogeneous; circles of light; an optical horizon at r = 2a for an
// observer on the axis. All formulas are regular at r = 0, for n_z -> ±1 and for a -> infinity.
//
// Points of the plane are written q = (x + iy)/2a with p = sqrt(1 + |q|^2); in H^2, of curvature radius a,
// the distance from the axis is 2a asinh |q|.
#pragma once

#include "core/trace/metric.h"

NULLCONE_KERNEL_BEGIN

struct Goedel {
  double a = 1;  ///< length scale: dust rotates with 1/(sqrt2 a), the horizon stands at 2a

  static constexpr std::string_view name = "goedel";
  static constexpr std::tuple parameters{Parameter<Goedel>{"a", &Goedel::a, 1e-6, 1e15}};
  static constexpr int skies = 0;
  static constexpr double kSqrt2 = 1.4142135623730950488;

  /// Rays repeat themselves in space after 2 pi a at most; two turns show every image twice.
  double default_lookback() const { return 12.566370614359172 * a; }
  /// dt/dtau of the geodesic with 4-velocity u = gamma (1, beta), averaged over its revolutions.
  double mean_rate(const Vec4<double>& u) const {
    const double beta_x = u[1] / u[0], beta_y = u[2] / u[0];
    return u[0] * (2 * std::sqrt(1 - 0.5 * (beta_x * beta_x + beta_y * beta_y)) - 1);
  }

  /// dt/dlambda = 1 - A(v), the energy being 1. At the distance 2a chi from the axis, and at the angle alpha
  /// with the outward direction, A(v) = sqrt2 s sin(alpha) tanh(chi) with s = |v| <= 1. As v turns by
  /// -sqrt2/a, d/dlambda A(v) = -sqrt2 s cos(alpha) tanh(chi) (sqrt2 + s sin(alpha) tanh(chi))/a.
  double bend_of_time() const { return (2 + kSqrt2) / a; }

  /// ds^2 = (dt + A)^2 - h - dz^2, components in (t, x, y, z).
  template <class S>
  Matrix4<S> g(const Vec4<S>& X) const {
    const S k(1 / (kSqrt2 * a)), b(1 / (4 * a * a)), o(0.0), one(1.0);
    const S &x = X[1], &y = X[2], over_N = one / (S(4 * a * a) + x * x + y * y);
    const S tx = -(k * y), ty = k * x, xy = x * y * (over_N - b);
    const S xx = x * x * over_N + b * y * y - one, yy = y * y * over_N + b * x * x - one;
    return {{{{one, tx, ty, o}}, {{tx, xx, xy, o}}, {{ty, xy, yy, o}}, {{o, o, o, -one}}}};
  }

  /// Hamilton's equations, from the inverse that completing the square gives: with pi = p - A p_t in the
  /// plane, s = X.pi, c = X x pi, b = 1/4a^2 and N = 4a^2 + X^2, 2H = p_t^2 - pi^2 - b s^2 + c^2/N - p_z^2.
  template <class S>
  NULLCONE_INLINE Phase<S> rhs(const Vec4<S>& X, const Vec4<S>& p) const {
    const S k(1 / (kSqrt2 * a)), b(1 / (4 * a * a));
    const S &x = X[1], &y = X[2], over_N = S(1.0) / (S(4 * a * a) + x * x + y * y), k_E = k * p[0];
    const S px = p[1] + k_E * y, py = p[2] - k_E * x;  // pi
    const S bs = b * (x * px + y * py), c = (x * py - y * px) * over_N;
    const S dx = -(px + bs * x + c * y), dy = c * x - (py + bs * y), c2 = c * c;
    return {{{p[0] + k * (y * dx - x * dy), dx, dy, -p[3]}},
            {{S(0.0), bs * px - c * py + c2 * x + k_E * dy, bs * py + c * px + c2 * y - k_E * dx, S(0.0)}}};
  }

  /// Errors count against the horizon's radius, or the distance where that is larger.
  template <class S>
  S length_scale(const Vec4<S>& x) const {
    return max(S(2 * a), norm(spatial(x)));
  }

  /// The dust and its axes: angles in (e1, e2) are Euclidean angles in the Poincaré disc.
  template <class S>
  Tetrad<S> static_tetrad(const Vec4<S>& x) const {
    Tetrad<S> out;
    out.e[0][0] = out.e[3][3] = S(1.0);
    out.e[1] = in_plane(x, {S(1.0), S(0.0)});
    out.e[2] = in_plane(x, {S(0.0), S(1.0)});
    return out;
  }

  /// Null and timelike geodesics alike, by the affine parameter for which the tangent at the start is k.
  template <class S>
  struct Path {
    const Goedel* metric;
    S t0, z0, p0;
    Complex<S> q0, nu;                  // start; in-plane local direction over k0
    S k0, n_z, kappa, one_minus_kappa;  // kappa = sqrt(1 - s^2/2)

    /// P and Q of SU(1,1) without their common phase: |P|^2 - |Q|^2 = 1, q = Q conj(P)/|P|.
    struct Turned {
      Complex<S> P, Q;
      S s, c, mu;
    };
    Turned turned(const S& lambda) const;
    PathPoint<S> at(const S& lambda) const;
    /// e^{i angle} by which the direction of motion has turned against the static tetrad.
    Complex<S> turn(const S& lambda) const {
      const Turned m = turned(lambda);
      const Complex<S> square = conj(m.P) * conj(m.P);
      return (S(1.0) / norm2(m.P)) * square;
    }
  };
  template <class S>
  Path<S> path(const Vec4<S>& start, const Vec4<S>& k) const;

  /// The isometry that carries the event P to the origin, and its inverse. Static worldlines go to static
  /// ones.
  template <class S>
  Vec4<S> to_origin(const Vec4<S>& P, const Vec4<S>& x) const;
  template <class S>
  Vec4<S> from_origin(const Vec4<S>& P, const Vec4<S>& x) const;
  /// e^{i angle}: the rotation of static-tetrad components about e3 under to_origin(P, .) at x.
  template <class S>
  Complex<S> turn(const Vec4<S>& P, const Vec4<S>& x) const;

  /// Number of caustics passed after the affine length `lambda` >= 0 of a null ray with local frequency 1:
  /// zeros of det D (eq. 5.1): psi = k pi, and one more in each (k pi + pi/2, k pi + pi).
  template <class S>
  S caustics(const S& lambda, const S& n_z) const;

  /// Constants of motion of the geodesic with chart tangent k at x: E, L, p_z and the charges of K4 and K5.
  template <class S>
  auto conserved(const Vec4<S>& x, const Vec4<S>& k) const;

  /// Chart components of the in-plane unit vectors e1 v.re + e2 v.im at x.
  template <class S>
  Vec4<S> in_plane(const Vec4<S>& X, const Complex<S>& v) const {
    const S &x = X[1], &y = X[2];
    const S over_4a2(1 / (4 * a * a));
    const S over_p = S(1.0) / sqrt(S(1.0) + over_4a2 * (x * x + y * y));
    const S along = over_4a2 * (x * v.re + y * v.im);
    const S vx = over_p * (v.re + along * x), vy = over_p * (v.im + along * y);
    return {{S(-1 / (kSqrt2 * a)) * (x * vy - y * vx), vx, vy, S(0.0)}};
  }
  template <class S>
  Complex<S> to_q(const Vec4<S>& x) const {
    const S scale(1 / (2 * a));
    return {scale * x[1], scale * x[2]};
  }
};

template <class S>
S cosh_of(const Complex<S>& q) {
  return sqrt(S(1.0) + norm2(q));
}

template <class S>
Goedel::Path<S> Goedel::path(const Vec4<S>& start, const Vec4<S>& k) const {
  const S scale = S(1.0) / k[0];
  const Complex<S> q0 = to_q(start), nu = scale * Complex<S>{k[1], k[2]};
  const S half_s2 = S(0.5) * norm2(nu);
  const S kappa = sqrt(S(1.0) - half_s2);
  return {this, start[0], start[3],     cosh_of(q0), q0,
          nu,   k[0],     scale * k[3], kappa,       half_s2 / (S(1.0) + kappa)};
}

template <class S>
NULLCONE_INLINE typename Goedel::Path<S>::Turned Goedel::Path<S>::turned(const S& lambda) const {
  const S mu = k0 * lambda;
  const auto [s, c] = sincos(S(1 / (kSqrt2 * metric->a)) * kappa * mu);
  const Complex<S> A = {c, -(s / kappa)};
  const Complex<S> B = (s / (S(kSqrt2) * kappa)) * nu;
  return {p0 * A + conj(q0) * B, p0 * B + q0 * A, s, c, mu};
}

template <class S>
NULLCONE_INLINE PathPoint<S> Goedel::Path<S>::at(const S& lambda) const {
  const Turned m = turned(lambda);
  const S P2 = norm2(m.P);
  const Complex<S> q = (S(1.0) / sqrt(P2)) * (m.Q * conj(m.P));
  // t - t0 = (2 kappa - 1) mu + 2 sqrt2 a arg(conj(P) e^{-i psi}): the argument stays within (-pi, pi), and
  // no two large terms cancel.
  const S real = p0 * (m.c * m.c + m.s * m.s / kappa), imag = p0 * (m.s * m.c * one_minus_kappa / kappa);
  const Complex<S> lift = (m.s / (S(kSqrt2) * kappa)) * (q0 * conj(nu) * Complex<S>{m.c, -m.s});
  const S t = t0 + (S(1.0) - S(2.0) * one_minus_kappa) * m.mu +
              S(2 * kSqrt2 * metric->a) * atan2(imag + lift.im, real + lift.re);
  const S two_a(2 * metric->a);
  const Vec4<S> event = {{t, two_a * q.re, two_a * q.im, z0 + n_z * m.mu}};
  // The direction turns by 2 arg conj(P).
  const Complex<S> direction = (k0 / P2) * (nu * (conj(m.P) * conj(m.P)));
  const Vec4<S> local = {{k0, direction.re, direction.im, k0 * n_z}};
  Vec4<S> tangent = metric->in_plane(event, direction);
  tangent[0] = tangent[0] + k0;
  tangent[3] = local[3];
  return {event, tangent, local};
}

template <class S>
Vec4<S> Goedel::to_origin(const Vec4<S>& P, const Vec4<S>& x) const {
  const Complex<S> q0 = to_q(P), q = to_q(x), dq = to_q(x - P);
  const S p0 = cosh_of(q0), p = cosh_of(q);
  const Complex<S> middle = q + q0;
  const Complex<S> qh = p0 * dq - ((dq.re * middle.re + dq.im * middle.im) / (p + p0)) * q0;  // = p0 q - q0 p
  // ph = p0 p - conj(q0) q
  const Complex<S> product = conj(q0) * q, ph = {p0 * p - product.re, -product.im};
  const Complex<S> w = (S(2 * a) / sqrt(norm2(ph))) * (qh * conj(ph));
  return {{x[0] - P[0] - S(2 * kSqrt2 * a) * atan2(ph.im, ph.re), w.re, w.im, x[3] - P[3]}};
}

template <class S>
Vec4<S> Goedel::from_origin(const Vec4<S>& P, const Vec4<S>& x) const {
  const Complex<S> q0 = to_q(P), q = to_q(x);
  const S p0 = cosh_of(q0), p = cosh_of(q);
  const Complex<S> qh = p0 * q + p * q0, product = conj(q0) * q, ph = {p0 * p + product.re, product.im};
  const Complex<S> w = (S(2 * a) / sqrt(norm2(ph))) * (qh * conj(ph));
  return {{x[0] + P[0] - S(2 * kSqrt2 * a) * atan2(ph.im, ph.re), w.re, w.im, x[3] + P[3]}};
}

template <class S>
Complex<S> Goedel::turn(const Vec4<S>& P, const Vec4<S>& x) const {
  const Complex<S> q0 = to_q(P), q = to_q(x), product = conj(q0) * q;
  const Complex<S> conj_ph = {cosh_of(q0) * cosh_of(q) - product.re, product.im};
  return (S(1.0) / norm2(conj_ph)) * (conj_ph * conj_ph);
}

template <class S>
S Goedel::caustics(const S& lambda, const S& n_z) const {
  constexpr double kPi = 3.14159265358979323846;
  const S n2 = n_z * n_z, psi = sqrt(S(1.0) + n2) * lambda * S(0.5 / a);
  const S lobe = floor(S(1 / kPi) * psi);
  const auto [s, c] = sincos(psi - lobe * S(kPi));
  const S bracket = (S(1.0) - n2) * psi * c + S(2.0) * n2 * s;  // positive at the start of every lobe
  return S(2.0) * lobe + select(bracket < S(0.0), S(1.0), S(0.0));
}

template <class S>
auto Goedel::conserved(const Vec4<S>& x, const Vec4<S>& k) const {
  const S b(1 / (4 * a * a)), o(0.0), one(1.0), scale(a);
  const S r2 = x[1] * x[1] + x[2] * x[2], over_s1 = one / sqrt(one + b * r2);
  const Vec4<S> lower = g(x) * k;
  const S xy = scale * b * x[1] * x[2];
  const Vec4<S> K2 = {{o, -x[2], x[1], o}};
  const Vec4<S> K4 =
      over_s1 * Vec4<S>{{S(1 / kSqrt2) * x[1], -xy, scale * (one + b * r2 + b * x[1] * x[1]), o}};
  const Vec4<S> K5 =
      over_s1 * Vec4<S>{{S(1 / kSqrt2) * x[2], -(scale * (one + b * r2 + b * x[2] * x[2])), xy, o}};
  using C = std::pair<std::string_view, S>;
  return std::array<C, 5>{C{"E", lower[0]}, C{"L", dot(lower, K2)}, C{"p_z", lower[3]},
                          C{"K4", dot(lower, K4)}, C{"K5", dot(lower, K5)}};
}

NULLCONE_KERNEL_END
