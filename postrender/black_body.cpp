#include "postrender/black_body.h"

#include <cmath>

#include "postrender/spectral_distribution.h"

namespace nullcone::postrender {

namespace {

constexpr double kPlanck_J_s = 6.62607015e-34;
constexpr double kLight_m_s = 299792458.0;
constexpr double kBoltzmann_J_K = 1.380649e-23;

/// Nodes at 2^(kFirst + i/kPerOctave) K: logarithms of XYZ, which are smooth.
constexpr double kFirst = 8, kLast = 34;
constexpr int kPerOctave = 16, kBeyond = 3;  ///< nodes beyond the ends, for the interpolation there
constexpr int kNodes = static_cast<int>(kLast - kFirst) * kPerOctave + 1 + 2 * kBeyond;

struct PlainPlanck final : SpectralDistribution {
  double temperature_K;
  explicit PlainPlanck(double T) : temperature_K(T) {}
  double at(double nm) const override { return 1e-9 * planck_W_m3_sr(1e-9 * nm, temperature_K); }
};

std::vector<Xyz> make_nodes() {
  std::vector<Xyz> out(kNodes);
  for (int i = 0; i < kNodes; ++i) {
    const Xyz xyz =
        black_body_xyz_integrated(std::exp2(kFirst + static_cast<double>(i - kBeyond) / kPerOctave));
    for (std::size_t c = 0; c < 3; ++c) out[static_cast<std::size_t>(i)][c] = std::log(xyz[c]);
  }
  return out;
}

}  // namespace

double planck_W_m3_sr(double wavelength_m, double temperature_K) {
  const double exponent = kPlanck_J_s * kLight_m_s / (wavelength_m * kBoltzmann_J_K * temperature_K);
  const double squared = wavelength_m * wavelength_m;
  return 2 * kPlanck_J_s * kLight_m_s * kLight_m_s / (squared * squared * wavelength_m) /
         std::expm1(exponent);
}

Xyz black_body_xyz_integrated(double temperature_K) {
  return PlainPlanck(temperature_K).SpectralDistribution::fold(standard_observer(), 1);
}

Xyz black_body_xyz(double temperature_K) {
  const double x = (std::log2(temperature_K) - kFirst) * kPerOctave;
  if (!(x >= 0 && x < (kLast - kFirst) * kPerOctave)) return black_body_xyz_integrated(temperature_K);
  static const std::vector<Xyz> nodes = make_nodes();
  // Lagrange's interpolation through the six nodes around.
  const auto i = static_cast<std::size_t>(x);
  const double s = x - static_cast<double>(i);
  constexpr std::array<double, 6> kProducts = {-120, 24, -12, 12, -24, 120};
  Xyz out{};
  for (std::size_t k = 0; k < 6; ++k) {
    double weight = 1 / kProducts[k];
    for (std::size_t j = 0; j < 6; ++j)
      if (j != k) weight *= s - (static_cast<double>(j) - 2);
    for (std::size_t c = 0; c < 3; ++c) out[c] += weight * nodes[i + kBeyond + k - 2][c];
  }
  for (double& value : out) value = std::exp(value);
  return out;
}

}  // namespace nullcone::postrender
