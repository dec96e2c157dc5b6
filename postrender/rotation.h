// Textures rotated on the sphere.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "postrender/changing.h"
#include "postrender/kernel.h"

namespace nullcone::postrender {

/// A rotation of a sphere's texture, right-handed, in degrees: about the fixed axes x, then y, then z; or
/// about one axis of any direction. What the texture shows at direction p is seen at R p.
struct Rotation {
  std::array<Number, 3> about_deg = {};            ///< x, y, z; with `axis`: the angle alone, first
  std::optional<std::array<double, 3>> axis = {};  ///< of length 1

  /// Whether it only ever turns about z: then longitudes move, and nothing else.
  bool about_z() const;
  /// How far, within [0, 1) of a turn towards +u; of a rotation about z.
  double turn(const Times& times) const;
  bool changes() const;
  /// Takes directions where they are seen to those in the texture (the transpose of R), row by row.
  std::array<float, 9> to_texture(const Times& times) const;
  bool operator==(const Rotation&) const = default;
};

/// Matrices of a segment, entry by entry: one for all pixels, or one each.
struct Matrices {
  std::array<float, 9> all;
  const std::array<std::array<float, kSegment>, 9>* each = nullptr;
};

/// At most kSegment texture coordinates on a sphere (shapes.h): u the longitude, 1/2 at +x and growing
/// towards +y; v the latitude, 0 at -z. Rotated in place with the steps to neighbouring pixels: `recorded`
/// ones as derivatives, others as differences. Steps of kFarthest or more stay unknown. Errors: 2e-7 of a
/// direction. What is not finite counts as 0. `steps` may hold null pointers: then there are none.
void rotate(const Matrices& matrices, std::size_t count, float* u, float* v, const Footprints& steps,
            bool recorded);

}  // namespace nullcone::postrender
