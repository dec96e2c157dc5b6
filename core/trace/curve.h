// A step of an integrated ray as an object sees it: a polynomial through exact states of the ray within the
// step.
//
// Hermite interpolation through n states, themselves made by the stepper from the step's start, with their
// rates: its error is of order 2n in the step, so it matches every stepper that is not of a higher order, and
// cubic Hermite (n = 2) is the case that does not.
#pragma once

#include "core/trace/sight.h"

NULLCONE_KERNEL_BEGIN

/// Coefficients of 1, s, s^2, … on [0, 1] from the values at n evenly spaced points and the slopes there.
template <std::size_t n>
constexpr std::array<std::array<double, 2 * n>, 2 * n> hermite_coefficients() {
  constexpr std::size_t m = 2 * n;
  long double a[m][2 * m] = {};
  for (std::size_t k = 0; k < n; ++k) {
    const long double s = static_cast<long double>(k) / (n - 1);
    long double power = 1;  // s^j and its derivative j s^(j-1)
    for (std::size_t j = 0; j < m; ++j) {
      a[k][j] = power;
      if (j + 1 < m) a[n + k][j + 1] = static_cast<long double>(j + 1) * power;
      power *= s;
    }
    a[k][m + k] = a[n + k][m + n + k] = 1;
  }
  for (std::size_t column = 0; column < m; ++column) {  // Gauss-Jordan with pivots
    std::size_t pivot = column;
    for (std::size_t row = column + 1; row < m; ++row)
      if ((a[row][column] < 0 ? -a[row][column] : a[row][column]) >
          (a[pivot][column] < 0 ? -a[pivot][column] : a[pivot][column]))
        pivot = row;
    for (std::size_t j = 0; j < 2 * m; ++j) std::swap(a[column][j], a[pivot][j]);
    const long double inverse = 1 / a[column][column];
    for (std::size_t j = 0; j < 2 * m; ++j) a[column][j] *= inverse;
    for (std::size_t row = 0; row < m; ++row) {
      const long double factor = row == column ? 0 : a[row][column];
      for (std::size_t j = 0; j < 2 * m; ++j) a[row][j] -= factor * a[column][j];
    }
  }
  std::array<std::array<double, m>, m> out{};
  for (std::size_t i = 0; i < m; ++i)
    for (std::size_t j = 0; j < m; ++j) out[i][j] = static_cast<double>(a[i][m + j]);
  return out;
}

/// The curve in the object's frame; what `advance` (crossing.h) walks along.
template <class S, std::size_t n>
struct Curve {
  std::array<Vec3<S>, 2 * n> c;  ///< coefficients of s = delta / length
  S length;
  S bend_max;  ///< of |d2X/dlambda2| over the whole step

  /// From n positions and slopes dX/dlambda, evenly spaced.
  Curve(const std::array<Vec3<S>, n>& X, const std::array<Vec3<S>, n>& slope, const S& step) : length(step) {
    static constexpr auto kMatrix = hermite_coefficients<n>();
    bend_max = S(0.0);
    for (std::size_t j = 0; j < 2 * n; ++j) {
      Vec3<S> values{}, slopes{};
      for (std::size_t k = 0; k < n; ++k) {
        values = values + S(kMatrix[j][k]) * X[k];
        slopes = slopes + S(kMatrix[j][n + k]) * slope[k];
      }
      c[j] = values + length * slopes;
      bend_max = bend_max + S(static_cast<double>(j * (j - (j > 0)))) * norm(c[j]);
    }
    bend_max = bend_max / (length * length);
  }

  Sight<S> at(const S& delta) const {
    const S s = delta / length;
    Vec3<S> X = c[2 * n - 1], V = S(static_cast<double>(2 * n - 1)) * c[2 * n - 1];
    for (std::size_t j = 2 * n - 1; j-- > 0;) X = c[j] + s * X;
    for (std::size_t j = 2 * n - 1; j-- > 1;) V = S(static_cast<double>(j)) * c[j] + s * V;
    Sight<S> out;
    out.X = X;
    out.slope = (S(1.0) / length) * V;
    out.clearance = S(0.0);
    out.valid = max(length - delta, S(1e-3) * length);
    out.bend_max = bend_max;
    const S speed = norm(out.slope), change = bend_max * out.valid;
    out.slope_min = max(speed - change, S(0.0));
    out.slope_max = speed + change;
    return out;
  }
};

/// Where a step runs: a capsule around its chord, as thick as twice what the cubic through both ends swells,
/// and a little of the chord's length for what the cubic does not know.
template <class S>
struct Capsule {
  Vec3<S> middle, chord;
  S over_chord2, thickness;

  Capsule(const Vec3<S>& X0, const Vec3<S>& slope0, const Vec3<S>& X1, const Vec3<S>& slope1, const S& length)
      : middle(S(0.5) * (X0 + X1)), chord(X1 - X0) {
    const S chord2 = dot(chord, chord);
    over_chord2 = S(1.0) / max(chord2, S(1e-300));
    thickness =
        S(0.3) * (norm(length * slope0 - chord) + norm(length * slope1 - chord)) + S(0.02) * sqrt(chord2);
  }

  /// Whether it may touch the ball. True for NaN.
  Mask<S> touches(const Vec3<S>& centre, const S& radius) const {
    const Vec3<S> to_centre = centre - middle;
    const S along = max(S(-0.5), min(S(0.5), dot(to_centre, chord) * over_chord2));
    const Vec3<S> nearest = to_centre - along * chord;
    const S reach = radius + thickness;
    return !(dot(nearest, nearest) > reach * reach);
  }
};

NULLCONE_KERNEL_END
