#include "postrender/look_spectrum.h"

namespace nullcone::postrender {

SpectrumLook parse_spectrum(JsonObject in, const LookSource&) {
  SpectrumLook spectrum = DisplayLook{};
  if (in.word("type", {"display", "black_body"}) == "black_body")
    spectrum = BlackBodyLook{in.number("temperature_K", 1, 1e9)};
  in.finish();
  return spectrum;
}

}  // namespace nullcone::postrender
