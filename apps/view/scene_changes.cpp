#include "apps/view/scene_changes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "apps/view/thin.h"
#include "core/base/json.h"
#include "core/scene/read_camera.h"
#include "core/scene/read_placing.h"

namespace nullcone::view {

namespace {

using nlohmann::json;

// Numbers are checked here, and go into the scene as they were written.

bool at_rest(const json& velocity) {
  return std::ranges::all_of(velocity, [](const json& component) { return component.get<double>() == 0; });
}

void copy_event(JsonObject& from, json& to) {
  if (!from.has("event")) return;
  read_event(from, "event");
  to["event"] = from.at("event");
}

void copy_number(JsonObject& from, std::string_view key, json& to) {
  from.number(key);
  to[std::string(key)] = from.at(key);
}

void change_metric(JsonObject changes, const MetricDescription& metric, json& scene) {
  for (const MetricParameter& parameter : metric.parameters)
    if (parameter.words[0].empty() && changes.has(parameter.name))
      copy_number(changes, parameter.name, scene);
  changes.finish();
}

void change_observer(JsonObject changes, json& scene) {
  copy_event(changes, scene);
  if (changes.has("velocity")) {
    read_velocity(changes, "velocity");
    scene["velocity"] = changes.at("velocity");
  }
  changes.finish();
}

/// Of a camera that is given by directions, the angles.
void use_angles(json& scene) {
  const Camera camera = read_camera(JsonObject(scene, "scene", "/camera"));
  const Triple &forward = camera.forward, &left = camera.left;
  const double flat = std::hypot(forward[0], forward[1]);
  const bool upright = flat < 1e-9;  // azimuth and roll are one then: all of it is azimuth
  constexpr double kDegrees = 180 / std::numbers::pi;
  scene.erase("forward");
  scene.erase("up");
  scene["azimuth_deg"] =
      kDegrees * (upright ? std::atan2(-left[0], left[1]) : std::atan2(forward[1], forward[0]));
  scene["elevation_deg"] = kDegrees * std::atan2(forward[2], flat);
  scene["roll_deg"] = upright ? 0 : kDegrees * std::atan2(left[2], camera.up[2]);
}

void change_camera(JsonObject changes, json& scene) {
  for (const char* key : {"azimuth_deg", "elevation_deg", "roll_deg"}) {
    if (!changes.has(key)) continue;
    if (scene.contains("forward")) use_angles(scene);
    copy_number(changes, key, scene);
  }
  if (changes.has("fov_deg")) {
    if (scene.value("fov_deg", json()).is_array())
      changes.numbers("fov_deg", 2);
    else
      changes.number("fov_deg");
    scene["fov_deg"] = changes.at("fov_deg");
  }
  if (changes.has("extent")) copy_number(changes, "extent", scene);
  if (changes.has("resolution")) {
    const auto size = changes.numbers("resolution", 2, kLeastSide, kMostSide);
    if (size[0] * size[1] > kMostPixels)
      changes.refuse("resolution", "asks for more than " + std::to_string(std::lround(kMostPixels)) +
                                       " pixels; expected fewer");
    scene["resolution"] = changes.at("resolution");
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
    read_event(changes, "event");
    const json& event = changes.at("event");
    placing["centre"] = {event[1], event[2], event[3]};
    return;
  }
  json& worldline = placing.at("worldline");
  const auto type = worldline.at("type").get<std::string>();
  for (const char* key : {"event", "velocity"})
    if (changes.has(key) && type != "static" && type != "geodesic")
      changes.refuse(key, "the object's worldline is '" + type + "'; expected no change of it");
  copy_event(changes, worldline);
  if (!changes.has("velocity")) return;
  read_velocity(changes, "velocity");
  const json& velocity = changes.at("velocity");
  if (worldline.at("type") == "static" && at_rest(velocity)) return;
  keep_axes(placing);
  worldline["type"] = "geodesic";
  worldline["velocity"] = velocity;
}

void change_object(JsonObject changes, json& object) {
  json& shape = object.at("shape");
  if (changes.has("radius")) {
    if (shape.at("type") != "sphere") changes.refuse("radius", "the object is not a sphere; expected none");
    read_radius(changes);
    shape["radius"] = changes.at("radius");
  }
  if (object.contains("placing")) {
    change_placing(changes, object["placing"]);
  } else {
    for (const char* key : {"event", "velocity"})
      if (changes.has(key)) changes.refuse(key, "the object has no place; expected none");
  }
  changes.finish();
}

/// Lamps with this body that were where it was go where it goes.
void take_lamps_along(const json& before, const json& after, json& scene) {
  if (!before.contains("placing") || !before["placing"].contains("worldline")) return;
  const json &from = before["placing"]["worldline"], &to = after.at("placing").at("worldline");
  if (from == to || !scene.contains("lights")) return;
  for (json& lamp : scene["lights"].at("lamps")) {
    if (lamp.value("body", json()) != before.at("name") || lamp.at("worldline") != from) continue;
    const bool has_axes = lamp.contains("shape") && lamp["shape"].value("type", "point") == "quad";
    if (has_axes) keep_axes(lamp);
    lamp["worldline"] = to;
  }
}

void change_objects(JsonObject changes, json& scene) {
  for (json& object : scene.at("objects")) {
    const auto name = object.at("name").get<std::string>();
    if (!changes.has(name)) continue;
    const json before = object;
    change_object(changes.object(name), object);
    take_lamps_along(before, object, scene);
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
  if (root.has("objects")) change_objects(root.object("objects"), scene);
  root.finish();
}

void make_coarser(json& scene, int step) {
  if (step == 1) return;
  json& camera = scene.at("camera");
  json& size = camera.at("resolution");
  const double width = size[0].get<double>(), height = size[1].get<double>();
  const std::string type = camera.at("type");
  size[1] = thinned(static_cast<int>(height), step);
  if (type == "cube_map" || type == "tetrahedron_map")  // their faces stay square
    size[0] = size[1].get<int>() * std::lround(width / height);
  else
    size[0] = thinned(static_cast<int>(width), step);
  camera.erase("samples");
}

}  // namespace nullcone::view
