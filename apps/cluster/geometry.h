// The files of meshes, beside the folder's scene.
#pragma once

#include "apps/cluster/folder.h"
#include "core/base/include.h"

namespace nullcone::cluster {

/// Copies the files that a scene names with their hashes from beside it into the folder, under the same
/// names, unless they are there already. Throws InputError for files that are not of these hashes, and for
/// names of the folder's own.
void copy_meshes(const WholeJson& scene, const Folder& folder);

}  // namespace nullcone::cluster
