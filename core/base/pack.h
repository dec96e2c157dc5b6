// Packs: several rays side by side, and the few elementary functions that kernels may use on them.
// The one place that knows xsimd. The architecture is always named, never xsimd's default, which has FMA:
// with contraction off, every function here gives the same bits for one lane, SSE2, AVX2 and AVX-512.
#pragma once

#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <xsimd/xsimd.hpp>

#include "core/base/isa.h"

NULLCONE_KERNEL_BEGIN

using Pack = xsimd::batch<double, xsimd::NULLCONE_ARCH>;
using OneLane = xsimd::batch<double, xsimd::sse2>;  // what a plain double is computed with

template <class S>
struct SinCos {
  S sin, cos;
};

/// Sine and cosine of a pack. xsimd's own functions go over to a scalar routine for large arguments, which
/// the linker would share between instruction sets; so the reduction is done here, in three parts of pi/2 (33
/// bits each; exact up to 2^20 quadrants, and good to a rounding of x beyond), and xsimd's polynomials do the
/// rest.
template <class A>
SinCos<xsimd::batch<double, A>> reduced_sincos(const xsimd::batch<double, A>& x) {
  using B = xsimd::batch<double, A>;
  constexpr double kPart1 = 0x1.921fb544p+0, kPart2 = 0x1.0b4611a6p-34, kPart3 = 0x1.3198a2e037073p-69;
  const B quadrants = xsimd::floor(x * B(0.63661977236758134308) + B(0.5));
  const B r = ((x - quadrants * B(kPart1)) - quadrants * B(kPart2)) - quadrants * B(kPart3);
  const B quadrant = quadrants - B(4.0) * xsimd::floor(quadrants * B(0.25));  // 0 to 3
  const B z = r * r, s = xsimd::kernel::detail::sin_eval(z, r), c = xsimd::kernel::detail::cos_eval(z);
  const auto odd = (quadrant == B(1.0)) | (quadrant == B(3.0));
  const B sine = xsimd::select(odd, c, s), cosine = xsimd::select(odd, s, c);
  return {xsimd::select(quadrant >= B(2.0), -sine, sine),
          xsimd::select((quadrant == B(1.0)) | (quadrant == B(2.0)), -cosine, cosine)};
}

/// xsimd's atan2, but 0 for (0, 0), where that gives NaN.
template <class A>
xsimd::batch<double, A> direction_of(const xsimd::batch<double, A>& y, const xsimd::batch<double, A>& x) {
  using B = xsimd::batch<double, A>;
  return xsimd::atan2(y, xsimd::select((x == B(0.0)) & (y == B(0.0)), B(1.0), x));
}

// One lane: plain double takes lane 0 of the SSE2 functions, so that it agrees with every pack to the last
// bit.
inline SinCos<double> sincos(double x) {
  const auto [s, c] = reduced_sincos(OneLane(x));
  return {s.get(0), c.get(0)};
}
inline double atan2(double y, double x) { return direction_of(OneLane(y), OneLane(x)).get(0); }
inline double exp(double x) { return xsimd::exp(OneLane(x)).get(0); }
inline double log(double x) { return xsimd::log(OneLane(x)).get(0); }
inline double sqrt(double x) { return __builtin_sqrt(x); }
inline double abs(double x) { return __builtin_fabs(x); }
inline double max(double a, double b) { return a < b ? b : a; }
inline double min(double a, double b) { return b < a ? b : a; }
inline double floor(double x) { return __builtin_floor(x); }
inline double select(bool choose, double a, double b) { return choose ? a : b; }
inline bool any(bool mask) { return mask; }
inline bool all(bool mask) { return mask; }

// The reference: long double with the library's functions.
inline SinCos<long double> sincos(long double x) { return {std::sin(x), std::cos(x)}; }
inline long double atan2(long double y, long double x) { return std::atan2(y, x); }
inline long double exp(long double x) { return std::exp(x); }
inline long double log(long double x) { return std::log(x); }
inline long double sqrt(long double x) { return std::sqrt(x); }
inline long double floor(long double x) { return std::floor(x); }
inline long double abs(long double x) { return std::fabs(x); }
inline long double max(long double a, long double b) { return a < b ? b : a; }
inline long double min(long double a, long double b) { return b < a ? b : a; }
inline long double select(bool choose, long double a, long double b) { return choose ? a : b; }

// Packs.
inline SinCos<Pack> sincos(const Pack& x) { return reduced_sincos(x); }
inline Pack atan2(const Pack& y, const Pack& x) { return direction_of(y, x); }
inline Pack exp(const Pack& x) { return xsimd::exp(x); }
inline Pack log(const Pack& x) { return xsimd::log(x); }
inline Pack sqrt(const Pack& x) { return xsimd::sqrt(x); }
inline Pack floor(const Pack& x) { return xsimd::floor(x); }
inline Pack abs(const Pack& x) { return xsimd::abs(x); }
inline Pack max(const Pack& a, const Pack& b) { return xsimd::select(a < b, b, a); }
inline Pack min(const Pack& a, const Pack& b) { return xsimd::select(b < a, b, a); }
inline Pack select(const typename Pack::batch_bool_type& choose, const Pack& a, const Pack& b) {
  return xsimd::select(choose, a, b);
}
inline bool any(const typename Pack::batch_bool_type& mask) { return xsimd::any(mask); }
inline bool all(const typename Pack::batch_bool_type& mask) { return xsimd::all(mask); }

/// How many rays stand side by side in S, and how to take them out and put them in.
template <class S>
struct Lanes {
  static constexpr std::size_t count = 1;
  using Mask = bool;
  static S load(const double* from) { return S(*from); }
  static void store(S x, double* to) { *to = static_cast<double>(x); }
  static void store(bool mask, bool* to) { *to = mask; }
  static double get(S x, std::size_t) { return static_cast<double>(x); }
};
template <>
struct Lanes<Pack> {
  static constexpr std::size_t count = Pack::size;
  using Mask = typename Pack::batch_bool_type;
  static Pack load(const double* from) { return Pack::load_unaligned(from); }
  static void store(const Pack& x, double* to) { x.store_unaligned(to); }
  static void store(const Mask& mask, bool* to) { mask.store_unaligned(to); }
  static double get(const Pack& x, std::size_t lane) { return x.get(lane); }
};
template <class S>
using Mask = typename Lanes<S>::Mask;

NULLCONE_KERNEL_END
