// Spectra: radiance or reflectance by wavelength, and what a sensor sees of them when they are shifted.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <vector>

#include "postrender/sensor.h"

namespace nullcone::postrender {

struct SpectralLine {
  double wavelength_nm, strength;  ///< W m^-2 sr^-1
};

/// Wavelengths from..to in nm.
struct Band {
  double from = 0, to = std::numeric_limits<double>::infinity();
};

/// A spectral radiance in W m^-2 sr^-1 nm^-1 (or a reflectance, a pure number): a continuous part and lines.
class SpectralDistribution {
 public:
  virtual ~SpectralDistribution() = default;

  /// The continuous part; not negative, finite. `wavelength_nm` > 0.
  virtual double at(double wavelength_nm) const = 0;
  virtual std::vector<SpectralLine> lines() const { return {}; }
  /// Wavelengths between which the continuous part is smooth: analytic, and slow against the distance of two
  /// of them (or against its wavelength).
  virtual std::vector<double> knots() const { return {}; }
  /// Between knots at most linear.
  virtual bool is_linear() const { return false; }
  /// Where it is known; beyond, at() is a guess.
  virtual Band known() const { return {}; }

  /// The integrals over wavelength of L(g lambda) with the sensor's responses, g > 0 (Borchers 2005, eq.
  /// 2.17, X_ij(D)), without lines. Relative error below 1e-7 for what is smooth between knots; below 1e-290
  /// it is 0.
  virtual std::array<double, 3> fold(const Sensor& sensor, double g) const;
};
using AnySpectrum = std::shared_ptr<const SpectralDistribution>;

/// The same with the lines: a line at mu is seen at mu/g with 1/g of its strength.
std::array<double, 3> fold_with_lines(const SpectralDistribution& spectrum, const Sensor& sensor, double g);

// The kinds of spectra, in W m^-2 sr^-1 nm^-1.

/// Planck's law.
AnySpectrum black_body(double temperature_K);
/// Linear between samples (increasing wavelengths); beyond them 0, or the last value held.
AnySpectrum tabulated(std::vector<double> wavelength_nm, std::vector<double> value, bool hold);
AnySpectrum line_list(std::vector<SpectralLine> lines);
/// `value` from..to, else 0.
AnySpectrum constant(double value, Band band = {});
/// value (lambda / at_nm)^index.
AnySpectrum power_law(double value, double at_nm, double index);
/// value exp(-(lambda - centre)^2 / (2 sigma^2)).
AnySpectrum gaussian(double value, double centre_nm, double sigma_nm);
AnySpectrum sum(std::vector<AnySpectrum> parts);
AnySpectrum scaled(AnySpectrum spectrum, double factor);
/// L(g lambda): what is left of the power to the effects. Lines move to mu/g, with 1/g of their strength.
AnySpectrum shifted(AnySpectrum spectrum, double g);
/// Light on a surface: the product. At most one of the two may have lines.
AnySpectrum product(AnySpectrum light, AnySpectrum reflectance);

}  // namespace nullcone::postrender
