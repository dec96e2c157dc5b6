// Two colours side by side: one register with AVX2, two with SSE2, and the same bits.
#pragma once

#include "postrender/image.h"
#include "postrender/lanes.h"

NULLCONE_KERNEL_BEGIN

#ifdef __AVX2__

using TwoColors = float __attribute__((vector_size(32), may_alias));

/// From half floats, none of them infinite or subnormal: their exact values.
inline TwoColors widened(Short8 half) { return __builtin_ia32_vcvtph2ps256(half); }

inline TwoColors each_times(float first, float second, TwoColors x) {
  return TwoColors{first, first, first, first, second, second, second, second} * x;
}
inline Float4 first_of(TwoColors x) { return __builtin_shufflevector(x, x, 0, 1, 2, 3); }
inline Float4 second_of(TwoColors x) { return __builtin_shufflevector(x, x, 4, 5, 6, 7); }
inline TwoColors two_of(Float4 a, Float4 b) { return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7); }
inline TwoColors load_two(const postrender::Rgbx* from) { return load<TwoColors>(from); }
inline void store_two(TwoColors x, postrender::Rgbx* to) {
  __builtin_memcpy(static_cast<void*>(to), &x, sizeof x);
}
inline TwoColors firsts_of(TwoColors a, TwoColors b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11);
}
inline TwoColors seconds_of(TwoColors a, TwoColors b) {
  return __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15);
}

#else

struct TwoColors {
  Float4 first, second;
};

/// Each half float becomes the upper half of a word and goes down again with its sign. Sign, exponent and
/// mantissa then stand where floats have them, and the exponent is 112 too small.
inline TwoColors widened(Short8 half) {
  const Short8 none = {};
  const auto value = [](Short8 high) {
    return 0x1p112f * bits_as<Float4>((bits_as<Int4>(high) >> 3) & static_cast<std::int32_t>(0x8fffe000U));
  };
  return {value(__builtin_shufflevector(none, half, 0, 8, 1, 9, 2, 10, 3, 11)),
          value(__builtin_shufflevector(none, half, 4, 12, 5, 13, 6, 14, 7, 15))};
}

inline TwoColors operator+(TwoColors a, TwoColors b) { return {a.first + b.first, a.second + b.second}; }
inline TwoColors operator-(TwoColors a, TwoColors b) { return {a.first - b.first, a.second - b.second}; }
inline TwoColors operator*(TwoColors a, TwoColors b) { return {a.first * b.first, a.second * b.second}; }
inline TwoColors operator*(float s, TwoColors a) { return {s * a.first, s * a.second}; }
inline TwoColors each_times(float first, float second, TwoColors x) {
  return {first * x.first, second * x.second};
}
inline TwoColors two_of(Float4 a, Float4 b) { return {a, b}; }
inline TwoColors load_two(const postrender::Rgbx* from) {
  return {load<Float4>(from), load<Float4>(from + 1)};
}
inline void store_two(TwoColors x, postrender::Rgbx* to) {
  store(x.first, to);
  store(x.second, to + 1);
}
inline Float4 first_of(TwoColors x) { return x.first; }
inline Float4 second_of(TwoColors x) { return x.second; }
inline TwoColors firsts_of(TwoColors a, TwoColors b) { return {a.first, b.first}; }
inline TwoColors seconds_of(TwoColors a, TwoColors b) { return {a.second, b.second}; }

#endif

NULLCONE_KERNEL_END
