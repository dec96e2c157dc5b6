#include "core/scene/gltf_chunks.h"

#include <cstring>
#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace nullcone {

namespace {

std::uint32_t little(const std::string& bytes, std::size_t at) {
  std::uint32_t out;
  std::memcpy(&out, bytes.data() + at, 4);
  return out;
}

}  // namespace

GltfChunks chunks_of(const std::string& bytes, const MeshFile& file) {
  if (!bytes.starts_with("glTF")) {
    if (bytes.find('\0') != bytes.npos)
      file.refuse("is not text, and does not begin with glTF; expected a glTF 2.0 file");
    return {bytes, {}};
  }
  const std::uint64_t size = bytes.size();
  if (size < 20 || little(bytes, 4) != 2 || little(bytes, 16) != 0x4E4F534A ||
      20 + std::uint64_t{little(bytes, 12)} > size)
    file.refuse("is not a whole glTF 2.0 file");
  const std::uint64_t json = little(bytes, 12), next = 20 + (json + 3) / 4 * 4;
  GltfChunks out{bytes.substr(20, json), {}};
  if (next + 8 > size) return out;
  const std::uint64_t length = little(bytes, next);
  if (little(bytes, next + 4) != 0x004E4942 || next + 8 + length > size)
    file.refuse("is not a whole glTF 2.0 file: its second chunk is cut off, or no buffer");
  out.binary = std::string_view(bytes).substr(next + 8, length);
  return out;
}

std::string joined_glb(std::string json, std::string_view binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::size_t padded = (binary.size() + 3) / 4 * 4;
  std::string out = "glTF";
  const auto add = [&](std::size_t number) {
    const auto word = static_cast<std::uint32_t>(number);
    out.append(reinterpret_cast<const char*>(&word), 4);
  };
  add(2), add(20 + json.size() + 8 + padded), add(json.size()), add(0x4E4F534A);
  out += json;
  add(padded), add(0x004E4942);
  out += binary;
  out.resize(out.size() + padded - binary.size());
  return out;
}

void prune_gltf(nlohmann::json& document, const MeshFile& file) {
  for (const char* key : {"images", "textures", "samplers", "materials", "animations", "skins", "cameras",
                          "extensions", "extras"})
    document.erase(key);
  if (document.contains("extensionsRequired"))
    for (const auto& name : document["extensionsRequired"])
      if (const std::string text = name.is_string() ? name.get<std::string>() : "";
          !text.starts_with("KHR_materials_") && text != "KHR_texture_transform")
        file.refuse("needs the extension '" + printable(text) + "', which is not read");
  double bytes = 0;
  if (document.contains("buffers") && document["buffers"].is_array()) {
    if (document["buffers"].size() > 1000) file.refuse("has more than 1000 buffers");
    for (const auto& buffer : document["buffers"])
      if (buffer.is_object() && buffer.contains("byteLength") && buffer["byteLength"].is_number())
        bytes += buffer["byteLength"].get<double>();
  }
  if (!(bytes <= static_cast<double>(MeshFile::kLargest))) file.refuse("has more than 1 GiB of buffers");
}

}  // namespace nullcone
