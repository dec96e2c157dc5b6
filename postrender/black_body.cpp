#include "postrender/black_body.h"

#include <algorithm>
#include <cmath>

#include "postrender/cie1931.h"

namespace nullcone::postrender {

namespace {
constexpr double kPlanck_J_s = 6.62607015e-34;
constexpr double kLight_m_s = 299792458.0;
constexpr double kBoltzmann_J_K = 1.380649e-23;
constexpr double kEfficacy_lm_W = 683;
}  // namespace

double planck_W_m3_sr(double wavelength_m, double temperature_K) {
  const double exponent = kPlanck_J_s * kLight_m_s / (wavelength_m * kBoltzmann_J_K * temperature_K);
  const double squared = wavelength_m * wavelength_m;
  return 2 * kPlanck_J_s * kLight_m_s * kLight_m_s / (squared * squared * wavelength_m) /
         std::expm1(exponent);
}

Xyz black_body_xyz(double temperature_K) {
  Xyz sum{};
  for (std::size_t i = 0; i < kCmfSamples; ++i) {
    const double wavelength_m = 1e-9 * (kCmfFirst_nm + kCmfStep_nm * static_cast<double>(i));
    const double radiance = planck_W_m3_sr(wavelength_m, temperature_K);
    for (std::size_t j = 0; j < 3; ++j) sum[j] += kCie1931[i][j] * radiance;
  }
  for (double& value : sum) value *= kEfficacy_lm_W * 1e-9 * kCmfStep_nm;
  return sum;
}

const BlackBodyTable& BlackBodyTable::instance() {
  static const BlackBodyTable table;
  return table;
}

BlackBodyTable::BlackBodyTable() {
  const auto count = static_cast<std::size_t>(kOctaves * kPerOctave) + 1;
  nodes_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Xyz xyz = black_body_xyz(std::exp2(kFirstOctave + static_cast<double>(i) / kPerOctave));
    const auto rgb = linear_srgb({xyz[0] / xyz[1], 1.0, xyz[2] / xyz[1]});
    nodes_.push_back({static_cast<float>(std::log(xyz[1])),
                      {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])}});
  }
}

Rgb BlackBodyTable::color_cd_m2(double temperature_K) const {
  if (!(temperature_K >= kColdest_K)) return {};
  const double tabulated_K = std::min(temperature_K, kHottest_K);
  const double x = (std::log2(tabulated_K) - kFirstOctave) * kPerOctave;
  const std::size_t i = std::min(static_cast<std::size_t>(x), nodes_.size() - 2);
  const double s = x - static_cast<double>(i);
  const double log_Y =
      (1 - s) * static_cast<double>(nodes_[i].log_Y) + s * static_cast<double>(nodes_[i + 1].log_Y);
  const double Y = std::exp(log_Y) * (temperature_K / tabulated_K);
  return static_cast<float>(Y) * mix(nodes_[i].per_Y, nodes_[i + 1].per_Y, static_cast<float>(s));
}

}  // namespace nullcone::postrender
