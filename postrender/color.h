// Colour spaces: CIE XYZ, linear sRGB, and the sRGB transfer curve.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "postrender/image.h"

namespace nullcone::postrender {

/// CIE 1931 tristimulus values; Y is a luminance in cd/m^2.
using Xyz = std::array<double, 3>;
using Matrix3 = std::array<std::array<double, 3>, 3>;

/// XYZ -> linear sRGB, from the chromaticities of the Rec. 709 primaries and of D65 (IEC 61966-2-1), not from
/// the rounded matrix printed there, nor from that of Alghamdi et al. eq. (10), which is CIE RGB.
const Matrix3& xyz_to_srgb();

/// Linear sRGB of tristimulus values, unclipped: negative components lie outside the gamut.
std::array<double, 3> linear_srgb(const Xyz& xyz);

/// The luminance of linear sRGB: the middle row of the inverse of xyz_to_srgb(), rounded to float.
inline constexpr Rgb kLuminance = {0.212639006f, 0.715168679f, 0.0721923154f};
constexpr float luminance(Rgb c) { return kLuminance.r * c.r + kLuminance.g * c.g + kLuminance.b * c.b; }

/// The sRGB transfer curve (IEC 61966-2-1), from an encoded value in [0, 1] to a linear one and back.
double srgb_decoded(double encoded);
double srgb_encoded(double linear);

/// Exact 8 bit encoding of a linear x in [0, 1] without a power, and in one look: with x kBins = bin + place,
/// code = (entries[bin] + place 2^kPlaceBits) >> kPlaceBits. No bin holds more than one rounding threshold,
/// because the curve is nowhere steeper than 12.92 * 255 = 3295 codes a unit.
struct Srgb8Table {
  static constexpr int kBins = 4096, kPlaceBits = 24;
  std::array<std::uint32_t, kBins + 1> entries;

  static const Srgb8Table& instance();
  std::uint8_t operator()(float linear) const;  ///< clamped; 0 for NaN
};

/// Encoded 8 bit and 16 bit components, three a pixel, correctly rounded. Components are clamped to [0, 1];
/// NaN is 0.
std::vector<std::uint8_t> encode_srgb8(std::span<const Rgb> colors);
std::vector<std::uint16_t> encode_srgb16(std::span<const Rgb> colors);

/// The flat colour of an object that the look does not mention, by its number from 1: hues far apart.
Rgb default_color(std::uint32_t id);

}  // namespace nullcone::postrender
