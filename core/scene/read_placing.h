// Where things are and how large: events, velocities, worldlines, axes, as objects, lamps and observers have
// them.
#pragma once

#include <string_view>

#include "core/base/json.h"
#include "core/scene/scene.h"

namespace nullcone {

/// Coordinates, lengths and times beyond this lose all digits of what a picture shows.
inline constexpr double kLargest = 1e15;

constexpr Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Greater than 0 and at most kLargest.
double read_radius(JsonObject& shape);

Event read_event(JsonObject& object, std::string_view key);

/// Slower than light; at rest where the entry is left out.
Triple read_velocity(JsonObject& object, std::string_view key);

/// A direction of any length but zero, normalised.
Triple read_direction(JsonObject& object, std::string_view key, const std::vector<double>& fallback);

/// The entry `worldline` of something local.
Worldline read_worldline(JsonObject& object);

/// The entries `z_axis` and `y_axis`, which may be left out: rows x, y, z; y as near to `y_axis` as can be.
std::array<Triple, 3> read_directions(JsonObject& object);

/// The entries `axes` (of something local), `z_axis` and `y_axis`, which may all be left out; axes of what
/// moves are gyroscopes, if nothing is said.
void read_axes(JsonObject& object, Placing& placing, bool moves);

/// The entry `spin` of something local, which may be left out.
void read_spin(JsonObject& object, Placing& placing);

/// An object's `placing`, and how it moves.
void read_placing(JsonObject placing, Object& object);

}  // namespace nullcone
