// Rotating black holes in Cartesian Kerr-Schild coordinates (Kerr 1963; docs/physics.md): flat space
// plus a null congruence,
//
//   g_mn = eta_mn - 2 h l_m l_n,  g^mn = eta^mn + 2 h l^m l^n,  h = M r / Sigma,  Sigma = r^2 + a^2 z^2 /
//   r^2,
//
// with (x^2 + y^2) / (r^2 + a^2) + z^2 / r^2 = 1. Spin 0 is Schwarzschild. Regular on the axis, and on the
// half of the horizon that the congruence crosses: the chart "outgoing" where past-directed rays fall in,
// "ingoing" where observers and future-directed light do. The two are each other's mirror in time: t -> -t, a
// -> -a.
#pragma once

#include "core/trace/metric.h"

NULLCONE_KERNEL_BEGIN

struct KerrSchild {
  double mass = 1;
  double spin = 0;   ///< a/M; positive: the hole turns from x to y
  double chart = 0;  ///< 0 outgoing, 1 ingoing

  static constexpr std::string_view name = "kerr_schild";
  static constexpr std::tuple parameters{
      Parameter<KerrSchild>{"mass", &KerrSchild::mass, 1e-6, 1e12},
      Parameter<KerrSchild>{"spin", &KerrSchild::spin, -1, 1},
      Parameter<KerrSchild>{"chart", &KerrSchild::chart, 0, 1, {"outgoing", "ingoing"}}};
  static constexpr int skies = 1;
  static constexpr bool central = true;  // exactly for spin 0

  double a() const { return spin * mass; }
  /// The horizons r_+ (side 1) and r_- (side -1).
  double horizon(double side = 1) const { return mass * (1 + side * std::sqrt((1 - spin) * (1 + spin))); }
  /// +1: the congruence l runs inwards into the future, -1: outwards. The outgoing form is the ingoing one
  /// with l_i -> -l_i and a -> -a.
  double side() const { return chart == 0 ? -1 : 1; }

  /// r^2 from r^4 - d r^2 - a^2 z^2 = 0 and Sigma = 2 r^2 - d. For d < 0, which is r < a and behind the
  /// horizon, d + Sigma would cancel; there, dual numbers lose a^2/r^2 roundings.
  template <class S>
  NULLCONE_INLINE static S radius_squared(const S& d, const S& sigma, const S& az2) {
    const S sum = S(0.5) * (d + sigma);
    if constexpr (requires { select(d < S(0.0), sum, sum); }) {
      if (any(d < S(0.0))) return select(d < S(0.0), S(2.0) * az2 / (sigma - d), sum);
    }
    return sum;
  }

  /// What all formulas begin with, and l_m = (1, l).
  template <class S>
  struct Congruence {
    S r, sigma, r2_a2;
    Vec3<S> l;
  };
  template <class S>
  Congruence<S> congruence(const Vec4<S>& X) const;

