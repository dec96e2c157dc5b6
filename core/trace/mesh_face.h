// Which triangle of a mesh is the surface near a point, what it is like there, and on which side of the mesh
// a point is. One lane.
#pragma once

#include "core/trace/facet.h"
#include "core/trace/mesh_line.h"
#include "core/trace/mesh_triangle.h"

NULLCONE_KERNEL_BEGIN

/// A triangle, and the point of it by the parts of its second and third corner.
struct MeshFace {
  std::uint32_t triangle = 0;
  double second = 0, third = 0;
  double distance = kFar;  ///< of the point that is asked for
};

/// At most the distance of a box from a point in the tree's frame; endless for none.
inline float distance_of(const MeshNode& node, std::size_t box, const float* at) {
  float square = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const float below = node.low[a][box] - at[a], above = at[a] - node.high[a][box];
    const float off = below > above ? below : above;
    square += off > 0 ? off * off : 0;
  }
  return __builtin_sqrtf(square) * (1 - 1e-6F);
}

/// The triangle nearest to X; all lengths in the mesh's units.
inline MeshFace face_near(const MeshView& mesh, const Vec3<double>& X) {
  struct Waiting {
    std::uint32_t child;
    float distance;
  };
  Waiting stack[3 * Mesh::kMostDepth + 4];
  std::size_t top = 0;
  float at[3];
  for (std::size_t i = 0; i < 3; ++i) at[i] = static_cast<float>((X[i] - mesh.centre[i]) / mesh.half);
  MeshFace out;
  double least = kFar;
  float reach = 1e29F;  // of what may be nearer, in the tree's frame: less than of no box
  stack[top++] = {0, 0};
  while (top > 0) {
    const Waiting next = stack[--top];
    if (next.distance > reach) continue;
    if ((next.child & MeshNode::kLeaf) != 0) {
      const LeafRange leaf(next.child);
      for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
        const Nearest here(mesh.triangles[i], X);
        if (!(here.distance2 < least)) continue;
        least = here.distance2;
        out = {i, here.second, here.third, sqrt(least)};
        reach = static_cast<float>(out.distance / mesh.half * (1 + 1e-6) + kBoxSlack);
      }
      continue;
    }
    const MeshNode& node = mesh.nodes[next.child];
    const std::size_t base = top;
    for (std::size_t i = 0; i < 4; ++i) {
      const float distance = distance_of(node, i, at);
      if (distance > reach) continue;
      std::size_t k = top++;  // the nearest comes to the top
      for (; k > base && stack[k - 1].distance < distance; --k) stack[k] = stack[k - 1];
      stack[k] = {node.child[i], distance};
    }
  }
  return out;
}

/// The plane of a face near X, which is in the mesh's units; texture coordinates are shifted by whole numbers
/// so that those at X lie within 0 and 1.
inline FacetNumbers numbers_of(const MeshView& mesh, const MeshFace& face, const Vec3<double>& X) {
  const MeshTriangle& triangle = mesh.triangles[face.triangle];
  const Vec3<double> a = corner_of(triangle, 0), u = corner_of(triangle, 1) - a,
                     v = corner_of(triangle, 2) - a, n = cross(u, v);
  FacetNumbers out;
  const double over_size2 = 1 / dot(n, n);
  const Vec3<double> unit_normal = normalised(n), by_second = over_size2 * cross(v, n),
                     by_third = over_size2 * cross(n, u);
  for (std::size_t i = 0; i < 3; ++i) out.centre[i] = mesh.unit * a[i], out.linear[i] = unit_normal[i];
  if (mesh.uv == nullptr) return out;
  const auto& uv = mesh.uv[face.triangle].corner;
  const double second = dot(by_second, X - a), third = dot(by_third, X - a);
  for (std::size_t k = 0; k < 2; ++k) {
    const double first = static_cast<double>(uv[0][k]), to_second = static_cast<double>(uv[1][k]) - first,
                 to_third = static_cast<double>(uv[2][k]) - first;
    const double low = first + min(0.0, min(to_second, to_third)),
                 high = first + max(0.0, max(to_second, to_third));
    const double here = max(low, min(high, first + second * to_second + third * to_third));
    const double whole = here == high && high > low && floor(high) == high ? high - 1 : floor(here);
    (k == 0 ? out.at_u : out.at_v) = first - whole;
    (k == 0 ? out.range_u : out.range_v) = {max(low - whole, 0.0), min(high - whole, 1.0)};
    auto& by = k == 0 ? out.by_u : out.by_v;
    for (std::size_t i = 0; i < 3; ++i)
      by[i] = (to_second * by_second[i] + to_third * by_third[i]) / mesh.unit;
  }
  return out;
}

/// The same with the normal that is interpolated between the corners', on the outer side of the plane.
inline FacetNumbers shading_numbers_of(const MeshView& mesh, const MeshFace& face) {
  const MeshTriangle& triangle = mesh.triangles[face.triangle];
  const auto& normals = mesh.normals[face.triangle].corner;
  const Vec3<double> a = corner_of(triangle, 0),
                     n = cross(corner_of(triangle, 1) - a, corner_of(triangle, 2) - a);
  Vec3<double> shading{};
  for (std::size_t i = 0; i < 3; ++i)
    shading[i] = (1 - face.second - face.third) * static_cast<double>(normals[0][i]) +
                 face.second * static_cast<double>(normals[1][i]) +
                 face.third * static_cast<double>(normals[2][i]);
  const double along = dot(shading, n), length = norm(shading);
  FacetNumbers out;
  for (std::size_t i = 0; i < 3; ++i) out.centre[i] = mesh.unit * a[i];
  // Normals that cancel say nothing.
  const bool known = length > 1e-3;
  const Vec3<double> unit_normal = known ? ((along < 0 ? -1.0 : 1.0) / length) * shading : (1 / norm(n)) * n;
  for (std::size_t i = 0; i < 3; ++i) out.linear[i] = unit_normal[i];
  return out;
}

/// How often the surface of a closed mesh winds around X is not zero. By the crossings of a line from X; one
/// that passes through an edge is not asked.
inline bool winds_around(const MeshView& mesh, const Vec3<double>& X) {
  if (!mesh.closed) return false;
  for (std::size_t i = 0; i < 3; ++i)
    if (abs(X[i] - mesh.centre[i]) > mesh.half * (1 + 1e-9)) return false;
  int winding = 0;
  bool clear = false;
  for (int attempt = 0; attempt < 16 && !clear; ++attempt) {
    const double turn = 0.37 * attempt;
    const Vec3<double> W = {{0.5377 - turn, 0.6181 + 0.61 * turn, 0.5731 - 0.23 * turn}};
    MeshLine line(mesh, X, W);
    const Shear shear(line.foot, W);
    winding = 0, clear = true;
    line.look(0, kFar, 0);
    line.walk(mesh, [&](const LeafRange& leaf) {
      for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
        const Shear::Areas areas = shear.areas(mesh.triangles[i]);
        if (!areas.crossed()) continue;
        clear = clear && !areas.on_an_edge();
        const TrianglePlane plane(mesh.triangles[i], X, W);
        if (plane.ahead / plane.rate > 0) winding += plane.rate > 0 ? 1 : -1;
      }
      return !clear;
    });
  }
  return winding != 0;
}

NULLCONE_KERNEL_END
