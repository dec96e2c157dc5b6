#include "core/scene/load_mesh.h"

#include <tiny_gltf.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/include.h"
#include "core/base/json.h"
#include "core/scene/gltf_chunks.h"
#include "core/scene/gltf_numbers.h"
#include "core/scene/mesh_file.h"
#include "core/scene/read_placing.h"

namespace nullcone {

namespace {

/// What the loader may read: files beside the glTF that its buffers name, and at most so much.
struct Beside {
  std::string path;
  std::size_t left = MeshFile::kLargest;
  std::map<std::string, std::string> hashes = {};  ///< of what was read, by name

  /// The loader looks in its own folder, which is called @ here, and elsewhere.
  static constexpr std::string_view kFolder = "@/";

  /// Of what the loader calls @/name.
  static std::string name_of(const std::string& name) { return name.substr(kFolder.size()); }
  std::string real(const std::string& below) const {
    if (!stays_below(below))
      throw InputError(path, "names the file '" + printable(below) + "'; expected one beside it, without ..");
    return (std::filesystem::path(path).parent_path() / below).string();
  }
};

tinygltf::FsCallbacks reading(Beside& beside) {
  tinygltf::FsCallbacks out{};
  out.FileExists = [](const std::string& name, void*) { return name.starts_with(Beside::kFolder); };
  out.ExpandFilePath = [](const std::string& name, void*) { return name; };
  out.ReadWholeFile = [](std::vector<unsigned char>* to, std::string*, const std::string& name, void* user) {
    auto& from = *static_cast<Beside*>(user);
    const std::string below = Beside::name_of(name);
    MeshFile file(from.real(below));
    if (file.size() > from.left) file.refuse("makes more than 1 GiB of buffers");
    from.left -= file.size();
    to->resize(file.size());
    to->resize(file.read(reinterpret_cast<char*>(to->data()), to->size()));
    const std::string hash = file.sha256();
    if (from.hashes.emplace(below, hash).first->second != hash) file.refuse("changes while it is read");
    return true;
  };
  out.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
  };
  out.user_data = &beside;
  return out;
}

tinygltf::Model load(MeshFile& file, Beside& beside) {
  const std::string bytes = file.read_all();
  const GltfChunks chunks = chunks_of(bytes, file);
  if (chunks.json.size() > std::size_t{1} << 26) file.refuse("has more than 64 MiB of JSON");
  nlohmann::json document = parse_json(chunks.json, file.path());
  if (!document.is_object()) file.refuse("expected an object {…}, the JSON of a glTF 2.0 file");
  prune_gltf(document, file);
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks(reading(beside));
  loader.SetImageLoader([](tinygltf::Image*, const int, std::string*, std::string*, int, int,
                           const unsigned char*, int, void*) { return true; },
                        nullptr);
  tinygltf::Model model;
  std::string error, warning;
  bool whole = false;
  try {
    if (chunks.binary.empty()) {
      const std::string text = document.dump();
      whole = loader.LoadASCIIFromString(&model, &error, &warning, text.data(),
                                         static_cast<unsigned>(text.size()), "@");
    } else {
      const std::string whole_file = joined_glb(document.dump(), chunks.binary);
      whole = loader.LoadBinaryFromMemory(&model, &error, &warning,
                                          reinterpret_cast<const unsigned char*>(whole_file.data()),
                                          static_cast<unsigned>(whole_file.size()), "@");
    }
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& failure) {
    error = failure.what();
  }
  error.erase(error.find_last_not_of(" \n") + 1);
  for (std::size_t at; (at = error.find(Beside::kFolder)) != error.npos;)
    error.erase(at, Beside::kFolder.size());
  if (!whole || !error.empty()) file.refuse("is not a glTF 2.0 file: " + printable(error));
  return model;
}

class GltfReader {
 public:
  GltfReader(const tinygltf::Model& model, const MeshFile& file, double scale)
      : model_(model), file_(file), scale_(scale) {}

