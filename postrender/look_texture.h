// What a look says about textures, read strictly from JSON.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "postrender/look_place.h"
#include "postrender/placement.h"
#include "postrender/texture.h"

namespace nullcone::postrender {

/// An image that is yet to be read.
struct ImageLook {
  std::string file;     ///< resolved against the folder of the look
  std::string pointer;  ///< "/objects/earth/texture/file", for complaints
  UvTransform uv;
  Filter filter = Filter::mipmap;
  bool alpha = false;  ///< the picture's alpha counts
  MaterialGroup materials;
};

/// A cube map that is yet to be read: one file, or six in the order of kCubeFaceNames.
struct CubeLook {
  std::vector<std::string> files, pointers;
  Filter filter = Filter::mipmap;
};

/// A MovingTexture whose images are yet to be read.
struct MovingLook {
  std::optional<Placement> placement;
  Timeline timeline;
  std::vector<std::variant<ColorTexture, CheckerboardTexture, ImageLook, CubeLook>> frames;
};
using TextureLook = std::variant<ColorTexture, CheckerboardTexture, ImageLook, CubeLook, MovingLook>;

/// Whether it tells materials, not colours.
bool is_of_materials(const TextureLook& texture);
/// The same of three of `count` materials.
TextureLook of_materials(TextureLook texture, MaterialGroup group);

/// The rotation under the key "rotate_deg".
Rotation parse_rotation(JsonObject& in, const LookSource& source);

/// The texture under the key "texture".
TextureLook parse_texture(JsonObject& in, const LookSource& source);

}  // namespace nullcone::postrender
