#include "apps/cluster/scene_source.h"

#include <filesystem>

#include "apps/cluster/geometry.h"
#include "apps/scene_file.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/sha256.h"

namespace nullcone::cluster {

using nlohmann::json;

namespace {

WholeJson read_sequence(const std::string& path) {
  WholeJson out = read_scene_file(path);
  if (out.document.is_object() && !is_sequence(out.document))
    out.document["frames"] = {{"count", 1}, {"from", 0}, {"to", 0}, {"time", "proper"}};
  return out;
}

std::string sha256_without_look(json scene) {
  if (scene.is_object()) scene.erase("look");
  return sha256(canonical_json(scene));
}

/// Its time stays when nothing changes: pictures are newer than their look.
void write_if_new(const std::string& path, const json& document) {
  const std::string text = document.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
  if (read_text(path) != text) write_text(path, text);
}

}  // namespace

SceneSource::SceneSource(const std::string& path)
    : file(read_sequence(path)), sha256(sha256_without_look(file.document)) {}

void SceneSource::pin_meshes(const TraceFrames& frames) {
  const json first = json::parse(frames.scene(frames.numbers().front()).canonical);
  json& objects = file.document["objects"];
  for (std::size_t i = 0; i < objects.size(); ++i)
    for (const char* key : {"sha256", "buffers"})
      if (const json& shape = first.at("objects")[i]["shape"]; shape.contains(key))
        objects[i]["shape"][key] = shape[key];
  sha256 = sha256_without_look(file.document);
}

void check_scenes(const TraceFrames& frames, int shards) {
  for (const int frame : frames.numbers()) {
    const Scene scene = frames.scene(frame);
    if (shards > 1) lines_of({1, shards}, scene.camera.height);
  }
}

void refuse_strangers(const TraceFrames& frames, int threads) {
  const auto missing = missing_pieces(frames, 0, threads, Check::header);
  if (!missing) return;
  for (const std::int64_t frame : *missing) {
    const std::string file = frames.whole_file(static_cast<int>(frame));
    std::error_code error;
    if (std::filesystem::exists(file, error) &&
        unlike(file, frames.scene(static_cast<int>(frame)), {}) == "is of another scene")
      throw InputError(file, "is of another scene; expected another folder, or --replace");
  }
}

void adopt(const SceneSource& scene, const Folder& folder) {
  copy_meshes(scene.file, folder);
  write_if_new(folder.scene(), scene.file.document);
  if (scene.file.document.contains("look"))
    write_if_new(folder.look(), scene.file.document.at("look"));
  else
    std::filesystem::remove(folder.look());
}

}  // namespace nullcone::cluster