  template <class S>
  Matrix4<S> g(const Vec4<S>& x) const {
    const auto [r, sigma, r2_a2, l] = congruence(x);
    const S two_h = S(2 * mass) * r / sigma;
    const Vec4<S> l4 = {{S(1.0), l[0], l[1], l[2]}};
    Matrix4<S> out;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i; j < 4; ++j)
        out[j][i] = out[i][j] = S(i != j ? 0.0 : i == 0 ? 1.0 : -1.0) - two_h * (l4[i] * l4[j]);
    return out;
  }

  /// Hamilton's equations of H = (p_t^2 - p^2)/2 + h K^2 with K = l^m p_m.
  template <class S>
  Phase<S> rhs(const Vec4<S>& X, const Vec4<S>& p) const;

  template <class S>
  S length_scale(const Vec4<S>& x) const {
    return max(S(mass), norm(spatial(x)));
  }

  template <class S>
  S ending(const Phase<S>& at, const Phase<S>& rate, double precision) const;
  template <class S>
  Vec3<S> sky_direction(const Phase<S>& at, const Phase<S>& rate, const S& end) const;

  /// Energy, angular momentum about the axis, and Carter's constant Q (1968) in the form
  /// Q = (z p_x - x p_z)^2 + (z p_y - y p_z)^2 + a^2 [(p_x^2 + p_y^2 + m^2 - E^2) cos^2 - p_z^2 sin^2],
  /// in which no large terms cancel far out and nothing is singular on the axis; spin 0: Q = L_x^2 + L_y^2.
  template <class S>
  auto conserved(const Vec4<S>& x, const Vec4<S>& k) const {
    const auto [r, sigma, r2_a2, l] = congruence(x);
    const Vec4<S> p = g(x) * k;
    const S lx = x[2] * p[3] - x[3] * p[2], ly = x[3] * p[1] - x[1] * p[3];
    const S over_r = S(1.0) / r, cosine = x[3] * over_r, sine2 = (x[1] * x[1] + x[2] * x[2]) / r2_a2;
    const S square = dot(p, k);
    const S Q = lx * lx + ly * ly +
                S(a() * a()) * (cosine * cosine * (p[1] * p[1] + p[2] * p[2] + square - p[0] * p[0]) -
                                sine2 * p[3] * p[3]);
    using C = std::pair<std::string_view, S>;
    return std::array<C, 3>{C{"E", p[0]}, C{"L_z", x[1] * p[2] - x[2] * p[1]}, C{"Q", Q}};
  }
};

template <class S>
KerrSchild::Congruence<S> KerrSchild::congruence(const Vec4<S>& X) const {
  const S &x = X[1], &y = X[2], &z = X[3];
  const double a1 = side() * a();
  const S d = x * x + y * y + z * z - S(a1 * a1);
  const S sigma = sqrt(d * d + S(4 * a1 * a1) * (z * z));
  const S r2 = radius_squared(d, sigma, S(a1 * a1) * (z * z)), r = sqrt(r2), r2_a2 = r2 + S(a1 * a1);
  const S over = S(side()) / r2_a2;
  return {r, sigma, r2_a2, {{over * (r * x + S(a1) * y), over * (r * y - S(a1) * x), S(side()) * z / r}}};
}

// With P = (r (x p_x + y p_y) + A (y p_x - x p_y)) / (r^2 + a^2) + z p_z / r (A = side a) the momentum along
// the congruence, K = p_t - side P, and
//   dp = -(dh K^2 + 2 h K dK),  dh = (M/Sigma) [dr (1 - 4 r^2/Sigma) + 2 r X/Sigma],
//   dr = r X/Sigma + (0, 0, a^2 z/(r Sigma)),
// where Sigma^2 = d^2 + 4 a^2 z^2, d = rho^2 - a^2 = 2 r^2 - Sigma. One division serves all.
template <class S>
NULLCONE_INLINE Phase<S> KerrSchild::rhs(const Vec4<S>& X, const Vec4<S>& p) const {
  const double a2 = a() * a();
  const S A(side() * a()), flip(side());
  const S &x = X[1], &y = X[2], &z = X[3];
  const S z2 = z * z, d = (x * x + y * y) + (z2 - S(a2));
  const S sigma = sqrt(d * d + S(4 * a2) * z2);
  const S r2 = radius_squared(d, sigma, S(a2) * z2);
  const S r = sqrt(r2), r2_a2 = r2 + S(a2);
  const S r_sigma = r * sigma, shared = S(1.0) / (r_sigma * r2_a2);
  const S over_r2_a2 = r_sigma * shared, over_sigma = r * r2_a2 * shared, over_r = sigma * r2_a2 * shared;

  const S qx = flip * p[1], qy = flip * p[2], qz = flip * p[3];
  const S along = x * qx + y * qy, around = y * qx - x * qy;
  const S in_plane = (r * along + A * around) * over_r2_a2, z_over_r = z * over_r;
  const S K = p[0] - (in_plane + z_over_r * qz);
  const S r_over_sigma = r * over_sigma, h = S(mass) * r_over_sigma;
  // dP/dr where x, y, z are held, and what multiplies dr in the bracket of dp = -(M K/Sigma) [...].
  const S P_r = (along - S(2.0) * r * in_plane) * over_r2_a2 - z_over_r * qz * over_r;
  const S by_r = K * (S(1.0) - S(4.0) * r * r_over_sigma) - S(2.0) * r * P_r;
  const S force = -(S(mass) * K * over_sigma), twice_K = S(2.0) * K;
  const S radial = r_over_sigma * (by_r + twice_K);
  const S axial = over_sigma * (by_r * r2_a2 * over_r + twice_K * r);
  const S turn = S(-2.0) * r * over_r2_a2;

  const S along_l = S(2.0) * h * K, spread = flip * along_l * over_r2_a2;
  Phase<S> out;
  out.x = {{p[0] + along_l, -p[1] - spread * (r * x + A * y), -p[2] - spread * (r * y - A * x),
            -p[3] - flip * along_l * z_over_r}};
  out.p = {{S(0.0), force * (radial * x + turn * (r * qx - A * qy)),
            force * (radial * y + turn * (r * qy + A * qx)), force * (axial * z - S(2.0) * qz)}};
  return out;
}

