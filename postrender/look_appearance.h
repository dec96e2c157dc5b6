// What a look says about objects: textures, spectra, and when they hold; read strictly from JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "postrender/coats.h"
#include "postrender/emission.h"
#include "postrender/look_spectrum.h"
#include "postrender/look_texture.h"

namespace nullcone::postrender {

/// A spectrum whose numbers change with the time of emission: either its temperature does, or it is one of
/// several after the other.
struct SpectrumInTime {
  std::optional<Number> temperature_K;  ///< of a black body
  double reference_K = 1;               ///< that of the spectrum itself
  Timeline timeline;
  std::vector<SpectrumLook> nodes;  ///< empty: the spectrum alone
};

/// What is left out is inherited: by a time slice from its object, by an object from the default look.
struct AppearanceLook {
  std::optional<TextureLook> texture;
  std::optional<SpectrumLook> spectrum;
  SpectrumInTime spectrum_in_time;  ///< belongs to `spectrum`
  std::optional<Number> intensity;
  std::optional<Blink> blink;

  bool empty() const { return !texture && !spectrum && !intensity && !blink; }
};

/// Another appearance from `from` (included) to `to` (excluded).
struct TimeSliceLook {
  Slice when;  ///< without its appearance
  AppearanceLook appearance;
};

struct ObjectLook {
  AppearanceLook appearance;
  Number opacity{1};                       ///< times what is recorded; always 0 hides the object
  std::vector<TimeSliceLook> time_slices;  ///< the first that holds wins
};

/// The appearance `own`, which inherits what it leaves out.
AppearanceLook inherited(const AppearanceLook& own, const AppearanceLook& from);

/// A lamp that goes on and off.
Blink parse_blink(JsonObject in, const LookSource& source);

ObjectLook parse_object(JsonObject in, const LookSource& source);

}  // namespace nullcone::postrender
