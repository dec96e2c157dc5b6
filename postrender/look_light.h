// What a look says about lamps, read strictly from JSON.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/record/dataset.h"
#include "postrender/look_appearance.h"

namespace nullcone::postrender {

/// A lamp of the scene. Whatever changes with time goes by the lamp's clock at the emission of its light.
struct LampLook {
  Number intensity{1};  ///< a factor, >= 0
  std::optional<Blink> blink;
  SpectrumLook spectrum;               ///< of its light
  std::optional<std::set<int>> paths;  ///< of light to the surface, from 0; empty: all
};

/// Lamps by name. Throws InputError for those that are not among `lamps`.
std::map<std::string, LampLook> parse_lamps(JsonObject in, const LookSource& source,
                                            const std::vector<ObjectEntry>& lamps);

}  // namespace nullcone::postrender
