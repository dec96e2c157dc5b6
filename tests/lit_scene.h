// Scenes with lamps, with the light of every crossing in full precision.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/trace/metric.h"
#include "core/trace/trace_scene.h"
#include "metrics/minkowski.h"
#include "metrics/registry.h"

namespace nullcone::test {

/// Keeps the crossings of a picture, and the light that falls on them.
struct LightSink final : HitSink {
  std::size_t paths = 0, kept = 0;
  double tau_origin = 0;  ///< of the first lamp
  std::vector<HitRecord> hits;
  std::vector<HitLight> lights;

  HitRoom extend(std::size_t count) override {
    kept = hits.size();
    hits.resize(kept + count);
    lights.resize(hits.size() * paths);
    return {hits.data() + kept, nullptr, lights.data() + kept * paths, paths};
  }
  void keep(std::size_t count) override {
    hits.resize(kept + count);
    lights.resize(hits.size() * paths);
  }
  const HitLight& light(std::size_t hit, std::size_t path = 0) const { return lights[hit * paths + path]; }
};

/// Along closed forms where there are some and the scene does not ask otherwise.
template <host::Metric M>
LightSink lit(const M& metric, Scene scene) {
  scene.metric = M::name;
  const auto set = [&](const auto& parameter) {
    scene.metric_parameters[std::string(parameter.name)] = metric.*parameter.member;
  };
  std::apply([&](const auto&... parameter) { (set(parameter), ...); }, M::parameters);
  const auto tracer = prepare_scene(find_spacetime(scene.metric), scene, "scene");
  LightSink out;
  out.tau_origin = tracer->lamp_tau_origin(0);
  out.paths = scene.lights.lamps.size() * static_cast<std::size_t>(scene.lights.paths);
  const auto width = static_cast<std::size_t>(scene.camera.width);
  for (int line = 0; line < scene.camera.height; line += kBandLines) {
    const int lines = std::min(kBandLines, scene.camera.height - line);
    std::vector<RayRecord> rays(width * static_cast<std::size_t>(lines));
    tracer->trace_band(line, lines, {out, rays});
  }
  return out;
}
/// In flat spacetime.
inline LightSink lit(const Scene& scene) { return lit(host::Minkowski{}, scene); }

inline Camera camera(int width, int height, double fov) {
  Camera out;
  out.width = width, out.height = height;
  out.fov_horizontal = fov;
  out.fov_vertical = 2 * std::atan(std::tan(0.5 * fov) * height / width);
  return out;
}

inline Placing moving(const Event& event, const Triple& velocity) {
  Placing out;
  out.worldline = {event, velocity};
  return out;
}

inline Lamp point_lamp(const Event& event, const Triple& velocity = {0, 0, 0}) {
  Lamp out;
  out.name = "lamp";
  out.placing = moving(event, velocity);
  return out;
}

inline Scene scene_of(Camera seen_by, std::vector<Object> objects, std::vector<Lamp> lamps) {
  Scene out;
  out.camera = seen_by;
  out.max_lookback = 1e300;
  out.objects = std::move(objects);
  out.lights.lamps = std::move(lamps);
  out.lights.paths = 1;
  return out;
}

inline Object ball(const Event& event, double radius, const Triple& velocity = {0, 0, 0}) {
  Object out;
  out.name = "ball";
  out.shape.radius = radius;
  out.placing = moving(event, velocity);
  return out;
}

/// A wall in the plane x = 10, seen from its front.
inline Object wall(double edge = 12) {
  Object out;
  out.name = "wall";
  out.shape.type = ShapeType::quad;
  out.shape.edges = {edge, edge, 0};
  out.placing = moving({0, 10, 0, 0}, {0, 0, 0});
  out.placing.axes = {{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}};
  return out;
}

}  // namespace nullcone::test
