// An object's shape: spheres, boxes, quads, the sky; other bodies, and what set operations make of them;
// meshes.
#pragma once

#include "core/base/json.h"
#include "core/scene/mesh_shelf.h"
#include "core/scene/read_scene.h"

namespace nullcone {

/// An object's `shape`; `scene` names the scene's file, beside which meshes are looked for that are not on
/// the shelf; of a mesh, `hashes` becomes what it was read from.
Shape read_shape(JsonObject shape, const MetricDescription& metric, const std::string& scene,
                 MeshShelf& meshes, MeshHashes& hashes);

}  // namespace nullcone
