// What a look says about the legend on the picture, read strictly from JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/record/dataset.h"
#include "postrender/look_place.h"

namespace nullcone::postrender {

/// A bar of the colours that an object takes on by the ratio of observed to emitted frequency.
struct ScaleLook {
  std::string object;
  double from = 0.5, to = 2;
};

struct LegendLook {
  bool left = true, top = false;   ///< the corner
  int size = 0;                    ///< pixels a dot of the font; 0: by the height of the picture
  std::vector<std::string> lines;  ///< time and temperature
  std::optional<ScaleLook> scale;

  bool empty() const { return lines.empty() && !scale; }
};

/// `look` is the whole look, in which temperatures stand.
LegendLook parse_legend(JsonObject in, const LookSource& source, const nlohmann::json& look,
                        const Manifest& manifest);

}  // namespace nullcone::postrender
