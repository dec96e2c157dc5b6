// Meshes of triangles, with the tree of boxes in which rays look for them. Plain data.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace nullcone {

/// Corners in units of Mesh::unit. Each triangle has its own: the search reads them side by side.
struct MeshTriangle {
  double corner[3][3];
};
struct MeshUv {
  float corner[3][2];
};
struct MeshNormals {
  float corner[3][3];
};

/// Four boxes side by side, in the tree's frame, in which the whole mesh lies within [-1, 1]; and what is in
/// them: the number of a node, or some triangles.
struct alignas(64) MeshNode {
  static constexpr std::uint32_t kLeaf = 0x80000000, kMostInLeaf = 4;

  float low[3][4], high[3][4];  ///< low > high: no box
  std::uint32_t child[4];

  static std::uint32_t leaf(std::uint32_t first, std::uint32_t count) {
    return kLeaf | (count - 1) << 29 | first;
  }
};

struct Mesh {
  static constexpr std::size_t kMostTriangles = std::size_t{1} << 24;
  static constexpr int kMostDepth = 64;  ///< of the tree

  std::vector<MeshTriangle> triangles;  ///< in the order of the leaves
  std::vector<MeshUv> uv;               ///< by triangle; empty: none
  std::vector<MeshNormals> normals;     ///< by triangle, of any length; empty: those of the planes
  std::vector<MeshNode> nodes;          ///< the first is the root
  double unit = 1;                      ///< a power of two, about the mesh's size: lengths are near 1 in it
  std::array<double, 3> centre{};       ///< of the tree's frame, in units
  double half = 1;                      ///< extent of the tree's frame, in units
  double ball = 0;                      ///< radius of a ball about the origin that holds it; a true length
  bool closed = false;        ///< every edge in two triangles, which run along it in opposite directions
  std::size_t flattened = 0;  ///< triangles without an area, which were left out
};

}  // namespace nullcone
