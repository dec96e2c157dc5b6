#include "core/scene/read_scene.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/sha256.h"
#include "core/scene/read_lights.h"
#include "core/scene/read_placing.h"
#include "core/scene/read_records.h"
#include "core/scene/read_shape.h"
#include "core/scene/sequence.h"

namespace nullcone {

namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr long kMostPixels = 1L << 28;

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

Observer read_observer(JsonObject observer) {
  Observer out;
  out.event = read_event(observer, "event");
  out.velocity = read_velocity(observer, "velocity");
  if (observer.word("frame", {"static", "normal"}, "static") == "normal") out.frame = ObserverFrame::normal;
  observer.finish();
  return out;
}

/// The frame of the camera: azimuth from e1 towards e2, elevation towards e3, then roll about the look
/// direction.
void orient(Camera& camera, double azimuth, double elevation, double roll) {
  const double ca = std::cos(azimuth), sa = std::sin(azimuth), ce = std::cos(elevation),
               se = std::sin(elevation);
  camera.forward = {ce * ca, ce * sa, se};
  const Triple left = {-sa, ca, 0}, up = cross(camera.forward, left);
  const double cr = std::cos(roll), sr = std::sin(roll);
  for (std::size_t i = 0; i < 3; ++i) {
    camera.left[i] = cr * left[i] + sr * up[i];
    camera.up[i] = cr * up[i] - sr * left[i];
  }
}

Camera read_camera(JsonObject camera) {
  Camera out;
  const std::string type = camera.word("type", {"perspective", "panorama", "sphere"});
  out.type = type == "perspective" ? CameraType::perspective : CameraType::panorama;
  const auto resolution = camera.numbers("resolution", 2, 1, kMostPixels);
  if (resolution[0] != std::floor(resolution[0]) || resolution[1] != std::floor(resolution[1]))
    camera.refuse("resolution", "expected two whole numbers, width and height in pixels");
  if (resolution[0] * resolution[1] > static_cast<double>(kMostPixels))
    camera.refuse("resolution", "asks for more than 268435456 pixels");
  out.width = static_cast<int>(resolution[0]);
  out.height = static_cast<int>(resolution[1]);
  if (type == "sphere") {
    out.fov_horizontal = 2 * std::numbers::pi;
    out.fov_vertical = std::numbers::pi;
  } else if (type == "panorama") {
    const auto fov = camera.numbers("fov_deg", 2, 1e-9, 360);
    if (fov[1] > 180) camera.refuse("fov_deg/1", "expected a vertical field of view of at most 180");
    out.fov_horizontal = fov[0] * kRadians;
    out.fov_vertical = fov[1] * kRadians;
  } else {  // square pixels: the vertical field of view follows
    out.fov_horizontal = camera.number("fov_deg", 1e-9, 179.9) * kRadians;
    out.fov_vertical = 2 * std::atan(std::tan(0.5 * out.fov_horizontal) * out.height / out.width);
  }
  out.samples = camera.has("samples") ? static_cast<int>(camera.integer("samples", 1, 16)) : 1;
  if (resolution[0] * resolution[1] * out.samples * out.samples > static_cast<double>(kMostPixels))
    camera.refuse("samples", "asks for more than 268435456 rays");
  orient(out, camera.number_or("azimuth_deg", 0, -1e6, 1e6) * kRadians,
         camera.number_or("elevation_deg", 0, -90, 90) * kRadians,
         camera.number_or("roll_deg", 0, -1e6, 1e6) * kRadians);
  camera.finish();
  return out;
}

Object read_object(JsonObject object, const MetricDescription& metric, std::set<std::string>& taken,
                   const std::string& place) {
  Object out;
  out.name = object.name("name", taken);
  out.shape = read_shape(object.object("shape"), metric, place);
  if (out.shape.type != ShapeType::sky) out.placing = read_placing(object.object("placing"));
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
                 std::span<const MetricDescription> metrics) {
  nlohmann::json document = parse_json(text, place);
  JsonObject root(document, place, "");
  refuse_sequence(document, place);
  Scene scene;
  const MetricDescription& metric = read_metric(root.object("metric"), metrics, scene);
  scene.observer = read_observer(root.object("observer"));
  scene.camera = read_camera(root.object("camera"));
  if (root.has("max_lookback")) scene.max_lookback = root.number("max_lookback", 1e-300, kLargest);
  read_paths(root, metric, scene);
  std::set<std::string> names;
  std::array<bool, 3> sky{};
  for (JsonObject& object : root.objects("objects")) {
    if (scene.objects.size() == 1000) root.refuse("objects", "expected at most 1000 objects");
    scene.objects.push_back(read_object(object, metric, names, place));
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

  scene.canonical = canonical_json(document);
  document.erase("look");
  scene.sha256 = sha256(canonical_json(document));
  return scene;
}

}  // namespace nullcone
