#include "postrender/spectral_distribution.h"

#include <algorithm>
#include <cmath>

#include "postrender/black_body.h"

namespace nullcone::postrender {

namespace {

struct BlackBody final : SpectralDistribution {
  double temperature_K;
  explicit BlackBody(double T) : temperature_K(T) {}
  double at(double nm) const override { return 1e-9 * planck_W_m3_sr(1e-9 * nm, temperature_K); }
  /// B(g lambda; T) = g^-5 B(lambda; g T), which is tabulated for the eye.
  std::array<double, 3> fold(const Sensor& sensor, double g) const override {
    if (&sensor != &standard_observer()) return SpectralDistribution::fold(sensor, g);
    Xyz out = black_body_xyz(g * temperature_K);
    const double squared = g * g, power = squared * squared * g;
    for (double& x : out) x = x / power < 1e-290 ? 0 : x / power;
    return out;
  }
};

struct Tabulated final : SpectralDistribution {
  std::vector<double> nm, value;
  bool hold;
  Tabulated(std::vector<double> wavelengths, std::vector<double> values, bool held)
      : nm(std::move(wavelengths)), value(std::move(values)), hold(held) {}
  double at(double x) const override {
    if (x < nm.front()) return hold ? value.front() : 0;
    if (x >= nm.back()) return hold || x == nm.back() ? value.back() : 0;
    const auto next = static_cast<std::size_t>(std::ranges::upper_bound(nm, x) - nm.begin());
    return std::lerp(value[next - 1], value[next], (x - nm[next - 1]) / (nm[next] - nm[next - 1]));
  }
  std::vector<double> knots() const override { return nm; }
  bool is_linear() const override { return true; }
  Band known() const override { return {nm.front(), nm.back()}; }
};

struct Lines final : SpectralDistribution {
  std::vector<SpectralLine> list;
  explicit Lines(std::vector<SpectralLine> from) : list(std::move(from)) {}
  double at(double) const override { return 0; }
  std::vector<SpectralLine> lines() const override { return list; }
  std::array<double, 3> fold(const Sensor&, double) const override { return {}; }
};

struct Constant final : SpectralDistribution {
  double value;
  Band band;
  Constant(double level, Band within) : value(level), band(within) {}
  double at(double nm) const override { return nm >= band.from && nm <= band.to ? value : 0; }
  std::vector<double> knots() const override { return {band.from, band.to}; }
  bool is_linear() const override { return true; }
};

struct PowerLaw final : SpectralDistribution {
  double value, at_nm, index;
  PowerLaw(double level, double reference_nm, double exponent)
      : value(level), at_nm(reference_nm), index(exponent) {}
  double at(double nm) const override { return value * std::pow(nm / at_nm, index); }
};

struct Gaussian final : SpectralDistribution {
  double value, centre_nm, sigma_nm;
  Gaussian(double level, double centre, double sigma) : value(level), centre_nm(centre), sigma_nm(sigma) {}
  double at(double nm) const override {
    const double x = (nm - centre_nm) / sigma_nm;
    return value * std::exp(-0.5 * x * x);
  }
  std::vector<double> knots() const override {
    std::vector<double> out;
    for (int k = -38; k <= 38; ++k)
      if (centre_nm + k * sigma_nm > 0) out.push_back(centre_nm + k * sigma_nm);
    return out;
  }
};

void append(std::vector<double>& to, const std::vector<double>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

struct Sum final : SpectralDistribution {
  std::vector<AnySpectrum> parts;
  explicit Sum(std::vector<AnySpectrum> from) : parts(std::move(from)) {}
  double at(double nm) const override {
    double out = 0;
    for (const AnySpectrum& part : parts) out += part->at(nm);
    return out;
  }
  std::vector<SpectralLine> lines() const override {
    std::vector<SpectralLine> out;
    for (const AnySpectrum& part : parts)
      for (const SpectralLine& line : part->lines()) out.push_back(line);
    return out;
  }
  std::vector<double> knots() const override {
    std::vector<double> out;
    for (const AnySpectrum& part : parts) append(out, part->knots());
    return out;
  }
  Band known() const override {
    Band out;
    for (const AnySpectrum& part : parts) {
      out.from = std::max(out.from, part->known().from);
      out.to = std::min(out.to, part->known().to);
    }
    return out;
  }
  std::array<double, 3> fold(const Sensor& sensor, double g) const override {
    std::array<double, 3> out{};
    for (const AnySpectrum& part : parts) {
      const auto one = part->fold(sensor, g);
      for (std::size_t c = 0; c < 3; ++c) out[c] += one[c];
    }
    return out;
  }
};

struct Scaled final : SpectralDistribution {
  AnySpectrum spectrum;
  double factor;
  Scaled(AnySpectrum from, double by) : spectrum(std::move(from)), factor(by) {}
  double at(double nm) const override { return factor * spectrum->at(nm); }
  std::vector<SpectralLine> lines() const override {
    std::vector<SpectralLine> out = spectrum->lines();
    for (SpectralLine& line : out) line.strength *= factor;
    return out;
  }
  std::vector<double> knots() const override { return spectrum->knots(); }
  bool is_linear() const override { return spectrum->is_linear(); }
  Band known() const override { return spectrum->known(); }
  std::array<double, 3> fold(const Sensor& sensor, double g) const override {
    auto out = spectrum->fold(sensor, g);
    for (double& x : out) x *= factor;
    return out;
  }
};

struct Shifted final : SpectralDistribution {
  AnySpectrum spectrum;
  double g;
  Shifted(AnySpectrum from, double ratio) : spectrum(std::move(from)), g(ratio) {}
  double at(double nm) const override { return spectrum->at(g * nm); }
  std::vector<SpectralLine> lines() const override {
    std::vector<SpectralLine> out = spectrum->lines();
    for (SpectralLine& line : out) line = {line.wavelength_nm / g, line.strength / g};
    return out;
  }
  std::vector<double> knots() const override {
    std::vector<double> out = spectrum->knots();
    for (double& nm : out) nm /= g;
    return out;
  }
  bool is_linear() const override { return spectrum->is_linear(); }
  Band known() const override { return {spectrum->known().from / g, spectrum->known().to / g}; }
  std::array<double, 3> fold(const Sensor& sensor, double ratio) const override {
    return spectrum->fold(sensor, g * ratio);
  }
};

struct Product final : SpectralDistribution {
  AnySpectrum light, reflectance;
  Product(AnySpectrum of, AnySpectrum by) : light(std::move(of)), reflectance(std::move(by)) {}
  double at(double nm) const override { return light->at(nm) * reflectance->at(nm); }
  std::vector<SpectralLine> lines() const override {
    std::vector<SpectralLine> out;
    for (SpectralLine line : light->lines())
      out.push_back({line.wavelength_nm, line.strength * reflectance->at(line.wavelength_nm)});
    return out;
  }
  std::vector<double> knots() const override {
    std::vector<double> out = light->knots();
    append(out, reflectance->knots());
    return out;
  }
  Band known() const override {
    return {std::max(light->known().from, reflectance->known().from),
            std::min(light->known().to, reflectance->known().to)};
  }
};

/// Gauss and Legendre's points and weights on [-1, 1]: the upper half, the lower is its mirror image. Two
/// points are exact for linear spectra (times linear responses), six go with e^(+-2) across an interval to
/// 3e-9.
struct Rule {
  std::size_t half;
  std::array<double, 3> point, weight;
};
constexpr Rule kTwo = {1, {0.5773502691896257}, {1}},
               kSix = {3,
                       {0.2386191860831969, 0.6612093864662645, 0.9324695142031521},
                       {0.4679139345726910, 0.3607615730481386, 0.1713244923791704}};

/// Wavelengths between which both the response and the shifted spectrum are smooth.
std::vector<double> borders_of(const Sensor& sensor, std::vector<double> knots, double g) {
  std::vector<double> out;
  for (std::size_t i = 0; i < sensor.response.size(); ++i)
    out.push_back(sensor.first_nm + sensor.step_nm * static_cast<double>(i));
  const double first = g * out.front(), last = g * out.back();
  const auto middle = static_cast<std::ptrdiff_t>(out.size());
  std::ranges::sort(knots);
  for (auto knot = std::ranges::upper_bound(knots, first); knot != knots.end() && *knot < last; ++knot)
    out.push_back(*knot / g);
  std::inplace_merge(out.begin(), out.begin() + middle, out.end());
  return out;
}

}  // namespace

std::array<double, 3> SpectralDistribution::fold(const Sensor& sensor, double g) const {
  const std::vector<double> borders = borders_of(sensor, knots(), g);
  const Rule& rule = is_linear() ? kTwo : kSix;
  std::array<double, 3> out{};
  for (std::size_t i = 1; i < borders.size(); ++i) {
    const double half = 0.5 * (borders[i] - borders[i - 1]), middle = borders[i - 1] + half;
    if (!(half > 0)) continue;
    for (std::size_t k = 0; k < 2 * rule.half; ++k) {
      const std::size_t point = k / 2;
      const double nm = middle + (k % 2 == 0 ? -half : half) * rule.point[point];
      const double value = half * rule.weight[point] * at(g * nm);
      const auto seen = sensor.at(nm);
      for (std::size_t c = 0; c < 3; ++c) out[c] += value * seen[c];
    }
  }
  for (double& x : out) x = x < 1e-290 ? 0 : x;
  return out;
}

std::array<double, 3> fold_with_lines(const SpectralDistribution& spectrum, const Sensor& sensor, double g) {
  auto out = spectrum.fold(sensor, g);
  for (const SpectralLine& line : spectrum.lines()) {
    const auto seen = sensor.at(line.wavelength_nm / g);
    for (std::size_t c = 0; c < 3; ++c) out[c] += line.strength / g * seen[c];
  }
  return out;
}

AnySpectrum black_body(double temperature_K) { return std::make_shared<BlackBody>(temperature_K); }
AnySpectrum tabulated(std::vector<double> nm, std::vector<double> value, bool hold) {
  return std::make_shared<Tabulated>(std::move(nm), std::move(value), hold);
}
AnySpectrum line_list(std::vector<SpectralLine> lines) { return std::make_shared<Lines>(std::move(lines)); }
AnySpectrum constant(double value, Band band) { return std::make_shared<Constant>(value, band); }
AnySpectrum power_law(double value, double at_nm, double index) {
  return std::make_shared<PowerLaw>(value, at_nm, index);
}
AnySpectrum gaussian(double value, double centre_nm, double sigma_nm) {
  return std::make_shared<Gaussian>(value, centre_nm, sigma_nm);
}
AnySpectrum sum(std::vector<AnySpectrum> parts) { return std::make_shared<Sum>(std::move(parts)); }
AnySpectrum scaled(AnySpectrum spectrum, double factor) {
  return std::make_shared<Scaled>(std::move(spectrum), factor);
}
AnySpectrum shifted(AnySpectrum spectrum, double g) {
  return std::make_shared<Shifted>(std::move(spectrum), g);
}
AnySpectrum product(AnySpectrum light, AnySpectrum reflectance) {
  return std::make_shared<Product>(std::move(light), std::move(reflectance));
}

}  // namespace nullcone::postrender
