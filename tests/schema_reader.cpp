// Reads documents as the tools do, one JSON a line of standard input, and says of each "accepted" or what is
// wrong: {"scene": …}, or {"look": …, "objects": [names], "lights": [names], "paths": n}. Argument: the
// folder in which files are looked for.
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "core/base/error.h"
#include "core/base/include.h"
#include "core/base/json.h"
#include "core/record/dataset.h"
#include "core/scene/read_scene.h"
#include "core/scene/sequence.h"
#include "metrics/registry.h"
#include "postrender/look_source.h"

namespace {

using namespace nullcone;
using nlohmann::json;

void read_look(const json& look, const Manifest& manifest, const std::string& folder) {
  const WholeJson whole = include_files(look, folder + "/top.json");
  postrender::look_at({std::make_shared<const json>(whole.document), {"look", "", folder}}, manifest, 0);
}

void read_plain_scene(const json& scene, const std::vector<MetricDescription>& metrics,
                      const std::string& folder) {
  const Scene read = read_scene(canonical_json(scene), "scene", metrics);
  if (!scene.contains("look")) return;
  Manifest manifest;
  for (const Object& object : read.objects) manifest.objects.push_back({object.name, 0});
  std::vector<ObjectEntry> lamps;
  for (const Lamp& lamp : read.lights.lamps) lamps.push_back({lamp.name, 0});
  manifest.set_lights(lamps, read.lights.paths);
  read_look(scene["look"], manifest, folder);
}

void read_any_scene(const json& document, const std::vector<MetricDescription>& metrics,
                    const std::string& folder) {
  const json scene = include_files(document, folder + "/top.json").document;
  if (!is_sequence(scene)) return read_plain_scene(scene, metrics, folder);
  const Frames frames = read_frames(scene, "scene");
  for (const int frame : {0, frames.count / 2, frames.count - 1})
    read_plain_scene(scene_at(scene, frames, frame, "scene"), metrics, folder);
}

Manifest manifest_of(const json& line) {
  const auto entries = [&](const char* key) {
    std::vector<ObjectEntry> out;
    for (const json& name : line.at(key)) out.push_back({name.get<std::string>(), 0});
    return out;
  };
  Manifest out;
  out.objects = entries("objects");
  out.set_lights(entries("lights"), line.at("paths").get<int>());
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::vector<MetricDescription> metrics = metric_descriptions();
  std::filesystem::current_path(argv[1]);  // meshes are looked for beside the scene
  for (std::string text; std::getline(std::cin, text);) {
    const json line = json::parse(text);
    try {
      if (line.contains("scene"))
        read_any_scene(line["scene"], metrics, argv[1]);
      else
        read_look(line.at("look"), manifest_of(line), argv[1]);
      std::cout << "accepted\n";
    } catch (const InputError& error) {
      std::cout << error.what() << '\n';
    }
  }
}