  TriangleSoup read() {
    if (model_.scenes.empty()) file_.refuse("has no scene");
    const int scene = std::max(model_.defaultScene, 0);
    if (static_cast<std::size_t>(scene) >= model_.scenes.size())
      file_.refuse("has no scene number " + std::to_string(scene));
    struct Reached {
      int node;
      GltfMotion motion;
    };
    std::vector<Reached> waiting;
    std::vector<bool> known(model_.nodes.size());
    const auto reach = [&](const std::vector<int>& nodes, const GltfMotion& motion) {
      for (const int n : nodes) {
        if (n < 0 || static_cast<std::size_t>(n) >= known.size())
          file_.refuse("has no node number " + std::to_string(n));
        if (known[static_cast<std::size_t>(n)])
          file_.refuse("reaches the node number " + std::to_string(n) + " twice; expected a tree of nodes");
        known[static_cast<std::size_t>(n)] = true;
        waiting.push_back({n, motion * motion_of(model_.nodes[static_cast<std::size_t>(n)])});
      }
    };
    reach(model_.scenes[static_cast<std::size_t>(scene)].nodes, GltfMotion{});
    while (!waiting.empty()) {
      const Reached next = waiting.back();
      waiting.pop_back();
      const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(next.node)];
      if (node.mesh >= 0) add_mesh(node.mesh, next.motion);
      reach(node.children, next.motion);
    }
    if (out_.triangles.empty()) file_.refuse("has no triangles in its scene");
    return std::move(out_);
  }

 private:
  static constexpr std::size_t kMostPrimitives = 1'000'000;
  static constexpr int kTriangles = 4, kStrip = 5, kFan = 6;

  void add_mesh(int number, const GltfMotion& motion) {
    if (static_cast<std::size_t>(number) >= model_.meshes.size())
      file_.refuse("has no mesh number " + std::to_string(number));
    for (const tinygltf::Primitive& primitive : model_.meshes[static_cast<std::size_t>(number)].primitives) {
      if (++primitives_ > kMostPrimitives) file_.refuse("has more than 1000000 primitives in its scene");
      add_primitive(primitive, motion);
    }
  }

  void add_primitive(const tinygltf::Primitive& primitive, const GltfMotion& motion) {
    const int mode = primitive.mode < 0 ? kTriangles : primitive.mode;
    if (mode < kTriangles) return;  // points and lines
    if (mode > kFan) file_.refuse("has a primitive of mode " + std::to_string(mode));
    const GltfNumbers positions = numbers(primitive, "POSITION", 3),
                      normals = numbers(primitive, "NORMAL", 3), uv = numbers(primitive, "TEXCOORD_0", 2);
    if (positions.count == 0) return;
    GltfNumbers indices;
    if (primitive.indices >= 0) indices = GltfNumbers(model_, file_, primitive.indices, 1, true);
    const std::size_t corners = primitive.indices >= 0 ? indices.count : positions.count;
    const std::size_t count = corners < 3 ? 0 : mode == kTriangles ? corners / 3 : corners - 2;
    if (out_.triangles.size() + count > Mesh::kMostTriangles ||
        out_.positions.size() + positions.count > 3 * Mesh::kMostTriangles)
      file_.refuse("has too many triangles; expected at most 16777216");
    if (normals.count > 0 && normals.count < positions.count)
      file_.refuse("has fewer normals than positions");
    if (uv.count > 0 && uv.count < positions.count)
      file_.refuse("has fewer texture coordinates than positions");

    const auto first = static_cast<std::uint32_t>(out_.positions.size());
    for (std::size_t i = 0; i < positions.count; ++i) out_.positions.push_back(place(positions, i, motion));
    const bool turned = motion.determinant() < 0;
    for (std::size_t n = 0; n < count; ++n) {
      std::array<std::size_t, 3> at = mode == kTriangles ? std::array{3 * n, 3 * n + 1, 3 * n + 2}
                                      : mode == kFan     ? std::array{std::size_t{0}, n + 1, n + 2}
                                      : n % 2 == 0       ? std::array{n, n + 1, n + 2}
                                                         : std::array{n + 1, n, n + 2};
      if (turned) std::swap(at[1], at[2]);
      for (std::size_t& corner : at)
        if (primitive.indices >= 0) corner = index(indices, corner, positions.count);
      add_triangle(first, at, uv, normals, motion);
    }
  }

