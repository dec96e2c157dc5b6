// Dual numbers: exact first derivatives in N directions, carried along with the value.
#pragma once

#include "core/base/vector.h"

NULLCONE_KERNEL_BEGIN

/// v + sum_i d[i] eps_i with eps_i eps_j = 0. S may itself be a pack or a dual.
template <class S, std::size_t N>
struct Dual {
  S v{};
  Vec<S, N> d{};

  Dual() = default;
  Dual(const S& value) : v(value) {}  // a constant; implicit, so that formulas read alike for every scalar
  Dual(const S& value, const Vec<S, N>& derivative) : v(value), d(derivative) {}
  template <class T>
  requires(std::is_arithmetic_v<T> && !std::is_same_v<T, S>) explicit Dual(T value) : v(S(value)) {}

  /// The variable number `direction`.
  static Dual variable(const S& value, std::size_t direction) {
    Dual out(value);
    out.d[direction] = S(1.0);
    return out;
  }

  friend Dual operator+(const Dual& a, const Dual& b) { return {a.v + b.v, a.d + b.d}; }
  friend Dual operator-(const Dual& a, const Dual& b) { return {a.v - b.v, a.d - b.d}; }
  friend Dual operator-(const Dual& a) { return {-a.v, -a.d}; }
  friend Dual operator*(const Dual& a, const Dual& b) { return {a.v * b.v, a.v * b.d + b.v * a.d}; }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const S inverse = S(1.0) / b.v, quotient = a.v * inverse;
    return {quotient, inverse * (a.d - quotient * b.d)};
  }
  friend bool operator<(const Dual& a, const Dual& b) requires std::is_floating_point_v<S> {
    return a.v < b.v;
  }
};

template <class S, std::size_t N>
Dual<S, N> sqrt(const Dual<S, N>& x) {
  const S root = sqrt(x.v);
  return {root, (S(0.5) / root) * x.d};
}
template <class S, std::size_t N>
SinCos<Dual<S, N>> sincos(const Dual<S, N>& x) {
  const auto [s, c] = sincos(x.v);
  return {{s, c * x.d}, {c, -(s * x.d)}};
}
template <class S, std::size_t N>
Dual<S, N> atan2(const Dual<S, N>& y, const Dual<S, N>& x) {
  const S scale = S(1.0) / (x.v * x.v + y.v * y.v);
  return {atan2(y.v, x.v), scale * (x.v * y.d - y.v * x.d)};
}
template <class S, std::size_t N>
Dual<S, N> exp(const Dual<S, N>& x) {
  const S value = exp(x.v);
  return {value, value * x.d};
}
template <class S, std::size_t N>
Dual<S, N> log(const Dual<S, N>& x) {
  return {log(x.v), (S(1.0) / x.v) * x.d};
}

template <class S, std::size_t N>
Dual<S, N> select(const Mask<S>& choose, const Dual<S, N>& a, const Dual<S, N>& b) {
  return {select(choose, a.v, b.v), select(choose, a.d, b.d)};
}

/// The value without its derivatives.
template <class S>
const S& plain(const S& x) {
  return x;
}
template <class S, std::size_t N>
const S& plain(const Dual<S, N>& x) {
  return x.v;
}
template <class S, std::size_t N, std::size_t M>
Vec<S, M> plain(const Vec<Dual<S, N>, M>& x) {
  return Vec<S, M>::map([&](std::size_t i) { return x[i].v; });
}

NULLCONE_KERNEL_END
