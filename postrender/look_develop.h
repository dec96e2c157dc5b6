// What a look says about developing: exposure, tone curve, gamut, white point, output; read strictly from
// JSON.
#pragma once

#include <optional>

#include "core/base/json.h"
#include "postrender/color_space.h"
#include "postrender/look_place.h"
#include "postrender/tone.h"

namespace nullcone::postrender {

/// How the white is found where it is not given.
struct AutoWhite {
  enum class Mode { percentile, log_average } mode = Mode::percentile;
  double percentile = 99;
  double key = 0.18;  ///< what the geometric mean of the luminances is shown as
  bool operator==(const AutoWhite&) const = default;
};

struct DevelopLook {
  std::optional<double> white_cd_m2;  ///< empty: found by auto_white
  AutoWhite auto_white;
  double ev = 0;
  enum class Curve { linear, exponential, filmic, table } curve = Curve::linear;
  double k = 1;               ///< of the exponential curve
  double filmic_white = 5.6;  ///< the exposed luminance that the filmic curve shows as 1
  ToneTable table;
  enum class Gamut { hue_preserving, clip } gamut = Gamut::hue_preserving;
  Chromaticity white_point = kD65;  ///< the colour of light that is shown as the screen's white
  Output output;
  bool operator==(const DevelopLook&) const = default;
};

/// Reads the entries of a look that concern development: exposure, tone, gamut, white_point, output.
DevelopLook parse_develop(JsonObject& look, const LookSource& source);

}  // namespace nullcone::postrender
