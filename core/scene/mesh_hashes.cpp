#include "core/scene/mesh_hashes.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace nullcone {

namespace {

void check_hash(JsonObject& entry, const std::string& file, const std::string& found) {
  const std::string expected = entry.text("sha256");
  const auto is_digit = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  if (expected.size() != 64 || !std::ranges::all_of(expected, is_digit))
    entry.refuse("sha256", "expected 64 digits 0-9 and a-f, as sha256sum prints them");
  if (expected != found)
    entry.refuse("sha256", "the file '" + printable(file) + "' is another: expected SHA-256 " + expected +
                               ", found " + found);
}

}  // namespace

void check_hashes(JsonObject& shape, const MeshHashes& found) {
  if (shape.has("sha256")) check_hash(shape, shape.text("file"), found.file);
  if (!shape.has("buffers")) return;
  for (JsonObject& buffer : shape.objects("buffers")) {
    const std::string name = buffer.text("file");
    const auto read = found.buffers.find(name);
    if (read == found.buffers.end())
      buffer.refuse("file", "the mesh has no buffer '" + printable(name) + "'");
    check_hash(buffer, name, read->second);
    buffer.finish();
  }
}

void pin_hashes(nlohmann::json& shape, const MeshHashes& found) {
  shape["sha256"] = found.file;
  shape.erase("buffers");
  for (const auto& [name, hash] : found.buffers)
    shape["buffers"].push_back({{"file", name}, {"sha256", hash}});
}

}  // namespace nullcone
