// Textures from picture files, by OpenImageIO.
#pragma once

#include <string>

#include "postrender/texture.h"

namespace nullcone::postrender {

inline constexpr int kLargestTextureSide = 32768;
inline constexpr std::size_t kLargestTextureBytes = std::size_t{1} << 30;  ///< of linear floats, 12 a texel

/// Reads JPEG, PNG, TIFF, OpenEXR or Radiance HDR, told apart by their first bytes, never by the name. 8 and
/// 16 bit images are decoded from sRGB, float images are taken as linear. Grey is spread. Without `alpha` the
/// picture's own is ignored; with it, it is taken as straight, but for OpenEXR, whose colours are multiplied
/// by it already, and a picture that has none is refused. `pointer` ("/objects/earth/texture/file") stands in
/// complaints. Throws InputError "file: pointer: ..." for whatever is not such a picture, is cut off, or is
/// larger than the limits above.
TextureLevel read_texture(const std::string& path, const std::string& pointer, bool alpha = false);

/// Reads an 8 bit picture of materials: red is the number of one (from 0), green how much of it there is (of
/// 255; all of it in pictures without green). Numbers from `group.count` on are refused. Otherwise like
/// read_texture().
TextureLevel read_materials(const std::string& path, const std::string& pointer, MaterialGroup group);

}  // namespace nullcone::postrender
