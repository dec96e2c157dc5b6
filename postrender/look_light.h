// What a look says about the light that falls on surfaces, read strictly from JSON.
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
  bool on = true;
  AppearanceLook light;                    ///< of its intensity; without a texture
  std::vector<TimeSliceLook> time_slices;  ///< the first that holds wins
  std::optional<std::set<int>> paths;      ///< of light to the surface, from 0; empty: all

  bool shines() const { return on && (!paths || !paths->empty()); }
  bool shines_along(int path) const { return on && (!paths || paths->contains(path)); }
};

/// The same radiance from everywhere, in the rest frame of each surface.
struct AmbientLook {
  double intensity = 1;   ///< a factor
  SpectrumLook spectrum;  ///< of its radiance
};

/// All lamps of the dataset, by name. Throws InputError for those that are not among them.
std::map<std::string, LampLook> parse_lamps(JsonObject in, const LookSource& source,
                                            const Manifest& manifest);

AmbientLook parse_ambient(JsonObject in, const LookSource& source);

}  // namespace nullcone::postrender
