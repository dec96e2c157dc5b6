// What a look says about spectra, read strictly from JSON.
#pragma once

#include <variant>

#include "postrender/look_place.h"

namespace nullcone::postrender {

struct DisplayLook {};
struct BlackBodyLook {
  double temperature_K = 0;
};
using SpectrumLook = std::variant<DisplayLook, BlackBodyLook>;

SpectrumLook parse_spectrum(JsonObject in, const LookSource& source);

}  // namespace nullcone::postrender
