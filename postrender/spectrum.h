// What of a surface's light is seen: the four combinations of effects, and exponents to compare with.
//
//   neither      L(lambda)           doppler alone  L(g lambda)
//   searchlight  g^4 L(lambda)       both           g^5 L(g lambda)   (docs/physics.md)
//
// g = observed / emitted frequency. Before pixels are shaded, each spectrum is folded with the sensor and
// multiplied by its power of g, over the range of g that the dataset holds: a table, whatever the spectrum,
// the sensor, the effects and the exponents. The pixel loops are in kernel_spectrum.h.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "postrender/image.h"
#include "postrender/spectral_distribution.h"
#include "postrender/spectral_view.h"

namespace nullcone::postrender {

/// How many powers of g beaming brings: of spectral quantities (where wavelengths are shifted too), and of
/// those that are integrated over all wavelengths.
struct Beaming {
  double spectral = 5, integrated = 4;
  bool operator==(const Beaming&) const = default;
};

struct Effects {
  bool doppler = true;      ///< wavelengths are shifted
  bool searchlight = true;  ///< radiance is beamed
  Beaming radiance;         ///< Weiskopf, Kraus and Ruder 1999, eqs. (14) and (15)
  Beaming irradiance;       ///< their eqs. (18) and (19), for light that falls on surfaces
  bool operator==(const Effects&) const = default;

  /// The power of g that multiplies L(g lambda) or L(lambda).
  double power() const { return power_of(radiance, doppler); }
  /// The power for what has no spectrum that could be shifted.
  double power_without_spectrum() const { return power_of(radiance, false); }
  /// The same of g from a lamp to a surface.
  double light_power() const { return power_of(irradiance, doppler); }
  double light_power_without_spectrum() const { return power_of(irradiance, false); }

 private:
  double power_of(const Beaming& of, bool spectral) const {
    return !searchlight ? 0 : spectral ? of.spectral : of.integrated;
  }
};

/// Whether a record's number can be a frequency ratio: positive and finite.
inline bool is_ratio(float g) { return g > 0 && g < std::numeric_limits<float>::infinity(); }

/// Frequency ratios from..to, both positive and finite.
struct ShiftRange {
  float from = 1, to = 1;
  bool operator==(const ShiftRange&) const = default;
};

/// One or three colours (linear sRGB) by g, by cubic interpolation between nodes that grow denser until the
/// error is below kTableError, or until they take kTableBytes.
class SpectralTable {
 public:
  /// Components beyond kBrightestEntry are scaled down to it, the three alike.
  using Colors = std::function<std::array<double, 3>(double g)>;
  SpectralTable(const std::vector<Colors>& colors, ShiftRange range);

  TableView view() const;
  /// The greatest error found between the samples, relative to the largest component of the colour there, or
  /// to a hundredth of the largest within half an octave of g, where that is more.
  double error() const { return error_; }
  std::size_t bytes() const { return nodes_.size() * sizeof(TableNode); }

 private:
  ShiftRange range_;
  std::int32_t unused_bits_ = 0, first_ = 0, stride_ = 1;
  std::vector<TableNode> nodes_;
  double error_ = 0;
};

inline constexpr double kTableError = 3e-8;
inline constexpr std::size_t kTableBytes = std::size_t{1} << 20;
inline constexpr double kBrightestEntry = 1e28;

/// Spectral lines, which no table resolves: each is looked up in the sensor's own curves.
struct LineTable {
  std::vector<TableLine> lines;
  double first_nm = 0, step_nm = 1;
  std::vector<std::array<double, 3>> response;  ///< of the sensor, in linear sRGB
  std::shared_ptr<const SpectralTable> power;   ///< of g

  /// `mixed`: of three spectra.
  LinesView view(bool mixed) const;
};

/// What is seen of a surface by g, times the colour of its texture.
struct Light {
  std::shared_ptr<const SpectralTable> table;  ///< null: the texture's colours as they are
  std::shared_ptr<const LineTable> lines;      ///< null: none
  bool physical = false;                       ///< in cd/m^2 (or the sensor's unit); else display colours
  bool operator==(const Light&) const = default;
};

}  // namespace nullcone::postrender
