// What a look says about objects: textures, spectra, and when they hold; read strictly from JSON.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "postrender/coats.h"
#include "postrender/emission.h"
#include "postrender/look_spectrum.h"
#include "postrender/look_stars.h"
#include "postrender/look_texture.h"

namespace nullcone::postrender {

inline constexpr double kMostIntense = 1e12;  ///< of a look's intensities

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

/// How a surface sends out light.
enum class SurfaceType {
  self_luminous,  ///< texture and spectrum are those of its own light
  lambertian      ///< it is lit: the texture is its albedo, the spectrum its reflectance
};

struct ObjectLook {
  AppearanceLook appearance;
  Number opacity{1};                       ///< times what is recorded; always 0 hides the object
  std::vector<TimeSliceLook> time_slices;  ///< the first that holds wins
  SurfaceType surface = SurfaceType::self_luminous;
  std::optional<StarsLook> stars;  ///< of a sky, before its texture

  bool is_lit() const { return surface == SurfaceType::lambertian && !opacity.always(0); }
};

/// The appearance `own`, which inherits what it leaves out.
AppearanceLook inherited(const AppearanceLook& own, const AppearanceLook& from);

/// What time slices and their owner say of light: all of an appearance but the texture.
AppearanceLook parse_light(JsonObject& in, const LookSource& source);
/// The slices under the key "time_slices"; `parse_appearance` reads what they have in place of their owner's.
std::vector<TimeSliceLook> parse_time_slices(
    JsonObject& in, const std::function<AppearanceLook(JsonObject&)>& parse_appearance);

ObjectLook parse_object(JsonObject in, const LookSource& source);

}  // namespace nullcone::postrender
