#include "core/scene/read_mesh.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/include.h"
#include "core/scene/load_mesh.h"
#include "core/scene/mesh_file.h"
#include "core/scene/read_placing.h"

namespace nullcone {

namespace {

/// A file that a scene names: beside the scene, or below its folder.
std::string file_beside(JsonObject& object, std::string_view key, const std::string& scene) {
  const std::string name = object.text(key);
  if (!stays_below(name)) object.refuse(key, "expected a file in the scene's folder or below it, without ..");
  return (std::filesystem::path(scene).parent_path() / name).string();
}

std::string ending_of(const std::string& path) {
  std::string out = std::filesystem::path(path).extension().string();
  std::ranges::transform(out, out.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  return out;
}

ReadMesh read_file(const std::string& path, const std::string& ending, double scale, bool flat) {
  LoadedMesh loaded = ending == ".obj" ? load_obj(path, scale) : load_gltf(path, scale);
  TriangleSoup& soup = loaded.soup;
  ReadMesh out{nullptr, std::move(loaded.hashes), !soup.normals.empty()};
  if (flat) soup.normals.clear();
  out.mesh = std::make_shared<const Mesh>(make_mesh(std::move(soup)));
  if (out.mesh->triangles.empty()) throw InputError(path, "has no triangle with an area");
  if (!(out.mesh->ball >= 1e-100)) throw InputError(path, "holds a mesh smaller than 1e-100");
  return out;
}

}  // namespace

std::shared_ptr<const Mesh> read_mesh(JsonObject& shape, const std::string& scene, MeshShelf& shelf,
                                      MeshHashes& hashes) {
  const std::string path = file_beside(shape, "file", scene), ending = ending_of(path);
  if (ending != ".obj" && ending != ".gltf" && ending != ".glb")
    shape.refuse("file", "expected a name that ends in .obj, .gltf or .glb");
  const double scale = shape.number_or("scale", 1, 1e-100, kLargest);
  const bool flat = shape.has("normals") && shape.text("normals") == "flat";
  const ReadMesh read =
      shelf.get(path, (flat ? "flat " : "") + std::to_string(std::bit_cast<std::uint64_t>(scale)),
                [&] { return read_file(path, ending, scale, flat); });
  hashes = read.hashes;
  check_hashes(shape, hashes);
  const std::string normals = shape.word("normals", {"smooth", "flat"}, read.has_normals ? "smooth" : "flat");
  if (normals == "smooth" && !read.has_normals)
    shape.refuse("normals", "expected \"flat\", or nothing: the file has no normals");
  return read.mesh;
}

}  // namespace nullcone
