// Solids: closed bodies and what set operations make of them; and surfaces without an inside. Plain data.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace nullcone {

enum class PrimitiveType {
  ellipsoid,
  cylinder,  ///< with both caps
  box,
  tube,  ///< a cylinder without caps
  disk,  ///< or ring, in its xy plane
};

/// A body about the origin of a frame of its own, which stands in that of the solid.
struct Primitive {
  PrimitiveType type = PrimitiveType::ellipsoid;
  std::array<double, 3> centre = {0, 0, 0};
  /// Rows: its x, y and z axes; orthonormal.
  std::array<std::array<double, 3>, 3> axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  /// Half of its extent along each axis; of a disk, 1 along z.
  std::array<double, 3> half = {1, 1, 1};
  double hole = 0;  ///< ring: inner over outer radius

  bool closed() const { return type != PrimitiveType::tube && type != PrimitiveType::disk; }
};

enum class Join { take, unite, intersect, subtract };

/// What is done in postfix order: take a primitive on the stack, or join the two on top of it; `subtract`
/// takes the upper from the lower.
struct SolidStep {
  Join join = Join::take;
  std::uint32_t primitive = 0;
  bool taken_away = false;  ///< taken: an odd number of subtractions take it from the solid
};

/// Closed primitives, joined; or one that is not closed, alone.
struct Solid {
  static constexpr std::size_t kMostPrimitives = 64, kMostDepth = 16;

  std::vector<Primitive> primitives;
  std::vector<SolidStep> steps;
  double ball = 0;  ///< radius of a ball about the origin that holds it

  bool closed() const { return primitives.size() > 1 || primitives.front().closed(); }
};

}  // namespace nullcone
