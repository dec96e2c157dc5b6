// From spectra, effects and a sensor to tables by g.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "postrender/look_spectrum.h"
#include "postrender/spectrum.h"

namespace nullcone::postrender {

/// Makes what pixels need of a spectrum, and keeps it from one look to the next.
class LightTables {
 public:
  /// The light of `look` by g within `range`. Equal questions get equal answers.
  Light get(const SpectrumLook& look, const Effects& effects, const Sensor& sensor, ShiftRange range);

  /// Forgets tables that nobody else holds, while they take more than `most_bytes` together.
  void prune(std::size_t most_bytes = std::size_t{64} << 20);

 private:
  std::map<std::string, Light> entries_;
};

/// Which wavelengths a look needs of a spectrum and does not have (Borchers 2005, eq. 2.14), as a sentence;
/// empty if none.
std::string unknown_wavelengths(const SpectrumLook& look, const Effects& effects, const Sensor& sensor,
                                ShiftRange range);

/// The colours (linear sRGB) of a spectrum's continuous part by g: what SpectralTable interpolates.
SpectralTable::Colors continuous_colors(AnySpectrum spectrum, const Effects& effects, const Sensor& sensor);
/// With lines, for tests and single colours.
std::array<double, 3> seen_color(const SpectralDistribution& spectrum, const Effects& effects,
                                 const Sensor& sensor, double g);

}  // namespace nullcone::postrender
