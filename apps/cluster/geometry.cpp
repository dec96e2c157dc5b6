#include "apps/cluster/geometry.h"

#include <fcntl.h>

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/base/error.h"
#include "core/base/sha256.h"
#include "core/record/whole_file.h"

namespace nullcone::cluster {

using nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// SHA-256 of what is read, empty where that cannot be done. `take` is given every block.
std::string read_through(const fs::path& path, const std::function<void(std::string_view)>& take) {
  const Descriptor file(path.string(), O_RDONLY | O_NONBLOCK);
  std::error_code error;
  if (!file || !fs::is_regular_file(path, error)) return {};
  Sha256 hash;
  std::vector<char> block(std::size_t{1} << 20);
  for (ssize_t got; (got = ::read(file.number(), block.data(), block.size())) != 0;) {
    if (got < 0) return {};
    const std::string_view bytes(block.data(), static_cast<std::size_t>(got));
    hash.add(bytes);
    take(bytes);
  }
  return hash.digits();
}

/// What the folder keeps for itself: scripts that are run, among them.
bool is_own(const fs::path& name) {
  const std::string first = name.lexically_normal().begin()->string();
  return first == "cluster" || first == "pictures" || first == "scene.json" || first == "look.json" ||
         (first.starts_with("data.") && first.ends_with(".exr"));
}

void copy_file(const fs::path& from, const std::string& name, const std::string& hash, const Folder& folder) {
  if (!stays_below(name) || is_own(name))
    throw InputError(from.string(), "cannot be copied into the folder: '" + printable(name) +
                                        "' is a name of the folder's own; expected another one");
  const fs::path to = fs::path(folder.path()) / name;
  if (read_through(to, [](std::string_view) {}) == hash) return;
  std::error_code error;
  fs::create_directories(to.parent_path(), error);
  if (error) throw WorkError(to.parent_path().string(), "cannot make the folder: " + error.message());
  WholeFile copy(to.string());
  if (read_through(from, [&](std::string_view bytes) { copy.stream() << bytes; }) != hash)
    throw InputError(from.string(), "has changed since it was read; expected SHA-256 " + hash);
  copy.finish();
}

}  // namespace

void copy_meshes(const WholeJson& scene, const Folder& folder) {
  const fs::path beside = fs::path(scene.path).parent_path();
  for (const json& object : scene.document.at("objects")) {
    const json shape = object.value("shape", json::object());
    if (!shape.contains("sha256")) continue;
    const fs::path mesh = shape.at("file").get<std::string>();
    copy_file(beside / mesh, mesh.string(), shape.at("sha256"), folder);
    for (const json& buffer : shape.value("buffers", json::array())) {
      const fs::path name = mesh.parent_path() / buffer.at("file").get<std::string>();
      copy_file(beside / name, name.string(), buffer.at("sha256"), folder);
    }
  }
}

}  // namespace nullcone::cluster
