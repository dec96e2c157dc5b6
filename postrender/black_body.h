// The colour of a black body, in cd/m^2, tabulated over the logarithm of its temperature.
#pragma once

#include <vector>

#include "postrender/color.h"

namespace nullcone::postrender {

/// Planck's spectral radiance B_lambda in W m^-3 sr^-1, with the exact constants of the SI of 2019.
double planck_W_m3_sr(double wavelength_m, double temperature_K);

/// Tristimulus values in cd/m^2: 683 lm/W times the 5 nm sums of B_lambda with the CIE 1931 functions.
Xyz black_body_xyz(double temperature_K);

/// black_body_xyz() as linear sRGB in cd/m^2, by linear interpolation of ln Y and of R/Y, G/Y, B/Y over log2
/// T. Relative error below 3e-5 of Y (a test holds it). Below kColdest_K (1e-25 cd/m^2) it is black; above
/// kHottest_K it goes on in proportion to T (Rayleigh-Jeans).
class BlackBodyTable {
 public:
  static constexpr double kColdest_K = 256, kHottest_K = 1073741824.0;

  /// The one table, made at the first call (about 20 ms).
  static const BlackBodyTable& instance();

  /// Black also for a temperature that is not a number.
  Rgb color_cd_m2(double temperature_K) const;

 private:
  static constexpr double kFirstOctave = 8, kOctaves = 22, kPerOctave = 512;
  struct Node {
    float log_Y;
    Rgb per_Y;
  };
  BlackBodyTable();
  std::vector<Node> nodes_;
};

}  // namespace nullcone::postrender
