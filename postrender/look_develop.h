// What a look says about developing: exposure, tone curve, gamut; read strictly from JSON.
#pragma once

#include <optional>

#include "core/base/json.h"

namespace nullcone::postrender {

struct DevelopLook {
  std::optional<double> white_cd_m2;  ///< empty: "auto"
  double ev = 0;
  enum class Curve { linear, exponential } curve = Curve::linear;
  double k = 1;
  enum class Gamut { hue_preserving, clip } gamut = Gamut::hue_preserving;
};

/// Reads the entries of a look that concern development: exposure, tone, gamut.
DevelopLook parse_develop(JsonObject& look);

}  // namespace nullcone::postrender
