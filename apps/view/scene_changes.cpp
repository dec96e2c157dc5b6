#include "apps/view/scene_changes.h"

#include <algorithm>
#include <cmath>

#include "apps/view/thin.h"
#include "core/base/json.h"
#include "core/scene/read_placing.h"

namespace nullcone::view {

namespace {

using nlohmann::json;

bool at_rest(const json& velocity) {
  return std::ranges::all_of(velocity, [](const json& component) { return component.get<double>() == 0; });
}

void copy_event(JsonObject& from, json& to) {
  if (from.has("event")) to["event"] = read_event(from, "event");
}

void change_metric(JsonObject changes, const MetricDescription& metric, json& scene) {
  for (const MetricParameter& parameter : metric.parameters)
    if (parameter.words[0].empty() && changes.has(parameter.name))
      scene[std::string(parameter.name)] = changes.number(parameter.name, parameter.least, parameter.most);
  changes.finish();
}

void change_observer(JsonObject changes, json& scene) {
  copy_event(changes, scene);
  if (changes.has("velocity")) scene["velocity"] = read_velocity(changes, "velocity");
  changes.finish();
}

void change_camera(JsonObject changes, json& scene) {
  for (const char* key : {"azimuth_deg", "elevation_deg", "roll_deg"})
    if (changes.has(key)) scene[key] = changes.number(key);
  if (changes.has("fov_deg")) {
    if (scene.value("fov_deg", json()).is_array())
      scene["fov_deg"] = changes.numbers("fov_deg", 2);
    else
      scene["fov_deg"] = changes.number("fov_deg");
  }
  if (changes.has("resolution")) {
    const auto size = changes.numbers("resolution", 2, kLeastSide, kMostSide);
    if (size[0] * size[1] > kMostPixels)
      changes.refuse("resolution", "asks for more than " + std::to_string(std::lround(kMostPixels)) +
                                       " pixels; expected fewer");
    scene["resolution"] = size;
  }
  changes.finish();
}

/// The default of `axes` goes by the velocity: textures would jump when it becomes, or ceases to be, zero.
void keep_axes(json& placing) {
  if (placing.contains("axes")) return;
  const json& worldline = placing.at("worldline");
  const bool rests = worldline.at("type") == "static" || !worldline.contains("velocity") ||
                     at_rest(worldline.at("velocity"));
  placing["axes"] = rests ? "static" : "gyroscope";
}

void change_placing(JsonObject& changes, json& placing) {
  if (placing.at("type") == "coordinate") {
    if (changes.has("velocity"))
      changes.refuse("velocity", "the object is fixed in the chart (placing 'coordinate'); expected none");
    if (!changes.has("event")) return;
    const Event event = read_event(changes, "event");
    placing["centre"] = {event[1], event[2], event[3]};
    return;
  }
  json& worldline = placing.at("worldline");
  copy_event(changes, worldline);
  if (!changes.has("velocity")) return;
  const json velocity = read_velocity(changes, "velocity");
  if (worldline.at("type") == "static" && at_rest(velocity)) return;
  keep_axes(placing);
  worldline["type"] = "geodesic";
  worldline["velocity"] = velocity;
}

void change_object(JsonObject changes, json& object) {
  json& shape = object.at("shape");
  if (changes.has("radius")) {
    if (shape.at("type") != "sphere") changes.refuse("radius", "the object is not a sphere; expected none");
    shape["radius"] = read_radius(changes);
  }
  if (object.contains("placing")) {
    change_placing(changes, object["placing"]);
  } else {
    for (const char* key : {"event", "velocity"})
      if (changes.has(key)) changes.refuse(key, "the object has no place; expected none");
  }
  changes.finish();
}

void change_objects(JsonObject changes, json& objects) {
  for (json& object : objects) {
    const auto name = object.at("name").get<std::string>();
    if (changes.has(name)) change_object(changes.object(name), object);
  }
  changes.finish();
}

}  // namespace

void apply_changes(const json& changes, const MetricDescription& metric, json& scene) {
  if (changes.is_null()) return;
  JsonObject root(changes, "scene", "");
  if (root.has("metric")) change_metric(root.object("metric"), metric, scene.at("metric"));
  if (root.has("observer")) change_observer(root.object("observer"), scene.at("observer"));
  if (root.has("camera")) change_camera(root.object("camera"), scene.at("camera"));
  if (root.has("objects")) change_objects(root.object("objects"), scene.at("objects"));
  root.finish();
}

void make_coarser(json& scene, int step) {
  if (step == 1) return;
  json& camera = scene.at("camera");
  for (json& side : camera.at("resolution")) side = thinned(static_cast<int>(side.get<double>()), step);
  camera.erase("samples");
}

}  // namespace nullcone::view
