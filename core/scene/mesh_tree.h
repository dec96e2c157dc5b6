// From triangles to a Mesh: who neighbours whom, and a tree of boxes.
#pragma once

#include "core/scene/mesh.h"

namespace nullcone {

/// Triangles as files have them.
struct TriangleSoup {
  static constexpr std::uint32_t kNone = UINT32_MAX;

  std::vector<std::array<double, 3>> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< numbers of positions, all within range
  std::vector<MeshUv> uv;                               ///< by triangle, or empty
  std::vector<MeshNormals> normals;                     ///< by triangle, or empty
};

/// Merges equal positions, leaves out triangles without an area (the mesh may then be empty), and builds the
/// tree. Positions are finite, and at most 1e15.
Mesh make_mesh(TriangleSoup soup);

}  // namespace nullcone
