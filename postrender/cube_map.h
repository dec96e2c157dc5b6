// Cube maps as textures of spheres and skies: six faces, looked up by direction.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "postrender/texture.h"

namespace nullcone::postrender {

/// As Faces<6> in core/base/faces.h has them: forward is +x, left +y, up +z.
inline constexpr std::array<const char*, 6> kCubeFaceNames = {"right", "left", "up", "down", "front", "back"};
using CubeFaces = std::array<TextureLevel, 6>;

/// Reads a strip of six square faces side by side (one file), or one face a file (six); `pointers` name the
/// entries of the look. Throws InputError as read_texture() does, and for other sizes.
CubeFaces read_cube_faces(const std::vector<std::string>& files, const std::vector<std::string>& pointers);

/// The faces and their halvings, level by level, each with a border of one texel so that bilinear look-ups
/// are continuous across edges and corners, and as exact there as elsewhere.
Pyramid make_cube(CubeFaces faces);

}  // namespace nullcone::postrender