// Horizons. With w = Sigma dr/dlambda, Delta = r^2 - 2 M r + a^2 and N = (r^2 + a^2) E - a L, Kerr's radial
// equation factorises: Delta K = N + side w and w^2 = N^2 - Delta C (C >= 0: Carter). So K stays finite at
// the horizon for rays that arrive with side w N < 0: these cross, and in the outgoing chart past-directed
// rays do, and end as captured within. The others keep side w -> N and creep along the horizon while K grows
// as 1/Delta, without end: they end where Delta < r_+^2/1000, if they approach it and can no longer turn. (A
// turning point is where w = 0; on the way to one, w < 0.87 N so close to the horizon, even for a = M.)
// Behind the inner horizon, and close to r = 0, nothing has a sky.
//
// Sky. sky_direction has integrated most of the bending that is still to come. With beta = b/r, b the impact
// parameter, it leaves less than (M/r^2) [0.2 M beta^4 + (a^2/r)(beta + 2M/r)] (measured:
// tests/metric_test.cpp); the bare direction would still turn by M beta/r, and dX/dlambda by 4 M beta/r more
// in this chart. Only for rays that are fast enough never to return: all of light, and particles beyond 0.7
// of its speed.
template <class S>
S KerrSchild::ending(const Phase<S>& at, const Phase<S>& rate, double precision) const {
  // Rays that are neither within (1.1 r_+^2 + a^2)^(1/2) of the origin nor beyond 30 M go on.
  const S R2 = dot(spatial(at.x), spatial(at.x));
  const double inner = 1.1 * horizon() * horizon() + a() * a(), outer = 900 * mass * mass;
  if (!any((R2 > S(outer)) | (R2 < S(inner)))) return as_scalar<S>(Ending::none);
  const auto [r, sigma, r2_a2, l] = congruence(at.x);
  const Vec3<S> X = spatial(at.x), V = spatial(rate.x);
  const S outwards = dot(X, V), zero(0.0);
  const S w = r * outwards + S(a() * a()) * X[2] * V[2] / r;
  const S K = at.p[0] - dot(l, spatial(at.p)), side_w = S(side()) * w;
  const S delta = r2_a2 - S(2 * mass) * r, N = delta * K - side_w;
  const double near = 1e-3 * horizon() * horizon();
  const auto creeping =
      (abs(delta) < S(near)) & (delta * (r - S(mass)) * w < zero) & (side_w * N > S(0.9) * N * N);
  const S over_r = S(1.0) / r, beta = norm(cross(X, V)) * over_r / norm(V), beta2 = beta * beta;
  const S to_come = S(mass) * over_r * over_r *
                    (S(0.2 * mass) * beta2 * beta2 + S(a() * a()) * over_r * (beta + S(2 * mass) * over_r));
  const S light = dot(at.p, rate.x) - S(0.5) * at.p[0] * at.p[0];
  S out = as_scalar<S>(Ending::none);
  out = select((r > S(30 * mass)) & (outwards > zero) & (to_come < S(0.1 * precision)) & (light < zero),
               as_scalar<S>(Ending::sky), out);
  const S horizon_or_inner =
      select(r > S(mass), as_scalar<S>(Ending::captured), as_scalar<S>(Ending::left_chart));
  out = select(creeping, horizon_or_inner, out);
  out = select(r < S(1e-3 * mass), as_scalar<S>(Ending::left_chart), out);
  return side() < 0 ? select(r < S(horizon()), as_scalar<S>(Ending::captured), out) : out;
}

