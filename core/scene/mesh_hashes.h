// Which files a mesh was read from, by their content.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/base/json.h"

namespace nullcone {

/// SHA-256, in hexadecimal digits, of the bytes that were read.
struct MeshHashes {
  std::string file;
  std::map<std::string, std::string>
      buffers;  ///< of files beside a glTF file, by the names that it gives them
};

/// Reads a shape's entries `sha256` and `buffers`, and refuses what was read where they name other files.
/// Throws InputError.
void check_hashes(JsonObject& shape, const MeshHashes& found);

/// Puts them into a shape's JSON under these entries: such a scene traces again from the same files alone.
void pin_hashes(nlohmann::json& shape, const MeshHashes& found);

}  // namespace nullcone
