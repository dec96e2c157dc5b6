// Meshes of triangles, from files of other programs.
#pragma once

#include <memory>
#include <string>

#include "core/base/json.h"
#include "core/scene/mesh_shelf.h"

namespace nullcone {

/// The mesh that a shape of type "mesh" describes; `scene` names the scene's file, and the mesh's stands in
/// the same folder or below it; unless it is on the shelf. `hashes` becomes what it was read from. The caller
/// reads `dome`, and finishes the shape.
std::shared_ptr<const Mesh> read_mesh(JsonObject& shape, const std::string& scene, MeshShelf& shelf,
                                      MeshHashes& hashes);

}  // namespace nullcone
