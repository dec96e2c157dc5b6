// Where on a surface its texture lies: rotated, scaled, moved; by the time of emission, if asked to.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "postrender/rotation.h"

namespace nullcone::postrender {

/// Looked up at (rotated u, v) * scale + offset.
struct Placement {
  std::optional<Rotation> rotation = {};
  std::array<Number, 2> offset = {}, scale = {Number{1}, Number{1}};

  /// The same as a plain transform, if it is one: nothing changes, and nothing turns the poles.
  std::optional<UvTransform> plain() const;
  Clocks clocks() const;
  bool operator==(const Placement&) const = default;
};

/// Texture coordinates of a segment and its steps, which may be absent (null).
struct Coordinates {
  std::size_t count;
  float *u, *v;
  Footprints steps;
  bool recorded;  ///< steps are derivatives; else differences to neighbours
};

/// Moves coordinates and steps, in place. u comes back within [0, 1], v as it is; each pixel at its own time,
/// of which there must be `count` if anything changes. Steps do not count what moves between the emission of
/// neighbouring pixels.
void place(const Placement& placement, std::span<const Times> times, const Coordinates& out);

}  // namespace nullcone::postrender
