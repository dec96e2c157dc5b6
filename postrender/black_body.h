// The colour of a black body, in cd/m^2, tabulated over its temperature.
#pragma once

#include <array>
#include <vector>

#include "postrender/color.h"

namespace nullcone::postrender {

/// Planck's spectral radiance B_lambda in W m^-3 sr^-1, with the exact constants of the SI of 2019.
double planck_W_m3_sr(double wavelength_m, double temperature_K);

/// Tristimulus values in cd/m^2: 683 lm/W times the 5 nm sums of B_lambda with the CIE 1931 functions.
Xyz black_body_xyz(double temperature_K);

inline constexpr double kColdest_K = 256, kHottest_K = 1073741824.0;

/// Nodes of the table stand where the upper bits of a float temperature change: 2^kNodeBits an octave.
inline constexpr int kNodeBits = 8, kOctaves = 22, kFirstNode = (127 + 8) << kNodeBits;

/// From one node to the next: c[0] + c[1] s + c[2] s^2 + c[3] s^3 in cd/m^2, s from 0 to 1. One cache line.
struct alignas(64) BlackBodyNode {
  std::array<Rgbx, 4> c;
};

/// black_body_xyz() as linear sRGB in cd/m^2, by cubic interpolation over the temperature. Error below 3e-5
/// of the largest component (a test holds it). Below kColdest_K (1e-25 cd/m^2) it is black; above kHottest_K
/// it goes on in proportion to T (Rayleigh-Jeans).
class BlackBodyTable {
 public:
  /// The one table, made at the first call (about 40 ms).
  static const BlackBodyTable& instance();

  const BlackBodyNode* nodes() const { return nodes_.data(); }
  /// As the kernels see it. Black also for a temperature that is not a number.
  Rgb color_cd_m2(double temperature_K) const;

 private:
  BlackBodyTable();
  std::vector<BlackBodyNode> nodes_;
};

}  // namespace nullcone::postrender
