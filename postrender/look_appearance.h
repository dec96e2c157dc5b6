// What a look says about objects: textures, spectra, and when they hold; read strictly from JSON.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "postrender/look_spectrum.h"
#include "postrender/texture.h"

namespace nullcone::postrender {

/// An image that is yet to be read.
struct ImageLook {
  std::string file;     ///< resolved against the folder of the look
  std::string pointer;  ///< "/objects/earth/texture/file", for complaints
  UvTransform uv;
  bool mipmap = true;
  bool alpha = false;  ///< the picture's alpha counts
};
using TextureLook = std::variant<ColorTexture, CheckerboardTexture, ImageLook>;

/// What is left out is inherited: by a time slice from its object, by an object from the default look.
struct AppearanceLook {
  std::optional<TextureLook> texture;
  std::optional<SpectrumLook> spectrum;
};

/// Another appearance from `from` (included) to `to` (excluded).
struct TimeSliceLook {
  bool own_clock = false;  ///< false: channel t; true: the object's proper time, tau + tau_origin
  double from = 0, to = 0;
  AppearanceLook appearance;
};

struct ObjectLook {
  AppearanceLook appearance;
  double opacity = 1;                      ///< times what is recorded; 0 hides the object
  std::vector<TimeSliceLook> time_slices;  ///< the first that holds wins
};

/// The appearance `own`, which inherits what it leaves out.
AppearanceLook inherited(const AppearanceLook& own, const AppearanceLook& from);

ObjectLook parse_object(JsonObject in, const LookSource& source);

}  // namespace nullcone::postrender
