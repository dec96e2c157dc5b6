// Four lanes: the three components of a colour.
// Elementwise + - * and comparisons only, so that every instruction set gives the same bits.
#pragma once

#include <cstdint>

#include "core/base/isa.h"

NULLCONE_KERNEL_BEGIN

using Float4 = float __attribute__((vector_size(16), may_alias));
using Int4 = std::int32_t __attribute__((vector_size(16), may_alias));
using Short8 = std::int16_t __attribute__((vector_size(16), may_alias));

template <class Lanes, class T>
inline Lanes load(const T* from) {
  Lanes out;
  __builtin_memcpy(&out, from, sizeof out);
  return out;
}
template <class T>
inline void store(Float4 x, T* to) {
  __builtin_memcpy(static_cast<void*>(to), &x, sizeof x);
}

inline Float4 mix(Float4 a, Float4 b, float s) { return a + s * (b - a); }

template <class To, class From>
inline To bits_as(From x) {
  static_assert(sizeof(To) == sizeof(From));
  To out;
  __builtin_memcpy(&out, &x, sizeof out);
  return out;
}

/// The largest whole number up to x, for |x| < 2^31.
inline float floor_of(float x) {
  const auto whole = static_cast<float>(static_cast<std::int32_t>(x));
  return whole > x ? whole - 1 : whole;
}

/// The nearest whole number (ties to even), for |x| < 2^22.
inline float nearest_of(float x) {
  constexpr float kMagic = 12582912;  // 1.5 * 2^23: the last bit counts ones
  return (x + kMagic) - kMagic;
}

/// Positions beyond this are as good as lost in float, and would not fit an integer.
constexpr float kFarthest = 1e6f;

/// As a mask: of a choice between x and 0 the compiler would make a branch, and no vector loop.
inline float finite_or_zero(float x) {
  const std::int32_t keep = -static_cast<std::int32_t>(__builtin_fabsf(x) < kFarthest);
  return bits_as<float>(bits_as<std::int32_t>(x) & keep);
}

NULLCONE_KERNEL_END
