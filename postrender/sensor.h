// What turns spectra into three numbers: the eye's colour-matching functions, or a sensor's own curves.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "postrender/color.h"

namespace nullcone::postrender {

/// Three responses to light by wavelength, linear between equidistant samples, zero outside of them.
struct Sensor {
  std::string name;
  double first_nm = 0, step_nm = 0;
  std::vector<std::array<double, 3>> response;
  /// From the three integrals of response and spectral radiance (W m^-2 sr^-1 nm^-1) to linear sRGB: in
  /// cd/m^2 for the eye, for other sensors in units of their own that make equal energy white.
  Matrix3 to_rgb{};

  double last_nm() const { return first_nm + step_nm * static_cast<double>(response.size() - 1); }
  /// The responses at one wavelength.
  std::array<double, 3> at(double wavelength_nm) const;
  std::array<double, 3> rgb(const std::array<double, 3>& integrals) const;
};

/// The CIE 1931 standard observer, 2 degrees, 5 nm, linear between the samples; 683 lm/W.
const Sensor& standard_observer();

/// Sensors by name: "cie1931"; "rods" (CIE 1951 scotopic observer: grey); "ccd" (bare silicon, 300 to 1100
/// nm: grey); "infrared" (three bands, 780 to 1400 nm, shown as blue, green and red from short to long). Null
/// for other names.
std::shared_ptr<const Sensor> find_sensor(const std::string& name);
inline const std::vector<std::string> kSensorNames = {"cie1931", "rods", "ccd", "infrared"};

/// From a table of wavelengths (increasing) and one response (grey) or three (red, green, blue), resampled to
/// 1 nm unless its steps are equal. Each is scaled to see equal energy as 1.
Sensor make_sensor(std::string name, const std::vector<double>& wavelength_nm,
                   const std::vector<std::array<double, 3>>& response);

}  // namespace nullcone::postrender
