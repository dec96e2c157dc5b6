// What a spacetime is, and what follows from g alone.
//
// Required of a metric M (a plain struct of double parameters; member functions are templates on the scalar):
//   M::name, M::parameters          name, and a tuple of Parameter
//   g(x) -> Matrix4                 covariant components, signature (+,-,-,-)
// Optional, detected by concepts, and only makes things faster or richer:
//   skies                           how many infinities hold a sky (default none)
//   central                         true if directions from the chart's origin are those of a central
//                                   symmetry: then integrated rays know their order (turns.h)
//   stationary                      false if g depends on t. Else the scene's times are shifted so that the
//                                   observation is at t = 0, and differences of time keep all digits
//   rhs(x, p) -> Phase              Hamilton's equations (else dual numbers and a solve, hamilton.h)
//   ending(at, rate, precision)     where a ray ends: an Ending as S (else it goes on); precision: relative
//   error
//                                   that the direction to the sky may have
//   sky_direction(at, rate, ending) where the ray comes from, for Ending::sky (else its chart direction)
//   length_scale(x)                 against which errors of position are measured (else max(1, |x|))
//   default_lookback()              in lambda (else infinite)
//   conserved(x, k)                 named constants of motion of the geodesic with chart tangent k
//   static_tetrad(x) -> Tetrad      orthonormal frame of the natural observer (else Gram-Schmidt)
//   path(x, k) -> Path              closed-form geodesics: Path::at(lambda) -> PathPoint
//   bend_of_time()                  with it: no |d2t/dlambda2| of rays is greater, local frequency 1 at their
//   start to_origin(P, x), from_origin(P, x), turn(P, x)   the isometry that carries P to the origin, and
//   back
#pragma once

#include <concepts>
#include <string_view>
#include <tuple>

#include "core/base/dual.h"

NULLCONE_KERNEL_BEGIN

/// A number that a metric depends on, as scenes name it.
template <class M>
struct Parameter {
  std::string_view name;
  double M::*member;
  double least, most;  ///< range, inclusive
  /// Where not empty, scenes give one of these words; the member holds its number.
  std::array<std::string_view, 2> words{};
};

/// A point of phase space, or its derivative along lambda: coordinates x^mu and momenta p_mu.
template <class S>
struct Phase {
  Vec4<S> x, p;
};

/// How a ray may end by itself; metrics hand these out as numbers of the scalar, so that packs can carry
/// them.
enum class Ending { none = 0, captured = 1, left_chart = 2, sky = 3, second_sky = 4 };
template <class S>
S as_scalar(Ending ending) {
  return S(static_cast<double>(ending));
}

/// e[0] is the 4-velocity of the observer, e[1..3] the spatial axes; chart components.
template <class S>
struct Tetrad {
  std::array<Vec4<S>, 4> e;

  /// From components in this tetrad to chart components.
  Vec4<S> to_chart(const Vec4<S>& local) const {
    return local[0] * e[0] + local[1] * e[1] + local[2] * e[2] + local[3] * e[3];
  }
};

/// Components in a tetrad of a vector that is given by its chart components.
template <class S>
Vec4<S> local_components(const Matrix4<S>& g, const Tetrad<S>& tetrad, const Vec4<S>& v) {
  const Vec4<S> lower = g * v;
  return Vec4<S>::map([&](std::size_t a) {
    const S along = dot(lower, tetrad.e[a]);
    return a == 0 ? along : -along;
  });
}

/// A point of a path: chart coordinates, chart components of the tangent, and the tangent's components in the
/// static tetrad there.
template <class S>
struct PathPoint {
  Vec4<S> event, tangent, local;
};

template <class M>
concept Metric = requires(const M m, Vec4<double> x) {
  { M::name } -> std::convertible_to<std::string_view>;
  M::parameters;
  { m.g(x) } -> std::same_as<Matrix4<double>>;
};

template <class M>
concept HasClosedPaths = requires(const M m, Vec4<double> x) {
  m.path(x, x).at(1.0);
  { m.bend_of_time() } -> std::same_as<double>;
};

template <class M>
concept HasRhs = requires(const M m, Vec4<double> x) {
  { m.rhs(x, x) } -> std::same_as<Phase<double>>;
};

template <class M>
concept HasEnding = requires(const M m, Phase<double> point) {
  { m.ending(point, point, 1e-9) } -> std::same_as<double>;
};

template <class M>
concept HasIsometry = requires(const M m, Vec4<double> x) {
  { m.to_origin(x, x) } -> std::same_as<Vec4<double>>;
  { m.from_origin(x, x) } -> std::same_as<Vec4<double>>;
};

/// Whether the spacetime is centrally symmetric about the chart's origin, or nearly.
template <class M>
constexpr bool is_central() {
  if constexpr (requires { M::central; })
    return M::central;
  else
    return false;
}

/// Whether nothing changes with time: scenes then count times from their observation.
template <class M>
constexpr bool is_stationary() {
  if constexpr (requires { M::stationary; })
    return M::stationary;
  else
    return true;
}

/// A vector of the static tetrad, turned about e3 by e^{i angle}: what isometries do to it.
template <class S, class T>
Vec4<S> turned_about_e3(const Complex<T>& turn, const Vec4<S>& k) {
  const Complex<S> w = Complex<S>{S(turn.re), S(turn.im)} * Complex<S>{k[1], k[2]};
  return {{k[0], w.re, w.im, k[3]}};
}

