// 3- and 4-vectors, 4 x 4 matrices and complex numbers over any scalar (double, long double, Dual, Pack).
// The standard library and Eigen do not carry packs and duals well; what is needed is this little.
#pragma once

#include <array>
#include <cstddef>

#include "core/base/pack.h"

NULLCONE_KERNEL_BEGIN

/// N components. For events the order is (t, x, y, z).
template <class S, std::size_t N>
struct Vec {
  std::array<S, N> c{};

  S& operator[](std::size_t i) { return c[i]; }
  const S& operator[](std::size_t i) const { return c[i]; }

  friend Vec operator+(const Vec& a, const Vec& b) {
    return map([&](std::size_t i) { return a[i] + b[i]; });
  }
  friend Vec operator-(const Vec& a, const Vec& b) {
    return map([&](std::size_t i) { return a[i] - b[i]; });
  }
  friend Vec operator-(const Vec& a) {
    return map([&](std::size_t i) { return -a[i]; });
  }
  friend Vec operator*(const S& s, const Vec& a) {
    return map([&](std::size_t i) { return s * a[i]; });
  }
  template <class F>
  static Vec map(F&& f) {
    Vec out;
    for (std::size_t i = 0; i < N; ++i) out[i] = f(i);
    return out;
  }
};
template <class S>
using Vec3 = Vec<S, 3>;
template <class S>
using Vec4 = Vec<S, 4>;

template <class To, class From, std::size_t N>
Vec<To, N> convert(const Vec<From, N>& a) {
  return Vec<To, N>::map([&](std::size_t i) { return To(a[i]); });
}
template <class To, std::size_t N>
Vec<To, N> convert(const std::array<double, N>& a) {
  return Vec<To, N>::map([&](std::size_t i) { return To(a[i]); });
}

template <class To, class From, std::size_t N>
std::array<Vec<To, N>, N> convert(const std::array<Vec<From, N>, N>& m) {
  std::array<Vec<To, N>, N> out;
  for (std::size_t i = 0; i < N; ++i) out[i] = convert<To>(m[i]);
  return out;
}

template <class S, std::size_t N>
S dot(const Vec<S, N>& a, const Vec<S, N>& b) {
  S out = a[0] * b[0];
  for (std::size_t i = 1; i < N; ++i) out = out + a[i] * b[i];
  return out;
}
template <class S>
Vec3<S> cross(const Vec3<S>& a, const Vec3<S>& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}
template <class S, std::size_t N>
S norm(const Vec<S, N>& a) {
  return sqrt(dot(a, a));
}
template <class S, std::size_t N>
Vec<S, N> normalised(const Vec<S, N>& a) {
  return (S(1.0) / norm(a)) * a;
}
template <class S, std::size_t N>
Vec<S, N> select(const Mask<S>& choose, const Vec<S, N>& a, const Vec<S, N>& b) {
  return Vec<S, N>::map([&](std::size_t i) { return select(choose, a[i], b[i]); });
}
/// The spatial part of an event or a 4-vector.
template <class S>
Vec3<S> spatial(const Vec4<S>& x) {
  return {{x[1], x[2], x[3]}};
}

/// A 4 x 4 matrix, rows first; m[i] is a row.
template <class S>
using Matrix4 = std::array<Vec4<S>, 4>;
template <class S>
using Matrix3 = std::array<Vec3<S>, 3>;

template <class S, std::size_t N>
Vec<S, N> operator*(const std::array<Vec<S, N>, N>& m, const Vec<S, N>& v) {
  return Vec<S, N>::map([&](std::size_t i) { return dot(m[i], v); });
}
/// The scalar product g(a, b).
template <class S>
S inner(const Matrix4<S>& g, const Vec4<S>& a, const Vec4<S>& b) {
  return dot(a, g * b);
}

template <class S>
struct Complex {
  S re{}, im{};

  friend Complex operator+(const Complex& a, const Complex& b) { return {a.re + b.re, a.im + b.im}; }
  friend Complex operator-(const Complex& a, const Complex& b) { return {a.re - b.re, a.im - b.im}; }
  friend Complex operator*(const Complex& a, const Complex& b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
  }
  friend Complex operator*(const S& s, const Complex& a) { return {s * a.re, s * a.im}; }
};
template <class S>
Complex<S> conj(const Complex<S>& a) {
  return {a.re, -a.im};
}
template <class S>
S norm2(const Complex<S>& a) {
  return a.re * a.re + a.im * a.im;
}

NULLCONE_KERNEL_END
