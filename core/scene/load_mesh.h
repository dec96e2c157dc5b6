// Triangles from files of other programs.
#pragma once

#include <string>

#include "core/scene/mesh_tree.h"

namespace nullcone {

/// The triangles of a Wavefront OBJ file (polygons are cut into triangles; groups, materials, lines and
/// curves are passed over), times `scale`. Throws InputError with the line.
TriangleSoup load_obj(const std::string& path, double scale);

/// Those of the default scene of a glTF 2.0 file (.gltf with its files beside it, or .glb), where its nodes
/// put them. Images, materials, skins and animations are passed over.
TriangleSoup load_gltf(const std::string& path, double scale);

}  // namespace nullcone
