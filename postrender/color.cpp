#include "postrender/color.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace nullcone::postrender {

namespace {

Eigen::Vector3d xyz_of_chromaticity(double x, double y) { return {x / y, 1.0, (1 - x - y) / y}; }

Matrix3 derive_xyz_to_srgb() {
  Eigen::Matrix3d primaries;  // columns: R, G, B at Y = 1 each
  primaries << xyz_of_chromaticity(0.64, 0.33), xyz_of_chromaticity(0.30, 0.60),
      xyz_of_chromaticity(0.15, 0.06);
  // Scale the primaries so that R = G = B = 1 is the white D65.
  const Eigen::Vector3d scale = primaries.partialPivLu().solve(xyz_of_chromaticity(0.3127, 0.3290));
  const Eigen::Matrix3d inverse = (primaries * scale.asDiagonal()).inverse();
  Matrix3 out{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = inverse(i, j);
  return out;
}

Srgb8Table make_srgb8_table() {
  constexpr int kBins = Srgb8Table::kBins;
  constexpr auto kPlaces = std::uint32_t{1} << Srgb8Table::kPlaceBits;
  const auto threshold = [](std::uint32_t code) {  // from which on it is the code
    return static_cast<float>(srgb_decoded((static_cast<double>(code) - 0.5) / 255.0));
  };
  Srgb8Table out{};
  std::uint32_t code = 0;
  for (int bin = 0; bin <= kBins; ++bin) {
    while (code < 255 && threshold(code + 1) * kBins <= static_cast<float>(bin)) ++code;
    const float place = code < 255 ? threshold(code + 1) * kBins - static_cast<float>(bin) : 1;
    // Exact: all thresholds are multiples of 2^-36.
    const auto first = place < 1 ? static_cast<std::uint32_t>(place * static_cast<float>(kPlaces)) : kPlaces;
    out.entries[static_cast<std::size_t>(bin)] = (code << Srgb8Table::kPlaceBits) + (kPlaces - first);
  }
  return out;
}

std::uint16_t encode16(float linear) {
  const double x = linear > 0 ? std::min(static_cast<double>(linear), 1.0) : 0.0;
  return static_cast<std::uint16_t>(std::lround(65535.0 * srgb_encoded(x)));
}

}  // namespace

const Matrix3& xyz_to_srgb() {
  static const Matrix3 matrix = derive_xyz_to_srgb();
  return matrix;
}

std::array<double, 3> linear_srgb(const Xyz& xyz) {
  const Matrix3& m = xyz_to_srgb();
  std::array<double, 3> out{};
  for (std::size_t i = 0; i < 3; ++i) out[i] = m[i][0] * xyz[0] + m[i][1] * xyz[1] + m[i][2] * xyz[2];
  return out;
}

double srgb_decoded(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double srgb_encoded(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

const Srgb8Table& Srgb8Table::instance() {
  static const Srgb8Table table = make_srgb8_table();
  return table;
}

std::uint8_t Srgb8Table::operator()(float linear) const {
  const float at = kBins * (linear > 0 ? std::min(linear, 1.0f) : 0.0f);
  const auto bin = static_cast<std::size_t>(at);
  const float place = (1 << kPlaceBits) * (at - static_cast<float>(bin));
  return static_cast<std::uint8_t>((entries[bin] + static_cast<std::uint32_t>(place)) >> kPlaceBits);
}

std::vector<std::uint8_t> encode_srgb8(std::span<const Rgb> colors) {
  const Srgb8Table& encode = Srgb8Table::instance();
  std::vector<std::uint8_t> out(3 * colors.size());
  std::uint8_t* at = out.data();
  for (const Rgb c : colors)
    for (const float component : {c.r, c.g, c.b}) *at++ = encode(component);
  return out;
}

std::vector<std::uint16_t> encode_srgb16(std::span<const Rgb> colors) {
  std::vector<std::uint16_t> out;
  out.reserve(3 * colors.size());
  for (const Rgb c : colors) out.insert(out.end(), {encode16(c.r), encode16(c.g), encode16(c.b)});
  return out;
}

Rgb default_color(std::uint32_t id) {
  // Hues a golden angle apart never come close to one another for small numbers.
  const double turn = 0.08 + 0.6180339887498949 * static_cast<double>(id - 1U);
  const auto component = [&](double phase) {
    return static_cast<float>(srgb_decoded(0.6 + 0.3 * std::cos(2 * 3.141592653589793 * (turn - phase))));
  };
  return {component(0), component(1.0 / 3), component(2.0 / 3)};
}

}  // namespace nullcone::postrender
