// Any bytes, read as a scene, a look or a manifest (the first byte says which): a result or a complaint.
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "core/base/error.h"
#include "core/base/include.h"
#include "core/base/json.h"
#include "core/record/dataset_file.h"
#include "core/scene/read_scene.h"
#include "core/scene/sequence.h"
#include "postrender/look.h"
#include "postrender/look_source.h"
#include "tests/test_folder.h"

namespace {

using namespace nullcone;

/// Two spacetimes as the reader of scenes sees them.
const std::vector<MetricDescription>& metrics() {
  static const std::vector<MetricDescription> out = {
      {"goedel", {{"a", 1, 1e-6, 1e15, {}}}, 0, true},
      {"kerr_schild", {{"mass", 1, 1e-6, 1e12, {}}, {"chart", 0, 0, 1, {"outgoing", "ingoing"}}}, 2, false}};
  return out;
}

/// A folder with files that a scene may include.
struct Parts {
  test::TestFolder folder;

  Parts() {
    folder.write("top.json", "{}");
    folder.write("o.json",
                 R"({"name": "a", "shape": {"type": "sphere", "radius": 1}, "x": {"include": "l.json"}})");
    folder.write("l.json", R"([{"include": "p.json"}, [1, 2], {"include": "p.json", "n": null}])");
    folder.write("p.json", R"({"n": 1, "m": {"k": [1]}})");
    folder.write("c.json", R"({"include": "c.json"})");
  }
  std::string top() const { return folder.file("top.json"); }
};

void read(char what, const std::string& text) {
  if (what % 4 == 0) {
    static const Parts parts;
    const WholeJson whole = include_files(parse_json(text, parts.top()), parts.top());
    whole.read([&] {
      const nlohmann::json& scene = whole.document;
      if (!is_sequence(scene)) return void(read_scene(canonical_json(scene), parts.top(), metrics()));
      const Frames frames = read_frames(scene, parts.top());
      read_scene(canonical_json(scene_at(scene, frames, frames.count / 2, parts.top())), parts.top(),
                 metrics());
    });
  } else if (what % 4 == 1) {
    manifest_from_json(text, "manifest");
  } else {
    Manifest manifest;
    manifest.objects = {{"earth", 0.5}, {"moon", 0}};
    nlohmann::json look = what % 4 == 2 ? parse_json(text, "look") : nlohmann::json::object();
    if (what % 4 == 3) postrender::set_entry(look, text);
    postrender::parse_look(look, {"look", "", "."}, manifest);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  try {
    read(static_cast<char>(data[0]), {reinterpret_cast<const char*>(data) + 1, size - 1});
  } catch (const InputError&) {
  }
  return 0;
}
