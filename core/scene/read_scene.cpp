#include "core/scene/read_scene.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/sha256.h"
#include "core/scene/read_camera.h"
#include "core/scene/read_lights.h"
#include "core/scene/read_observer.h"
#include "core/scene/read_placing.h"
#include "core/scene/read_records.h"
#include "core/scene/read_shape.h"
#include "core/scene/sequence.h"

namespace nullcone {

namespace {

const MetricDescription& read_metric(JsonObject metric, std::span<const MetricDescription> known,
                                     Scene& scene) {
  std::vector<std::string> names;
  for (const MetricDescription& description : known) names.emplace_back(description.name);
  scene.metric = metric.word("name", names);
  const auto found =
      std::find_if(known.begin(), known.end(), [&](const auto& d) { return d.name == scene.metric; });
  for (const MetricParameter& p : found->parameters) {
    double& value = scene.metric_parameters[std::string(p.name)];
    if (p.words[0].empty()) {
      value = metric.number_or(p.name, p.fallback, p.least, p.most);
      continue;
    }
    const std::vector<std::string> words(p.words.begin(), p.words.end());
    value = metric.word(p.name, words, words[static_cast<std::size_t>(p.fallback)]) == words[1] ? 1 : 0;
  }
  metric.finish();
  return *found;
}

Object read_object(JsonObject object, const MetricDescription& metric, std::set<std::string>& taken,
                   const std::string& place, MeshShelf& meshes, MeshHashes& hashes) {
  Object out;
  out.name = object.name("name", taken);
  out.shape = read_shape(object.object("shape"), metric, place, meshes, hashes);
  if (out.shape.type != ShapeType::sky) read_placing(object.object("placing"), out);
  out.opacity = object.number_or("opacity", 1, 0, 1);
  out.transparent = object.boolean("transparent", out.opacity < 1);
  if (out.opacity < 1 && !out.transparent)
    object.refuse("transparent", "expected true, or nothing, beside an opacity below 1");
  object.finish();
  return out;
}

/// "draft", "balanced", "reference", or {"rtol", "atol", "integrator"}.
Accuracy read_accuracy(JsonObject& root) {
  if (root.is_text("accuracy")) {
    const std::string name = root.word("accuracy", {"draft", "balanced", "reference"});
    return name == "draft" ? kDraft : name == "balanced" ? kBalanced : kReference;
  }
  JsonObject object = root.object("accuracy");
  Accuracy out = kBalanced;
  out.rtol = object.number("rtol", 1e-15, 1e-2);
  out.atol = object.number_or("atol", 0, 0, kLargest);
  const std::vector<std::string> names(kIntegratorNames.begin(), kIntegratorNames.end());
  const std::string name = object.word("integrator", names, names[static_cast<std::size_t>(out.integrator)]);
  out.integrator = static_cast<Integrator>(std::find(names.begin(), names.end(), name) - names.begin());
  object.finish();
  return out;
}

/// How far rays are followed: in lambda, or {"lambda", "t"}. A limit of time alone stands in place of a
/// default in lambda.
void read_lookback(JsonObject& root, Scene& scene) {
  if (!root.has("max_lookback")) return;
  if (!root.at("max_lookback").is_object()) {
    scene.max_lookback = root.number("max_lookback", 1e-300, kLargest);
    return;
  }
  JsonObject limits = root.object("max_lookback");
  if (!limits.has("lambda") && !limits.has("t"))
    root.refuse("max_lookback", "expected a number, or lambda or t or both");
  scene.max_lookback = limits.has("lambda") ? limits.number("lambda", 1e-300, kLargest)
                                            : std::numeric_limits<double>::infinity();
  if (limits.has("t")) scene.max_lookback_t = limits.number("t", 1e-300, kLargest);
  limits.finish();
}

/// How rays are followed.
void read_paths(JsonObject& root, const MetricDescription& metric, Scene& scene) {
  scene.integrated = root.word("paths", {"closed", "integrated"},
                               metric.closed_paths ? "closed" : "integrated") == "integrated";
  if (!scene.integrated && !metric.closed_paths)
    root.refuse("paths", "the spacetime '" + std::string(metric.name) + "' has no closed-form paths");
  if (!scene.integrated && scene.observer.frame != ObserverFrame::at_rest)
    root.refuse("observer/frame", "expected \"static\" with closed-form paths");
  if (root.has("accuracy")) scene.accuracy = read_accuracy(root);
}

}  // namespace

Scene read_scene(const std::string& text, const std::string& place,
                 std::span<const MetricDescription> metrics, MeshShelf* shelf) {
  MeshShelf own;
  MeshShelf& meshes = shelf ? *shelf : own;
  nlohmann::json document = parse_json(text, place);
  JsonObject root(document, place, "");
  refuse_sequence(document, place);
  Scene scene;
  const MetricDescription& metric = read_metric(root.object("metric"), metrics, scene);
  scene.observer = read_observer(root.object("observer"));
  scene.camera = read_camera(root.object("camera"));
  read_lookback(root, scene);
  read_paths(root, metric, scene);
  std::set<std::string> names;
  std::array<bool, 3> sky{};
  std::vector<MeshHashes> hashes;
  for (JsonObject& object : root.objects("objects")) {
    if (scene.objects.size() == 1000) root.refuse("objects", "expected at most 1000 objects");
    scene.objects.push_back(read_object(object, metric, names, place, meshes, hashes.emplace_back()));
    if (scene.objects.back().shape.type != ShapeType::sky) continue;
    if (std::exchange(sky[scene.objects.back().shape.sky], true))
      object.refuse("shape/type", "is a second sky; expected one at most");
  }
  if (scene.objects.empty()) root.refuse("objects", "is empty; expected at least one object to look at");
  if (root.has("lights")) scene.lights = read_lights(root.object("lights"), scene.objects);
  scene.records = read_records(root, scene);
  if (root.has("look")) root.object("look");  // its contents are post-rendering's affair
  root.text("$schema", "");
  root.finish();

  for (std::size_t i = 0; i < hashes.size(); ++i)
    if (!hashes[i].file.empty()) pin_hashes(document["objects"][i]["shape"], hashes[i]);
  document.erase("$schema");  // for editors, and relative to the file
  scene.canonical = canonical_json(document);
  document.erase("look");
  scene.sha256 = sha256(canonical_json(document));
  return scene;
}

}  // namespace nullcone