/// The derivatives d_k g_ij, by dual numbers: result[k][i][j].
template <Metric M, class S>
std::array<Matrix4<S>, 4> metric_derivatives(const M& metric, const Vec4<S>& x) {
  using D = Dual<S, 4>;
  const auto g = metric.g(Vec4<D>::map([&](std::size_t i) { return D::variable(x[i], i); }));
  std::array<Matrix4<S>, 4> out;
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t i = 0; i < 4; ++i) out[k][i] = Vec4<S>::map([&](std::size_t j) { return g[i][j].d[k]; });
  return out;
}

/// The inverse of a 4 x 4 matrix by its 2 x 2 minors (Laplace): no pivots, so packs need no branches. Good to
/// rounding times the condition of the matrix.
template <class S>
Matrix4<S> inverse(const Matrix4<S>& m) {
  const auto minor = [&](std::size_t row, std::size_t i, std::size_t j) {
    return m[row][i] * m[row + 1][j] - m[row][j] * m[row + 1][i];
  };
  const S s0 = minor(0, 0, 1), s1 = minor(0, 0, 2), s2 = minor(0, 0, 3), s3 = minor(0, 1, 2),
          s4 = minor(0, 1, 3), s5 = minor(0, 2, 3);
  const S c0 = minor(2, 0, 1), c1 = minor(2, 0, 2), c2 = minor(2, 0, 3), c3 = minor(2, 1, 2),
          c4 = minor(2, 1, 3), c5 = minor(2, 2, 3);
  const S scale = S(1.0) / (s0 * c5 - s1 * c4 + s2 * c3 + s3 * c2 - s4 * c1 + s5 * c0);
  // Row j of the inverse, from the pairs of minors that leave out column j.
  const auto row = [&](std::size_t i, std::size_t j, std::size_t k, const S& ca, const S& cb, const S& cc,
                       const S& sa, const S& sb, const S& sc, double sign) {
    const S q = S(sign) * scale;
    return Vec4<S>{{q * (m[1][i] * ca - m[1][j] * cb + m[1][k] * cc),
                    -(q * (m[0][i] * ca - m[0][j] * cb + m[0][k] * cc)),
                    q * (m[3][i] * sa - m[3][j] * sb + m[3][k] * sc),
                    -(q * (m[2][i] * sa - m[2][j] * sb + m[2][k] * sc))}};
  };
  return {row(1, 2, 3, c5, c4, c3, s5, s4, s3, 1), row(0, 2, 3, c5, c2, c1, s5, s2, s1, -1),
          row(0, 1, 3, c4, c2, c0, s4, s2, s0, 1), row(0, 1, 2, c3, c1, c0, s3, s1, s0, -1)};
}

/// Solves m y = b for a symmetric or general 4 x 4 matrix (Gauss-Jordan with partial pivoting). One lane.
template <std::floating_point S>
Vec4<S> solve(Matrix4<S> m, Vec4<S> b) {
  for (std::size_t column = 0; column < 4; ++column) {
    std::size_t pivot = column;
    for (std::size_t row = column + 1; row < 4; ++row)
      if (abs(m[row][column]) > abs(m[pivot][column])) pivot = row;
    std::swap(m[column], m[pivot]);
    std::swap(b[column], b[pivot]);
    const S inverse = S(1) / m[column][column];
    for (std::size_t row = 0; row < 4; ++row) {
      if (row == column) continue;
      const S factor = m[row][column] * inverse;
      m[row] = m[row] - factor * m[column];
      b[row] -= factor * b[column];
    }
  }
  return Vec4<S>::map([&](std::size_t i) { return b[i] / m[i][i]; });
}

/// The term Gamma^mu_ab u^a v^b of parallel transport, from g alone.
template <Metric M, std::floating_point S>
Vec4<S> connection(const M& metric, const Vec4<S>& x, const Vec4<S>& u, const Vec4<S>& v) {
  const auto dg = metric_derivatives(metric, x);
  const auto lower = Vec4<S>::map([&](std::size_t i) {
    S out = 0;
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t k = 0; k < 4; ++k)
        out += S(0.5) * (dg[j][i][k] + dg[k][i][j] - dg[i][j][k]) * u[j] * v[k];
    return out;
  });
  return solve(metric.g(x), lower);
}

/// Orthonormal frame from an observer along `first` (any length) and the coordinate axes d_x, d_y, d_z, in
/// this order. NaN where `first` is not timelike.
template <Metric M, class S>
Tetrad<S> gram_schmidt_tetrad(const M& metric, const Vec4<S>& x, const Vec4<S>& first) {
  const Matrix4<S> g = metric.g(x);
  Tetrad<S> out;
  for (std::size_t i = 0; i < 4; ++i) {
    Vec4<S> e = first;
    for (std::size_t k = 0; k < 4 && i > 0; ++k) e[k] = S(k == i ? 1.0 : 0.0);
    for (std::size_t k = 0; k < i; ++k) {
      const S along = inner(g, e, out.e[k]);
      e = e - (k == 0 ? along : -along) * out.e[k];
    }
    const S square = inner(g, e, e);
    out.e[i] = (S(1.0) / sqrt(i == 0 ? square : -square)) * e;
  }
  return out;
}

/// The static tetrad: of the observer at rest in the chart.
template <Metric M, class S>
Tetrad<S> static_tetrad(const M& metric, const Vec4<S>& x) {
  if constexpr (requires { metric.static_tetrad(x); })
    return metric.static_tetrad(x);
  else
    return gram_schmidt_tetrad(metric, x, Vec4<S>{{S(1.0), S(0.0), S(0.0), S(0.0)}});
}

NULLCONE_KERNEL_END
