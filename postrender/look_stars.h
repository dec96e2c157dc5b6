// What a look says of the stars of a sky, read strictly from JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "postrender/look_texture.h"
#include "postrender/star_catalogue.h"
#include "postrender/star_shading.h"

namespace nullcone::postrender {

struct StarsLook {
  std::string file, pointer;  ///< empty: no file
  std::vector<RandomStars> random;
  std::optional<Rotation> rotation;
  StarStyle style;
};

/// The stars under the key "stars" of an object, which must be a sky where the manifest tells.
StarsLook parse_stars(JsonObject& object, const LookSource& source);

/// Equal for equal stars, files as they are now included.
std::string key_of(const StarsLook& look);
/// Throws InputError as read_stars() does.
StarField make_stars(const StarsLook& look);

}  // namespace nullcone::postrender
