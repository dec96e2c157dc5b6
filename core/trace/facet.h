// A surface near one of its points, for the record: the function that is zero on it, its normal and texture
// coordinates. Each lane may have a surface of its own.
#pragma once

#include <numbers>

#include "core/base/dual.h"

NULLCONE_KERNEL_BEGIN

/// How texture coordinates follow from the position Y in the surface's own frame.
enum class Chart {
  affine,  ///< u = at_u + by_u.Y, v = at_v + by_v.Y
  sphere,  ///< longitude and latitude
  tube,    ///< longitude; v = at_v + by_v.Y
  polar    ///< longitude; v = at_v + by_v[0] |(Y_x, Y_y)|
};

/// Numbers of a facet: Y = rows (X - centre), f(Y) = square.Y^2 + linear.Y + constant, zero on the surface
/// and positive on the side of the normal.
struct FacetNumbers {
  std::array<double, 3> centre{};
  std::array<std::array<double, 3>, 3> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  std::array<double, 3> square{}, linear{};
  double constant = 0;
  Chart chart = Chart::affine;
  double at_u = 0, at_v = 0;
  std::array<double, 3> by_u{}, by_v{};
  /// Texture coordinates stay within these: single precision must not reach the next cell of an atlas.
  std::array<double, 2> range_u{-1e300, 1e300}, range_v{-1e300, 1e300};
};

template <class S>
struct Facet {
  using Numbers = std::array<FacetNumbers, Lanes<S>::count>;

  /// numbers(X) of each lane.
  template <class F>
  static Facet near(const Vec3<S>& X, F&& numbers) {
    Numbers out;
    for (std::size_t lane = 0; lane < out.size(); ++lane)
      out[lane] = numbers(Vec3<double>::map([&](std::size_t i) { return Lanes<S>::get(X[i], lane); }));
    return Facet(out);
  }
  explicit Facet(const Numbers& from) {
    const auto load = [&](const auto& number) {
      std::array<double, Lanes<S>::count> values{};
      for (std::size_t lane = 0; lane < values.size(); ++lane) values[lane] = number(from[lane]);
      return Lanes<S>::load(values.data());
    };
    const auto load3 = [&](auto member) {
      return Vec3<S>::map(
          [&](std::size_t i) { return load([&](const FacetNumbers& n) { return (n.*member)[i]; }); });
    };
    centre = load3(&FacetNumbers::centre);
    for (std::size_t k = 0; k < 3; ++k)
      rows[k] = Vec3<S>::map(
          [&](std::size_t i) { return load([&](const FacetNumbers& n) { return n.rows[k][i]; }); });
    square = load3(&FacetNumbers::square), linear = load3(&FacetNumbers::linear);
    by_u = load3(&FacetNumbers::by_u), by_v = load3(&FacetNumbers::by_v);
    constant = load([](const FacetNumbers& n) { return n.constant; });
    at_u = load([](const FacetNumbers& n) { return n.at_u; });
    at_v = load([](const FacetNumbers& n) { return n.at_v; });
    chart = load([](const FacetNumbers& n) { return static_cast<double>(n.chart); });
    for (std::size_t i = 0; i < 2; ++i) {
      range_u[i] = load([&](const FacetNumbers& n) { return n.range_u[i]; });
      range_v[i] = load([&](const FacetNumbers& n) { return n.range_v[i]; });
    }
  }

  template <class T>
  T value(const Vec3<T>& X) const {
    const Vec3<T> Y = local(X);
    T out = T(constant);
    for (std::size_t i = 0; i < 3; ++i) out = out + Y[i] * (T(linear[i]) + T(square[i]) * Y[i]);
    return out;
  }

  /// Unit normal on the side where `value` is positive.
  Vec3<S> normal(const Vec3<S>& X) const {
    const Vec3<S> Y = local(X);
    Vec3<S> out{};
    for (std::size_t k = 0; k < 3; ++k) out = out + (linear[k] + S(2.0) * (square[k] * Y[k])) * rows[k];
    const S length =
        norm(out);  // divided by, so that faces across an axis have just that axis as their normal
    return Vec3<S>::map([&](std::size_t i) { return out[i] / length; });
  }

  template <class T>
  Vec<T, 2> uv(const Vec3<T>& X) const {
    constexpr double kTurn = 2 * std::numbers::pi;
    const Vec3<T> Y = local(X);
    T u = T(at_u), v = T(at_v);
    for (std::size_t i = 0; i < 3; ++i) u = u + T(by_u[i]) * Y[i], v = v + T(by_v[i]) * Y[i];
    if (any(chart > S(0.0))) {
      // The axis itself has no longitude: keep derivatives finite there.
      const S out2 = plain(Y[0]) * plain(Y[0]) + plain(Y[1]) * plain(Y[1]);
      const auto on_axis = !(out2 > S(1e-280));
      const T x = select(on_axis, T(S(1e-140)), Y[0]), y = select(on_axis, T(S(0.0)), Y[1]);
      const T rho = sqrt(x * x + y * y), longitude = T(S(0.5)) + T(S(1 / kTurn)) * atan2(y, x);
      const T latitude = T(S(0.5)) + T(S(2 / kTurn)) * atan2(Y[2], rho);
      u = select(chart > S(0.0), longitude, u);
      v = select(is(Chart::sphere), latitude, select(is(Chart::polar), T(at_v) + T(by_v[0]) * rho, v));
    }
    return {{within(u, range_u), within(v, range_v)}};
  }

 private:
  template <class T>
  Vec3<T> local(const Vec3<T>& X) const {
    const Vec3<T> from = X - convert<T>(centre);
    return Vec3<T>::map([&](std::size_t k) { return dot(convert<T>(rows[k]), from); });
  }
  Mask<S> is(Chart wanted) const { return chart == S(static_cast<double>(wanted)); }
  template <class T>
  static T within(const T& x, const std::array<S, 2>& range) {
    const T raised = select(plain(x) < range[0], T(range[0]), x);
    return select(plain(raised) > range[1], T(range[1]), raised);
  }

  Vec3<S> centre, square, linear, by_u, by_v;
  Matrix3<S> rows;
  S constant, chart, at_u, at_v;
  std::array<S, 2> range_u, range_v;
};

NULLCONE_KERNEL_END
