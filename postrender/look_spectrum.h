// What a look says about spectra, read strictly from JSON.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "postrender/look_place.h"
#include "postrender/spectral_distribution.h"

namespace nullcone::postrender {

struct SpectrumLook {
  enum class Kind {
    display,         ///< the texture's colours, without a spectrum
    total_radiance,  ///< their luminance, as a total over all wavelengths: grey
    filtered,        ///< one spectrum behind the texture as a filter
    mixed,           ///< each component of the texture is the amount of one of three spectra
    materials,       ///< the texture tells amounts of any number of spectra
  } kind = Kind::display;
  bool physical = false;             ///< in cd/m^2
  std::vector<AnySpectrum> spectra;  ///< of `filtered` one, of `mixed` three
  std::string key;                   ///< equal for equal spectra, files included
};

/// Three of the spectra of materials from `first` on, dark ones where there are no more.
SpectrumLook three_materials(const SpectrumLook& materials, std::size_t first);

/// Throws InputError; files are read.
SpectrumLook parse_spectrum(JsonObject in, const LookSource& source);

/// A sensor by name, or {"file": CSV with wavelength_nm and one or three responses}.
std::shared_ptr<const Sensor> parse_sensor(JsonObject& look, std::string_view key, const LookSource& source);

}  // namespace nullcone::postrender
