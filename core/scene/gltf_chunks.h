// glTF files before the loader sees them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "core/scene/mesh_file.h"

namespace nullcone {

/// The JSON of a file, and its own buffer (.glb).
struct GltfChunks {
  std::string json;
  std::string_view binary;  ///< within the bytes that were given
};
GltfChunks chunks_of(const std::string& bytes, const MeshFile& file);

/// A .glb again, as short as can be.
std::string joined_glb(std::string json, std::string_view binary);

/// Takes away what is not looked at, and refuses what would only fill memory.
void prune_gltf(nlohmann::json& document, const MeshFile& file);

}  // namespace nullcone
