// Small scenes that are traced live, for tests.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "apps/view/live.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "tests/postrender_fixture.h"

namespace nullcone::view {

using nlohmann::json;

/// A sphere straight ahead, 10 away, and a box beside it.
inline const json kFlat =
    json::parse(R"({"metric": {"name": "minkowski"}, "observer": {"event": [0, 0, 0, 0]},
  "camera": {"type": "perspective", "fov_deg": 40, "resolution": [33, 17], "samples": 2},
  "objects": [
    {"name": "ball", "shape": {"type": "sphere", "radius": 1}, "placing": {"type": "local", "worldline":
      {"type": "static", "event": [0, 10, 0, 0]}}},
    {"name": "box", "shape": {"type": "box", "edges": [1, 1, 1]}, "placing": {"type": "coordinate",
      "centre": [12, 3, 0]}}],
  "look": {"objects": {"ball": {"texture": {"type": "color", "rgb": [1, 0, 0]}}}}})");

inline const json kGoedel =
    json::parse(R"({"metric": {"name": "goedel", "a": 1}, "observer": {"event": [2, 0, 0, 0]},
  "camera": {"type": "panorama", "fov_deg": [120, 60], "resolution": [40, 20]}, "max_lookback": 8,
  "records": {"channels": ["order", "uv", "shift", "t", "tau", "mu", "N"]},
  "objects": [
    {"name": "still", "shape": {"type": "sphere", "radius": 0.2}, "placing": {"type": "local", "worldline":
      {"type": "static", "event": [0, 0.8, 0.1, 0]}}},
    {"name": "fast", "shape": {"type": "sphere", "radius": 0.1}, "placing": {"type": "local", "worldline":
      {"type": "geodesic", "event": [0, 0.5, -0.4, 0], "velocity": [0.3, 0, 0]}}}],
  "lights": {"lamps": [{"name": "lamp", "worldline": {"type": "static", "event": [0, 0.8, 0.1, 0]},
                        "body": "still"}]}})");

/// All round, by directions.
inline const json kCube = [] {
  json out = kFlat;
  out["camera"] = json::parse(
      R"({"type": "cube_map", "resolution": [126, 21], "forward": [1, 2, 1], "up": [0.3, 0, 1]})");
  return out;
}();

inline Manifest manifest_of(const json& scene) {
  Manifest out;
  out.set_size(1, 1);
  out.scene = canonical_json(scene);
  return out;
}
inline LiveScene live(const json& scene, const LiveLimits& limits = {}) {
  return LiveScene(manifest_of(scene), "", nullptr, limits);
}

/// What is complained about; empty if nothing is.
inline std::string complaint(const json& scene, const json& changes, int scale = 1) {
  try {
    live(scene).trace(changes, scale);
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace nullcone::view
