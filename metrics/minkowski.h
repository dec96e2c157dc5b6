// Flat spacetime.
#pragma once

#include <limits>

#include "core/trace/metric.h"

NULLCONE_KERNEL_BEGIN

struct Minkowski {
  static constexpr std::string_view name = "minkowski";
  static constexpr std::tuple<> parameters{};
  static constexpr int skies = 1;

  double default_lookback() const { return std::numeric_limits<double>::infinity(); }
  /// dt/dtau of the worldline with 4-velocity u.
  double mean_rate(const Vec4<double>& u) const { return u[0]; }
  double bend_of_time() const { return 0; }

  template <class S>
  Matrix4<S> g(const Vec4<S>&) const {
    Matrix4<S> out;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) out[i][j] = S(i != j ? 0.0 : i == 0 ? 1.0 : -1.0);
    return out;
  }

  template <class S>
  NULLCONE_INLINE Phase<S> rhs(const Vec4<S>&, const Vec4<S>& p) const {
    return {{{p[0], -p[1], -p[2], -p[3]}}, {}};
  }

  /// Directions never change, so a ray that moves outwards has its sky. Space has no scale of its own to say
  /// from where on: a million units is far for a scene, and cheap to reach where no step is ever refused.
  template <class S>
  S ending(const Phase<S>& at, const Phase<S>& rate, double) const {
    const Vec3<S> X = spatial(at.x);
    const auto escaped = (dot(X, spatial(rate.x)) > S(0.0)) & (dot(X, X) > S(1e12));
    return select(escaped, as_scalar<S>(Ending::sky), as_scalar<S>(Ending::none));
  }

  template <class S>
  Tetrad<S> static_tetrad(const Vec4<S>&) const {
    Tetrad<S> out;
    for (std::size_t i = 0; i < 4; ++i) out.e[i][i] = S(1.0);
    return out;
  }

  /// Straight lines; `start` and `k` as for every metric: event, components in the static tetrad.
  template <class S>
  struct Path {
    Vec4<S> start, k;
    PathPoint<S> at(const S& lambda) const { return {start + lambda * k, k, k}; }
    /// How far the Killing-carried frame has turned against the static tetrad: not at all.
    Complex<S> turn(const S&) const { return {S(1.0), S(0.0)}; }
  };
  template <class S>
  Path<S> path(const Vec4<S>& start, const Vec4<S>& k) const {
    return {start, k};
  }

  template <class S>
  Vec4<S> to_origin(const Vec4<S>& P, const Vec4<S>& x) const {
    return x - P;
  }
  template <class S>
  Vec4<S> from_origin(const Vec4<S>& P, const Vec4<S>& x) const {
    return x + P;
  }
  /// The rotation of static-tetrad components about e3 under to_origin(P, .) at x.
  template <class S>
  Complex<S> turn(const Vec4<S>&, const Vec4<S>&) const {
    return {S(1.0), S(0.0)};
  }

  /// Number of caustics passed after the affine length `lambda` with local frequency 1.
  template <class S>
  S caustics(const S&, const S&) const {
    return S(0.0);
  }

  /// Constants of motion of the geodesic with chart tangent k at x: energy and the momenta.
  template <class S>
  auto conserved(const Vec4<S>&, const Vec4<S>& k) const {
    using C = std::pair<std::string_view, S>;
    return std::array<C, 4>{C{"E", k[0]}, C{"p_x", -k[1]}, C{"p_y", -k[2]}, C{"p_z", -k[3]}};
  }
};

NULLCONE_KERNEL_END
