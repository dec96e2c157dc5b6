// Cells of tables by g: one a value of the upper bits of the float g, so that they are found by a shift.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "postrender/spectrum.h"

namespace nullcone::postrender {

struct BitGrid {
  ShiftRange range;
  std::int32_t unused_bits;  ///< of the mantissa between two cells
  std::int32_t first;        ///< upper bits of the first cell
  std::int32_t cells;

  /// 2^bits cells an octave; the ends within what float and the powers of g can hold.
  BitGrid(ShiftRange within, int bits)
      : range(sensible(within)),
        unused_bits(23 - bits),
        first(std::bit_cast<std::int32_t>(range.from) >> unused_bits),
        cells((std::bit_cast<std::int32_t>(range.to) >> unused_bits) - first + 1) {}

  /// Each cell in two.
  BitGrid halved() const {
    BitGrid out = *this;
    --out.unused_bits;
    out.first *= 2;
    out.cells *= 2;
    return out;
  }
  /// g in a cell, `part` from 0 to 1.
  double place(std::int32_t cell, double part) const {
    const auto start = [&](std::int32_t i) {
      return static_cast<double>(std::bit_cast<float>((first + i) << unused_bits));
    };
    return std::lerp(start(cell), start(cell + 1), part);
  }
  /// The cell of g, and the part; outside of the range those of its ends.
  std::pair<std::int32_t, float> find(float g) const {
    const auto bits = std::bit_cast<std::int32_t>(std::clamp(g, range.from, range.to));
    const std::int32_t whole = 1 << unused_bits;
    return {(bits >> unused_bits) - first,
            static_cast<float>(bits & (whole - 1)) / static_cast<float>(whole)};
  }

 private:
  static ShiftRange sensible(ShiftRange range) {
    constexpr float kLeast = 1e-12f, kMost = 1e12f;
    const float from = std::clamp(range.from, kLeast, kMost);
    return {from, std::clamp(range.to, from, kMost)};
  }
};

/// Coefficients of the cubic in s through the values at s = 0, 1/3, 2/3 and 1.
inline std::array<double, 4> cubic_through(double a, double b, double c, double d) {
  return {a, (-11 * a + 18 * b - 9 * c + 2 * d) / 2, 9 * (2 * a - 5 * b + 4 * c - d) / 2,
          9 * (-a + 3 * b - 3 * c + d) / 2};
}

/// The largest component.
inline double magnitude(const std::array<double, 3>& c) {
  return std::max({std::abs(c[0]), std::abs(c[1]), std::abs(c[2])});
}

}  // namespace nullcone::postrender
