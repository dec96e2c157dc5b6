// What is seen of lamps on Lambertian surfaces.
//
// Weiskopf, Kraus and Ruder 1999, eqs. (14) and (18): a surface of albedo rho sends out
// L(lambda) = rho(lambda)/pi E g_l^5 I(g_l lambda) for each path of light to it, g_l = at the surface / at
// the lamp, and g^5 L(g lambda) of that is seen. Where rho does not depend on the wavelength, both ratios
// come in by their product alone, so that one table of the lamp's light by g g_l is enough; other exponents
// of g_l are made up for by a power of it.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "postrender/emission.h"
#include "postrender/light_tables.h"
#include "postrender/lit_table.h"
#include "postrender/shift_ranges.h"

namespace nullcone::postrender {

/// A line of a lamp on a surface that reflects each wavelength differently.
struct ReflectedLine {
  std::shared_ptr<const LineTable> line;             ///< by the product of both ratios
  std::shared_ptr<const SpectralTable> reflectance;  ///< at the line, by g_light, in all three components
};

/// What is seen of a lamp on a surface that reflects each wavelength differently.
struct SpectralReflection {
  LitTable table;
  std::vector<ReflectedLine> lines;
};

/// What is seen of a lamp on a surface: per W m^-2 of its irradiance over pi, times the texture's colour.
struct Reflection {
  Light light;                                         ///< by the product of both ratios
  std::shared_ptr<const SpectralReflection> spectral;  ///< in place of light's tables
  double power = 0, light_power = 0;  ///< of g and of g_light: what the tables do not have in them
  bool doppler = true;                ///< whether wavelengths are shifted

  bool operator==(const Reflection&) const = default;
};

/// The light of a lamp.
struct LampSpectrum {
  SpectrumLook spectrum;
  std::optional<ChangingTemperature> temperature;  ///< then `spectrum` is that of the reference
};

/// Makes reflections and keeps their tables from one look to the next.
class ReflectionTables {
 public:
  /// Of an object whose crossings have ratios within `shifts`, and `from_lamp` on their way from the lamp.
  /// `reflectance` may be null: white. Equal questions get equal answers.
  Reflection get(LightTables& lights, const LampSpectrum& lamp, const SpectrumLook* reflectance,
                 const Effects& effects, const Sensor& sensor, ShiftRange shifts,
                 const LightShifts& from_lamp);

  /// Forgets what nobody else holds, while it takes more than `most_bytes` together.
  void prune(std::size_t most_bytes = std::size_t{64} << 20);

 private:
  std::map<std::string, std::shared_ptr<const SpectralReflection>> entries_;
};

/// The same light after a surface has reflected it, without any shift between them.
SpectrumLook reflected(const SpectrumLook& light, const SpectrumLook& reflectance);

}  // namespace nullcone::postrender