  void add_triangle(std::uint32_t first, const std::array<std::size_t, 3>& at, const GltfNumbers& uv,
                    const GltfNumbers& normals, const GltfMotion& motion) {
    const std::size_t before = out_.triangles.size();
    std::array<std::uint32_t, 3> triangle;
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = first + static_cast<std::uint32_t>(at[k]);
    out_.triangles.push_back(triangle);
    if (uv.count > 0 || !out_.uv.empty()) {
      out_.uv.resize(before + 1);
      if (uv.count > 0)
        for (std::size_t k = 0; k < 3; ++k) put_uv(uv, at[k], out_.uv.back().corner[k]);
    }
    if (normals.count > 0 || !out_.normals.empty()) {
      out_.normals.resize(before + 1);
      if (normals.count > 0)
        for (std::size_t k = 0; k < 3; ++k) put_normal(normals, at[k], motion, out_.normals.back().corner[k]);
    }
  }

  std::array<double, 3> place(const GltfNumbers& positions, std::size_t i, const GltfMotion& motion) const {
    std::array<double, 3> out = motion.point({positions.get(i, 0), positions.get(i, 1), positions.get(i, 2)});
    for (double& x : out) {
      x *= scale_;
      if (!(std::fabs(x) <= kLargest)) file_.refuse("has a corner that is not finite, or beyond 1e15");
    }
    return out;
  }
  /// In glTF v grows downwards.
  void put_uv(const GltfNumbers& uv, std::size_t i, float* to) const {
    const double u = uv.get(i, 0), v = 1 - uv.get(i, 1);
    if (!(std::fabs(u) <= 1e6 && std::fabs(v) <= 1e6))
      file_.refuse("has texture coordinates that are not finite, or beyond 1e6");
    to[0] = static_cast<float>(u), to[1] = static_cast<float>(v);
  }
  void put_normal(const GltfNumbers& normals, std::size_t i, const GltfMotion& motion, float* to) const {
    const auto n = motion.normal({normals.get(i, 0), normals.get(i, 1), normals.get(i, 2)});
    const double length = std::hypot(n[0], n[1], n[2]);
    if (!std::isfinite(length)) file_.refuse("has a normal that is not finite");
    for (std::size_t k = 0; k < 3; ++k) to[k] = length > 0 ? static_cast<float>(n[k] / length) : 0.0F;
  }
  std::size_t index(const GltfNumbers& indices, std::size_t i, std::size_t count) const {
    const auto out = static_cast<std::size_t>(indices.get(i, 0));
    if (out >= count)
      file_.refuse("names corner " + std::to_string(out) + " of " + std::to_string(count) + " (from 0 on)");
    return out;
  }
  /// None where the primitive has none.
  GltfNumbers numbers(const tinygltf::Primitive& primitive, const char* name, int components) const {
    const auto found = primitive.attributes.find(name);
    if (found == primitive.attributes.end()) return {};
    return {model_, file_, found->second, components, false};
  }
  GltfMotion motion_of(const tinygltf::Node& node) const {
    GltfMotion out(node);
    for (const auto& row : out.rows)
      for (const double x : row)
        if (!std::isfinite(x)) file_.refuse("has a node whose motion is not finite");
    return out;
  }

  const tinygltf::Model& model_;
  const MeshFile& file_;
  double scale_;
  TriangleSoup out_;
  std::size_t primitives_ = 0;
};

}  // namespace

LoadedMesh load_gltf(const std::string& path, double scale) {
  MeshFile file(path);
  Beside beside{path};
  const tinygltf::Model model = load(file, beside);
  return {GltfReader(model, file, scale).read(), {file.sha256(), std::move(beside.hashes)}};
}

}  // namespace nullcone
