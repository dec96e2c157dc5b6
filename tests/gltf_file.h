// A small glTF file, for tests of its reader.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace nullcone {
namespace {

using nlohmann::json;

/// A glTF of a tetrahedron, with its buffer beside it or in it.
struct Gltf {
  json document;
  std::string binary;

  Gltf() {
    const std::array<float, 12> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::array<std::uint16_t, 12> indices = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
    const std::array<float, 8> uv = {0, 0, 1, 0, 0, 1, 0.5F, 0.25F};
    const auto add = [&](const auto& numbers) {
      binary.append(reinterpret_cast<const char*>(numbers.data()), sizeof numbers);
    };
    add(positions), add(indices), add(uv);
    document = {
        {"asset", {{"version", "2.0"}}},
        {"scene", 0},
        {"scenes", {{{"nodes", {0}}}}},
        {"nodes", {{{"mesh", 0}}}},
        {"meshes",
         {{{"primitives", {{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 2}}}, {"indices", 1}}}}}}},
        {"buffers", {{{"byteLength", binary.size()}, {"uri", "t.bin"}}}},
        {"bufferViews", json::array({{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 48}},
                                     {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", 24}},
                                     {{"buffer", 0}, {"byteOffset", 72}, {"byteLength", 32}}})},
        {"accessors",
         json::array({{{"bufferView", 0}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
                      {{"bufferView", 1}, {"componentType", 5123}, {"count", 12}, {"type", "SCALAR"}},
                      {{"bufferView", 2}, {"componentType", 5126}, {"count", 4}, {"type", "VEC2"}}})}};
  }
  /// With its buffer inside.
  std::string glb(std::size_t cut = 0) const {
    json inner = document;
    inner["buffers"][0].erase("uri");
    std::string text = inner.dump(), out = "glTF";
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const auto add = [&](std::size_t number) {
      const auto word = static_cast<std::uint32_t>(number);
      out.append(reinterpret_cast<const char*>(&word), 4);
    };
    add(2), add(28 + text.size() + binary.size()), add(text.size()), add(0x4E4F534A);
    out += text;
    add(binary.size()), add(0x004E4942);
    out += binary;
    out.resize(out.size() - cut);
    return out;
  }
};

}  // namespace
}  // namespace nullcone
