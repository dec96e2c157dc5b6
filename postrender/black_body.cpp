#include "postrender/black_body.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "postrender/cie1931.h"

namespace nullcone::postrender {

namespace {
constexpr double kPlanck_J_s = 6.62607015e-34;
constexpr double kLight_m_s = 299792458.0;
constexpr double kBoltzmann_J_K = 1.380649e-23;
constexpr double kEfficacy_lm_W = 683;

Rgb rgb_of(const std::array<double, 3>& c) {
  return {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
}
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
  constexpr int kCount = kOctaves << kNodeBits;
  nodes_.resize(kCount + 1);  // the last one stays at its beginning
  const auto start_K = [](int node) {
    return static_cast<double>(std::bit_cast<float>((node + kFirstNode) << (23 - kNodeBits)));
  };
  std::array<double, 3> next = linear_srgb(black_body_xyz(start_K(0)));
  for (int node = 0; node < kCount; ++node) {
    // Through the values at 0, 1/3, 2/3 and 1.
    const double from_K = start_K(node), step_K = start_K(node + 1) - from_K;
    const auto y0 = next, y1 = linear_srgb(black_body_xyz(from_K + step_K / 3)),
               y2 = linear_srgb(black_body_xyz(from_K + 2 * step_K / 3));
    next = linear_srgb(black_body_xyz(from_K + step_K));
    std::array<std::array<double, 3>, 4> c;
    for (std::size_t i = 0; i < 3; ++i) {
      c[0][i] = y0[i];
      c[1][i] = (-11 * y0[i] + 18 * y1[i] - 9 * y2[i] + 2 * next[i]) / 2;
      c[2][i] = 9 * (2 * y0[i] - 5 * y1[i] + 4 * y2[i] - next[i]) / 2;
      c[3][i] = 9 * (-y0[i] + 3 * y1[i] - 3 * y2[i] + next[i]) / 2;
    }
    for (std::size_t k = 0; k < 4; ++k) nodes_[static_cast<std::size_t>(node)].c[k] = rgb_of(c[k]);
  }
  nodes_.back().c[0] = rgb_of(next);
}

Rgb BlackBodyTable::color_cd_m2(double temperature_K) const {
  if (!(temperature_K >= kColdest_K)) return {};
  const auto within = static_cast<float>(std::min(temperature_K, kHottest_K));
  constexpr int kUnused = 23 - kNodeBits;
  const auto bits = std::bit_cast<std::int32_t>(within);
  const auto& c = nodes_[static_cast<std::size_t>((bits >> kUnused) - kFirstNode)].c;
  const float s = std::ldexp(static_cast<float>(bits & ((1 << kUnused) - 1)), -kUnused);
  const Rgb c0 = c[0], c1 = c[1], c2 = c[2], c3 = c[3];
  return static_cast<float>(std::max(temperature_K / kHottest_K, 1.0)) * (c0 + s * (c1 + s * (c2 + s * c3)));
}

}  // namespace nullcone::postrender