// Light that escapes the way the congruence runs hardly meets it: K falls as (b/r)^2, and -p is the
// direction. Light that escapes against it is first carried over to the other chart, where it runs the other
// way: with psi = arg(x + iy),
//   psi' = psi + side w(r),  w = (2 a M/r^2) (1 + 4M/3r + (2M^2 - a^2)/r^2 + ...),
//   p_r' = p_r + side (4 M r/Delta) (p_t + a p_psi/(r^2 + a^2)).
// What is left, to first order in M and in a M, is the gradient of h K^2 along the straight line X + s n,
// with c = cos(X, n), tau = sign p_t, B = X - (X.n) n:
//   (M/r^2) B c (1 - c)/(1 + c) - (a M tau/r^2) (n x e_z) (1 - c)/(1 + c)
//   + (2 a M tau/r^4) B ((X x n).e_z) [(2 + c)/(1 + c)^2 - 1].
template <class S>
Vec3<S> KerrSchild::sky_direction(const Phase<S>& at, const Phase<S>&, const S&) const {
  const auto [r, sigma, r2_a2, l] = congruence(at.x);
  const S zero(0.0), one(1.0), over_r = one / r, side_here(side());
  const S &x = at.x[1], &y = at.x[2], &z = at.x[3], &E = at.p[0];
  const auto against = E * side_here > zero;
  const S delta = r2_a2 - S(2 * mass) * r, p_psi = x * at.p[2] - y * at.p[1];
  const S push =
      select(against, side_here * S(4 * mass) * r * (E + S(a()) * p_psi / r2_a2) / (delta * sigma), zero);
  const S turn = select(against,
                        side_here * S(2 * a() * mass) * over_r * over_r *
                            (one + over_r * (S(4.0 / 3 * mass) + S(2 * mass * mass - a() * a()) * over_r)),
                        zero);
  const Vec3<S> by_r = {{r * x, r * y, r2_a2 * z * over_r}};  // Sigma dr
  const auto turned = [&](const Vec3<S>& v) {
    const auto [sine, cosine] = sincos(turn);
    return Vec3<S>{{cosine * v[0] - sine * v[1], sine * v[0] + cosine * v[1], v[2]}};
  };
  const Vec3<S> n = normalised(turned(-(spatial(at.p) + push * by_r))), X = turned(spatial(at.x));

  const S over_r2 = one / dot(X, X), along = dot(X, n), c = along * sqrt(over_r2), over_c = one / (one + c);
  const S dragging = S(a() * mass) * over_r2 * select(E < zero, S(-1.0), one), tilt = (one - c) * over_c;
  const S by_spin =
      S(2.0) * dragging * over_r2 * (X[0] * n[1] - X[1] * n[0]) * ((S(2.0) + c) * over_c * over_c - one);
  return n + (S(mass) * over_r2 * c * tilt + by_spin) * (X - along * n) -
         (dragging * tilt) * Vec3<S>{{n[1], -n[0], zero}};
}

NULLCONE_KERNEL_END
