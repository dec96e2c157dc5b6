// The look: all that may change after tracing, read strictly from JSON. The format is told in docs/look.md.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "core/record/dataset.h"
#include "postrender/look_appearance.h"
#include "postrender/look_develop.h"
#include "postrender/look_legend.h"
#include "postrender/look_light.h"
#include "postrender/pixel_filter.h"
#include "postrender/spectrum.h"

namespace nullcone::postrender {

struct Look {
  std::map<std::string, ObjectLook> objects;
  std::map<std::string, LampLook> lights;
  std::optional<AmbientLook> ambient;
  Effects effects;
  std::shared_ptr<const Sensor> sensor = find_sensor("cie1931");
  PixelFilter pixel_filter;
  DevelopLook develop;
  Rgb background;  ///< linear
  LegendLook legend;
};

/// Reads a look for the objects of `manifest`. Throws InputError with the JSON pointer for unknown keys,
/// wrong kinds, numbers out of range, and objects that the dataset does not have.
Look parse_look(const nlohmann::json& document, const LookSource& source, const Manifest& manifest);

}  // namespace nullcone::postrender
