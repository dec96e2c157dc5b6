// Triangles from files of other programs.
#pragma once

#include <string>

#include "core/scene/mesh_hashes.h"
#include "core/scene/mesh_tree.h"

namespace nullcone {

struct LoadedMesh {
  TriangleSoup soup;
  MeshHashes hashes;
};

/// The triangles of a Wavefront OBJ file (polygons are cut into triangles; groups, materials, lines and
/// curves are passed over), times `scale`. Throws InputError with the line.
LoadedMesh load_obj(const std::string& path, double scale);

/// Those of the default scene of a glTF 2.0 file (.gltf with its files beside it, or .glb), where its nodes
/// put them. Images, materials, skins and animations are passed over.
LoadedMesh load_gltf(const std::string& path, double scale);

}  // namespace nullcone
