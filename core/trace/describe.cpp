#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/version.h"
#include "core/trace/trace_scene.h"

namespace nullcone {

namespace {

using nlohmann::json;

/// Everything that the numbers of a picture depend on, besides objects, with all defaults resolved. Angles in
/// radians, as the code has them.
json setting(const Scene& scene) {
  const Camera& c = scene.camera;
  const Observer& o = scene.observer;
  json paths = {{"type", scene.integrated ? "integrated" : "closed"},
                {"max_lookback", std::isfinite(scene.max_lookback) && scene.max_lookback < 1e300
                                     ? json(scene.max_lookback)
                                     : json("unlimited")}};
  if (scene.integrated)
    paths["accuracy"] = {
        {"rtol", scene.accuracy.rtol},
        {"atol", scene.accuracy.atol},
        {"integrator", std::string(kIntegratorNames[static_cast<std::size_t>(scene.accuracy.integrator)])}};
  if (std::isfinite(scene.max_lookback_t)) paths["max_lookback_t"] = scene.max_lookback_t;
  json records = json::object();
  if (scene.records.max_hits > 0) records["max_hits"] = scene.records.max_hits;
  if (scene.records.max_order != Records::kAnyOrder) records["order"] = scene.records.max_order;
  json out = {{"metric_parameters", scene.metric_parameters},
              {"observer",
               {{"event", o.event},
                {"velocity", o.velocity},
                {"frame", o.frame == ObserverFrame::normal ? "normal" : "static"}}},
              {"camera",
               {{"type", kCameraNames[static_cast<std::size_t>(c.type)]},
                {"samples", c.samples},
                {"fov_rad", {c.fov_horizontal, c.fov_vertical}},
                {"forward", c.forward},
                {"left", c.left},
                {"up", c.up}}},
              {"paths", paths},
              {"records", records}};
  if (has_film(c)) out["camera"]["extent"] = {c.extent_horizontal, c.extent_vertical};
  if (const Lights& l = scene.lights; !l.lamps.empty())
    out["lights"] = {{"windings", l.windings}, {"paths", l.paths}, {"shadows", l.shadows}, {"cap", l.cap}};
  return out;
}

}  // namespace

int format_of(const Scene& scene) {
  const CameraType camera = scene.camera.type;
  if (std::isfinite(scene.max_lookback_t)) return 4;
  if (camera != CameraType::perspective && camera != CameraType::panorama) return 4;
  return scene.lights.lamps.empty() ? 2 : 3;
}

Manifest describe(const Spacetime& spacetime, const Scene& scene, const Tracer& tracer) {
  Manifest out;
  out.set_size(scene.camera.width, scene.camera.height);
  out.samples = scene.camera.samples;
  out.channels = scene.records.channels;
  out.scene = scene.canonical;
  out.scene_sha256 = scene.sha256;
  out.metric = scene.metric;
  out.setting = setting(scene).dump();
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    out.objects.push_back({scene.objects[i].name, tracer.tau_origin(i)});
  std::vector<ObjectEntry> lamps;
  for (std::size_t i = 0; i < scene.lights.lamps.size(); ++i)
    lamps.push_back({scene.lights.lamps[i].name, tracer.lamp_tau_origin(i)});
  out.set_lights(std::move(lamps), scene.lights.paths);
  out.format = format_of(scene);
  out.version = code_version();
  out.isa = spacetime.isa();
  out.host = host_name();
  return out;
}

}  // namespace nullcone
