// The look: all that may change after tracing, read strictly from JSON. The format is told in docs/look.md.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/record/dataset.h"
#include "postrender/pixel_filter.h"
#include "postrender/spectrum.h"
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

struct DisplayLook {};
struct BlackBodyLook {
  double temperature_K = 0;
};
using SpectrumLook = std::variant<DisplayLook, BlackBodyLook>;

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

struct DevelopLook {
  std::optional<double> white_cd_m2;  ///< empty: "auto"
  double ev = 0;
  enum class Curve { linear, exponential } curve = Curve::linear;
  double k = 1;
  enum class Gamut { hue_preserving, clip } gamut = Gamut::hue_preserving;
};

struct Look {
  std::map<std::string, ObjectLook> objects;
  Effects effects;
  PixelFilter pixel_filter;
  DevelopLook develop;
  Rgb background;  ///< linear
};

/// The appearance `own`, which inherits what it leaves out.
AppearanceLook inherited(const AppearanceLook& own, const AppearanceLook& from);

/// A look as JSON and where it came from.
struct LookSource {
  std::string place;    ///< a file's name, for complaints
  std::string pointer;  ///< of the look inside that file: "" or "/look"
  std::string folder;   ///< relative texture files are resolved against this
};

/// Reads a look for the objects of `manifest`. Throws InputError with the JSON pointer for unknown keys,
/// wrong kinds, numbers out of range, and objects that the dataset does not have.
Look parse_look(const nlohmann::json& document, const LookSource& source, const Manifest& manifest);

}  // namespace nullcone::postrender
