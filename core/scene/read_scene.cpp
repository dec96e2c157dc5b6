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
#include "core/scene/read_records.h"

namespace nullcone {

namespace {

constexpr double kRadians = std::numbers::pi / 180;
/// Coordinates, lengths and times beyond this lose all digits of what a picture shows.
constexpr double kLargest = 1e15;
constexpr long kMostPixels = 1L << 28;

template <std::size_t N>
std::array<double, N> to_array(const std::vector<double>& values) {
  std::array<double, N> out{};
  std::copy_n(values.begin(), N, out.begin());
  return out;
}

Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// A direction of any length but zero, normalised.
Triple direction(JsonObject& object, std::string_view key, const std::vector<double>& fallback) {
  const auto v = to_array<3>(object.numbers_or(key, fallback, -kLargest, kLargest));
  const double length = std::sqrt(dot(v, v));
  if (!(length > 1e-100)) object.refuse(key, "expected a direction, found (almost) zero");
  return {v[0] / length, v[1] / length, v[2] / length};
}

/// Rows x, y, z: z along `z`, y as near to `y` as can be.
std::array<Triple, 3> axes_from(JsonObject& object, std::string_view z_key,
                                const std::vector<double>& z_default, std::string_view y_key,
                                const std::vector<double>& y_default) {
  const Triple z = direction(object, z_key, z_default), wish = direction(object, y_key, y_default);
  Triple x = cross(wish, z);
  const double length = std::sqrt(dot(x, x));
  if (!(length > 1e-9))
    object.refuse(y_key, "expected a direction that is not parallel to " + std::string(z_key));
  for (double& component : x) component /= length;
  return {x, cross(z, x), z};
}

Event read_event(JsonObject& object, std::string_view key) {
  return to_array<4>(object.numbers(key, 4, -kLargest, kLargest));
}

Triple read_velocity(JsonObject& object, std::string_view key) {
  const auto v = to_array<3>(object.numbers_or(key, {0, 0, 0}, -1, 1));
  if (!(dot(v, v) < 1)) object.refuse(key, "is not slower than light; expected a length below 1");
  return v;
}

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

Shape read_shape(JsonObject shape, const MetricDescription& metric) {
  Shape out;
  const std::string type = shape.word("type", {"sphere", "quad", "box", "sky"});
  if (type == "sphere") {
    out.type = ShapeType::sphere;
    out.radius = shape.positive("radius");
    if (out.radius > kLargest) shape.refuse("radius", "expected at most 1e15");
    out.dome = shape.boolean("dome", false);
  } else if (type == "quad" || type == "box") {
    out.type = type == "quad" ? ShapeType::quad : ShapeType::box;
    const auto edges = shape.numbers("edges", type == "quad" ? 2 : 3, 1e-300, kLargest);
    std::ranges::copy(edges, out.edges.begin());
  } else {
    out.type = ShapeType::sky;
    out.sky = shape.has("side") ? static_cast<unsigned>(shape.integer("side", 1, 2)) : 1;
    if (out.sky > static_cast<unsigned>(std::max(metric.skies, 1)))
      shape.refuse("side", "the spacetime '" + std::string(metric.name) + "' has only one sky");
    if (metric.skies == 0)
      shape.refuse("type", "the spacetime '" + std::string(metric.name) +
                               "' has no infinity to hold a sky; use a sphere with \"dome\": true");
  }
  shape.finish();
  return out;
}

Worldline read_worldline(JsonObject worldline) {
  Worldline out;
  const std::string type = worldline.word("type", {"static", "geodesic"});
  out.event = read_event(worldline, "event");
  if (type == "geodesic") out.velocity = read_velocity(worldline, "velocity");
  worldline.finish();
  return out;
}

Placing read_placing(JsonObject placing) {
  Placing out;
  if (placing.word("type", {"coordinate", "local"}) == "coordinate") {
    out.type = PlacingType::coordinate;
    const auto centre = placing.numbers("centre", 3, -kLargest, kLargest);
    out.worldline.event = {0, centre[0], centre[1], centre[2]};
  } else {
    out.type = PlacingType::local;
    out.worldline = read_worldline(placing.object("worldline"));
    out.gyroscope_axes = placing.word("axes", {"gyroscope", "static"},
                                      out.worldline.is_static() ? "static" : "gyroscope") == "gyroscope";
  }
  out.axes = axes_from(placing, "z_axis", {0, 0, 1}, "y_axis", {0, 1, 0});
  placing.finish();
  return out;
}

Object read_object(JsonObject object, const MetricDescription& metric, std::set<std::string>& taken) {
  Object out;
  out.name = object.name("name", taken);
  out.shape = read_shape(object.object("shape"), metric);
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
    scene.objects.push_back(read_object(object, metric, names));
    if (scene.objects.back().shape.type != ShapeType::sky) continue;
    if (std::exchange(sky[scene.objects.back().shape.sky], true))
      object.refuse("shape/type", "is a second sky; expected one at most");
  }
  if (scene.objects.empty()) root.refuse("objects", "is empty; expected at least one object to look at");
  scene.records = read_records(root, scene.camera.samples);
  if (root.has("look")) root.object("look");  // its contents are post-rendering's affair
  root.text("$schema", "");
  root.finish();

  scene.canonical = canonical_json(document);
  document.erase("look");
  scene.sha256 = sha256(canonical_json(document));
  return scene;
}

}  // namespace nullcone
