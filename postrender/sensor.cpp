#include "postrender/sensor.h"

#include <algorithm>
#include <cmath>

#include "postrender/cie1931.h"

namespace nullcone::postrender {

namespace {

constexpr double kEfficacy_lm_W = 683;

/// CIE 1951 scotopic luminous efficiency V'(lambda), 380 to 780 nm by 10 nm (CIE 018:2019, table 4).
constexpr std::array<double, 41> kScotopic = {
    5.89e-4,  2.209e-3, 9.29e-3,  3.484e-2, 9.66e-2,  0.1998,  0.3281,   0.455,    0.567,   0.676,    0.793,
    0.904,    0.982,    0.997,    0.935,    0.811,    0.650,   0.481,    0.3288,   0.2076,  0.1212,   6.55e-2,
    3.315e-2, 1.593e-2, 7.37e-3,  3.335e-3, 1.497e-3, 6.77e-4, 3.129e-4, 1.480e-4, 7.15e-5, 3.533e-5, 1.78e-5,
    9.14e-6,  4.78e-6,  2.546e-6, 1.379e-6, 7.60e-7,  4.25e-7, 2.413e-7, 1.39e-7};

/// Quantum efficiency of a front-illuminated silicon CCD without filters, 300 to 1100 nm by 50 nm: a typical
/// curve, good to a tenth or so.
constexpr std::array<double, 17> kSilicon = {0.02, 0.06, 0.14, 0.24, 0.33, 0.40, 0.44, 0.46, 0.45,
                                             0.42, 0.37, 0.30, 0.22, 0.13, 0.06, 0.02, 0.0};

std::array<double, 3> grey(double x) { return {x, x, x}; }

/// Scales each response so that equal energy (1 W m^-2 sr^-1 nm^-1) is seen as 1.
Sensor seeing_equal_energy_white(Sensor sensor) {
  std::array<double, 3> area{};
  for (std::size_t i = 0; i < sensor.response.size(); ++i) {
    const double width = i == 0 || i + 1 == sensor.response.size() ? sensor.step_nm / 2 : sensor.step_nm;
    for (std::size_t c = 0; c < 3; ++c) area[c] += width * sensor.response[i][c];
  }
  for (std::size_t c = 0; c < 3; ++c) sensor.to_rgb[c][c] = area[c] > 0 ? 1 / area[c] : 0;
  return sensor;
}

template <std::size_t n>
Sensor grey_sensor(const char* name, double first_nm, double step_nm, const std::array<double, n>& curve,
                   double (*weight)(double)) {
  Sensor out{name, first_nm, step_nm, {}, {}};
  for (std::size_t i = 0; i < n; ++i)
    out.response.push_back(grey(curve[i] * weight(first_nm + step_nm * static_cast<double>(i))));
  return seeing_equal_energy_white(std::move(out));
}

/// Photons, not watts: a quantum of longer wavelength carries less energy.
double per_watt(double nm) { return nm / 550; }
double as_it_is(double) { return 1; }

/// Three raised cosines that overlap by half.
Sensor infrared() {
  Sensor out{"infrared", 780, 10, {}, {}};
  const std::array<double, 3> centre_nm = {1230, 1050, 930}, half_width_nm = {170, 140, 150};
  for (double nm = 780; nm <= 1400; nm += 10) {
    std::array<double, 3> at{};
    for (std::size_t c = 0; c < 3; ++c) {
      const double x = (nm - centre_nm[c]) / half_width_nm[c];
      at[c] = std::fabs(x) < 1 ? 0.5 + 0.5 * std::cos(x * 3.14159265358979) : 0;
    }
    out.response.push_back(at);
  }
  return seeing_equal_energy_white(std::move(out));
}

}  // namespace

std::array<double, 3> Sensor::at(double wavelength_nm) const {
  const double x = (wavelength_nm - first_nm) / step_nm;
  const auto last = static_cast<double>(response.size() - 1);
  if (!(x >= 0 && x <= last)) return {};
  const auto i = std::min(static_cast<std::size_t>(x), response.size() - 2);
  std::array<double, 3> out;
  for (std::size_t c = 0; c < 3; ++c)
    out[c] = std::lerp(response[i][c], response[i + 1][c], x - static_cast<double>(i));
  return out;
}

std::array<double, 3> Sensor::rgb(const std::array<double, 3>& integrals) const {
  std::array<double, 3> out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) out[i] += to_rgb[i][j] * integrals[j];
  return out;
}

const Sensor& standard_observer() {
  static const Sensor observer = [] {
    Sensor out{"cie1931", kCmfFirst_nm, kCmfStep_nm, {kCie1931.begin(), kCie1931.end()}, xyz_to_srgb()};
    for (auto& sample : out.response)
      for (double& value : sample) value *= kEfficacy_lm_W;
    return out;
  }();
  return observer;
}

std::shared_ptr<const Sensor> find_sensor(const std::string& name) {
  if (name == "cie1931") return {std::shared_ptr<const Sensor>{}, &standard_observer()};
  if (name == "rods") return std::make_shared<Sensor>(grey_sensor("rods", 380, 10, kScotopic, as_it_is));
  if (name == "ccd") return std::make_shared<Sensor>(grey_sensor("ccd", 300, 50, kSilicon, per_watt));
  if (name == "infrared") return std::make_shared<Sensor>(infrared());
  return nullptr;
}

Sensor make_sensor(std::string name, const std::vector<double>& nm,
                   const std::vector<std::array<double, 3>>& response) {
  const double step = nm[1] - nm[0];
  bool equal = true;
  for (std::size_t i = 1; i < nm.size(); ++i) equal &= std::fabs(nm[i] - nm[i - 1] - step) < 1e-9 * nm[i];
  Sensor out{std::move(name), nm[0], equal ? step : 1.0, {}, {}};
  if (equal) {
    out.response = response;
  } else {
    const auto count = static_cast<std::size_t>(std::ceil(nm.back() - nm[0])) + 1;
    for (std::size_t i = 0, k = 0; i < count; ++i) {
      const double at = std::min(nm[0] + static_cast<double>(i), nm.back());
      while (k + 2 < nm.size() && nm[k + 1] < at) ++k;
      std::array<double, 3> sample;
      for (std::size_t c = 0; c < 3; ++c)
        sample[c] = std::lerp(response[k][c], response[k + 1][c], (at - nm[k]) / (nm[k + 1] - nm[k]));
      out.response.push_back(sample);
    }
  }
  return seeing_equal_energy_white(std::move(out));
}

}  // namespace nullcone::postrender
