// Hamilton's equations of a geodesic, from g alone: H = g^mn p_m p_n / 2 with p_m = g_mn k^n.
#pragma once

#include "core/scene/scene.h"
#include "core/trace/metric.h"

NULLCONE_KERNEL_BEGIN

/// d/dlambda of (x, p): dx^m = g^mn p_n, dp_m = (1/2) d_m g_ab k^a k^b with k = dx. The derivatives come from
/// dual numbers, the inverse from a 4 x 4 solve; errors are those of rounding times the condition of g.
template <Metric M, class S>
Phase<S> generic_rhs(const M& metric, const Vec4<S>& x, const Vec4<S>& p) {
  using D = Dual<S, 4>;
  const auto g = metric.g(Vec4<D>::map([&](std::size_t i) { return D::variable(x[i], i); }));
  Matrix4<S> value;
  for (std::size_t i = 0; i < 4; ++i) value[i] = Vec4<S>::map([&](std::size_t j) { return g[i][j].v; });
  const Vec4<S> k = inverse(value) * p;
  Vec4<S> force{};
  for (std::size_t i = 0; i < 4; ++i) {
    force = force + (S(0.5) * k[i] * k[i]) * g[i][i].d;
    for (std::size_t j = i + 1; j < 4; ++j) force = force + (k[i] * k[j]) * g[i][j].d;
  }
  return {k, force};
}

/// The metric's own formula where it has one.
template <Metric M, class S>
NULLCONE_INLINE Phase<S> rhs(const M& metric, const Vec4<S>& x, const Vec4<S>& p) {
  if constexpr (HasRhs<M>)
    return metric.rhs(x, p);
  else
    return generic_rhs(metric, x, p);
}

/// Twice the Hamiltonian, g^mn p_m p_n: 0 along light rays, 1 along worldlines of particles.
template <class S>
S square_of_momentum(const Phase<S>& at, const Phase<S>& rate) {
  return dot(at.p, rate.x);
}

template <Metric M, class S>
S length_scale(const M& metric, const Vec4<S>& x) {
  if constexpr (requires { metric.length_scale(x); })
    return metric.length_scale(x);
  else
    return max(S(1.0), norm(spatial(x)));
}

template <Metric M, class S>
S ending(const M& metric, const Phase<S>& at, const Phase<S>& rate, double precision) {
  if constexpr (HasEnding<M>)
    return metric.ending(at, rate, precision);
  else
    return as_scalar<S>(Ending::none);
}

/// Where a ray that has escaped comes from: a direction of any length, in the static frame at that infinity.
template <Metric M, class S>
Vec3<S> sky_direction(const M& metric, const Phase<S>& at, const Phase<S>& rate, const S& end) {
  if constexpr (requires { metric.sky_direction(at, rate, end); })
    return metric.sky_direction(at, rate, end);
  else
    return spatial(rate.x);
}

/// The frame that an observer's directions and velocity are given in. The normal observers u_m ~ d_m t exist
/// wherever the surfaces of equal t are spacelike, in black holes too.
template <Metric M, class S>
Tetrad<S> observer_tetrad(const M& metric, const Vec4<S>& x, ObserverFrame frame) {
  if (frame == ObserverFrame::at_rest) return static_tetrad(metric, x);
  return gram_schmidt_tetrad(metric, x, inverse(metric.g(x))[0]);
}

template <class M>
constexpr int skies_of() {
  if constexpr (requires { M::skies; })
    return M::skies;
  else
    return 0;
}

template <class M>
double default_lookback(const M& metric) {
  if constexpr (requires { metric.default_lookback(); })
    return metric.default_lookback();
  else
    return __builtin_inf();
}

NULLCONE_KERNEL_END
