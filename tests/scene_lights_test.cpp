// What a scene says of its lamps.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/scene/read_scene.h"
#include "metrics/registry.h"

namespace nullcone::test {
namespace {

using nlohmann::json;
using Pointer = json::json_pointer;

/// A ball and the sky, with these lights.
json scene_of(const json& lights) {
  json out = json::parse(R"({"metric": {"name": "minkowski"}, "observer": {"event": [0, 0, 0, 0]},
    "camera": {"type": "sphere", "resolution": [8, 4]},
    "objects": [{"name": "stars", "shape": {"type": "sky"}},
                {"name": "ball", "shape": {"type": "sphere", "radius": 1},
                 "placing": {"type": "coordinate", "centre": [3, 0, 0]}}]})");
  out["lights"] = lights;
  return out;
}
Scene read(const json& scene) { return read_scene(scene.dump(), "s", metric_descriptions()); }
std::string complaint(const json& scene) {
  try {
    read(scene);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

json point() {
  return json::parse(R"({"name": "sun", "worldline": {"type": "static", "event": [1, 2, 3, 4]}})");
}
/// Everything that can be said.
json all() {
  return json::parse(R"({"windings": 3, "paths": 4, "shadows": false, "cap": 50, "lamps": [
    {"name": "sun", "worldline": {"type": "static", "event": [1, 2, 3, 4]}, "shape": {"type": "point"}},
    {"name": "bulb", "worldline": {"type": "geodesic", "event": [0, 5, 6, 7], "velocity": [0, 0.5, 0]},
     "shape": {"type": "sphere", "radius": 0.25}, "samples": 64, "body": "ball"},
    {"name": "panel", "worldline": {"type": "static", "event": [0, 0, 0, 9]},
     "shape": {"type": "quad", "edges": [2, 3]}, "axes": "gyroscope", "z_axis": [2, 0, 0], "y_axis": [0, 0, 1]}]})");
}

TEST(SceneLights, DefaultsAreTwoPathsOfPoints) {
  const Lights lights = read(scene_of({{"lamps", {point()}}})).lights;
  EXPECT_EQ(lights.windings, 1);
  EXPECT_EQ(lights.paths, 2);
  EXPECT_TRUE(lights.shadows);
  EXPECT_EQ(lights.cap, 1e12);
  ASSERT_EQ(lights.lamps.size(), 1u);
  const Lamp& sun = lights.lamps[0];
  EXPECT_TRUE(sun.is_point());
  EXPECT_EQ(sun.samples, 1u);
  EXPECT_EQ(sun.body, 0u);
  EXPECT_EQ(sun.placing.type, PlacingType::local);
  EXPECT_EQ(sun.placing.worldline.event, (Event{1, 2, 3, 4}));
  EXPECT_TRUE(sun.placing.worldline.is_static());
  EXPECT_TRUE(read(scene_of({{"lamps", {point()}}})).objects.size() == 2);
}

TEST(SceneLights, EverythingIsRead) {
  const Lights lights = read(scene_of(all())).lights;
  EXPECT_EQ(lights.windings, 3);
  EXPECT_EQ(lights.paths, 4);
  EXPECT_FALSE(lights.shadows);
  EXPECT_EQ(lights.cap, 50);
  ASSERT_EQ(lights.lamps.size(), 3u);
  EXPECT_EQ(lights.all_paths(), 12u);
  const Lamp &bulb = lights.lamps[1], &panel = lights.lamps[2];
  EXPECT_EQ(bulb.name, "bulb");
  EXPECT_EQ(bulb.type, ShapeType::sphere);
  EXPECT_EQ(bulb.radius, 0.25);
  EXPECT_EQ(bulb.samples, 64u);
  EXPECT_EQ(bulb.body, 2u);
  EXPECT_EQ(bulb.placing.worldline.velocity, (Triple{0, 0.5, 0}));
  EXPECT_TRUE(bulb.placing.gyroscope_axes);
  EXPECT_EQ(panel.type, ShapeType::quad);
  EXPECT_EQ(panel.edges, (std::array<double, 2>{2, 3}));
  EXPECT_EQ(panel.samples, 16u);
  EXPECT_TRUE(panel.placing.gyroscope_axes);
  EXPECT_EQ(panel.placing.axes, (std::array<Triple, 3>{{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}}));
}

TEST(SceneLights, AreAlwaysRecordedAndNeverWithoutLamps) {
  json scene = scene_of(all());
  EXPECT_EQ(read(scene).records.channels, kDefaultChannels | ChannelSet::of("light"));
  scene["records"] = {{"channels", json::array()}};
  EXPECT_EQ(read(scene).records.channels, kLeastChannels | ChannelSet::of("light"));
  scene["records"] = {{"channels", {"light", "t"}}};
  EXPECT_EQ(read(scene).records.channels, kLeastChannels | ChannelSet::of("light") | ChannelSet::of("t"));
  scene.erase("lights");
  EXPECT_EQ(complaint(scene).substr(0, 24), "s: /records/channels/0: ");
  scene["records"] = {{"channels", {"t"}}};
  EXPECT_EQ(read(scene).records.channels, kLeastChannels | ChannelSet::of("t"));
  EXPECT_TRUE(read(scene).lights.lamps.empty());
}

TEST(SceneLights, BelongToTheFingerprint) {
  json dimmed = scene_of(all());
  dimmed["lights"]["lamps"][0]["worldline"]["event"][1] = 2.5;
  EXPECT_NE(read(dimmed).sha256, read(scene_of(all())).sha256);
}

/// Refused after the entry at `pointer` of /lights has become `value`.
void expect_refused(const char* pointer, const json& value, const std::string& place,
                    const std::string& part = "") {
  json lights = all();
  lights[Pointer(pointer)] = value;
  const std::string found = complaint(scene_of(lights)), start = "s: /lights" + place + ": ";
  EXPECT_EQ(found.substr(0, start.size()), start) << pointer << " = " << value << ": " << found;
  EXPECT_NE(found.find(part), std::string::npos) << found;
}

TEST(SceneLights, WhatIsWrongIsRefusedWithItsPlace) {
  const struct {
    const char* pointer;
    json value;
    const char* part = "expected";
  } cases[] = {{"/windings", 0},
               {"/windings", 65},
               {"/windings", 1.5},
               {"/paths", 0},
               {"/paths", 17},
               {"/shadows", 1},
               {"/cap", 0},
               {"/cap", -1},
               {"/cap", 1e31},
               {"/lamp", 1, "unknown key"},
               {"/lamps", json::array(), "at least one lamp"},
               {"/lamps", 3},
               {"/lamps/0/name", "1st"},
               {"/lamps/1/name", "sun", "different names"},
               {"/lamps/0/colour", 1, "unknown key"},
               {"/lamps/0/samples", 4, "unknown key"},
               {"/lamps/0/z_axis", {0, 0, 1}, "unknown key"},
               {"/lamps/0/axes", "static", "unknown key"},
               {"/lamps/1/axes", "static", "unknown key"},
               {"/lamps/1/y_axis", {0, 0, 1}, "unknown key"},
               {"/lamps/1/samples", 0},
               {"/lamps/1/samples", 4097},
               {"/lamps/1/body", "moon", "an object of the scene"},
               {"/lamps/1/body", "stars", "sky"},
               {"/lamps/1/body", 2},
               {"/lamps/0/worldline/type", "circular"},
               {"/lamps/0/worldline/velocity", {0, 0, 0}, "unknown key"},
               {"/lamps/0/worldline/event", {0, 0, 0}},
               {"/lamps/0/worldline/event/2", 1e16},
               {"/lamps/1/worldline/velocity", {0, 0, 1}, "slower than light"},
               {"/lamps/0/shape/type", "box", "point, sphere, quad"},
               {"/lamps/0/shape/radius", 1, "unknown key"},
               {"/lamps/1/shape/radius", 0},
               {"/lamps/1/shape/radius", 1e16},
               {"/lamps/1/shape/dome", true, "unknown key"},
               {"/lamps/2/shape/edges", {1, 2, 3}},
               {"/lamps/2/shape/edges/1", 0},
               {"/lamps/2/axes", "rolling"},
               {"/lamps/2/z_axis", {0, 0, 0}}};
  for (const auto& [pointer, value, part] : cases) expect_refused(pointer, value, pointer, part);
  expect_refused("/lamps/2/y_axis", {1, 0, 0}, "/lamps/2/y_axis", "parallel");
  for (const char* key :
       {"/lamps", "/lamps/0/name", "/lamps/0/worldline", "/lamps/1/shape/radius", "/lamps/2/shape/edges"}) {
    json lights = all();
    const Pointer pointer(key);
    lights[pointer.parent_pointer()].erase(pointer.back());
    EXPECT_EQ(complaint(scene_of(lights)).find(std::string("s: /lights") + key + ": missing"), 0u) << key;
  }
}

TEST(SceneLights, SixtyFourPathsAndNotOneMore) {
  json lights = {{"paths", 16}, {"lamps", json::array()}};
  for (int i = 0; i < 4; ++i) {
    lights["lamps"].push_back(point());
    lights["lamps"].back()["name"] = "lamp" + std::to_string(i);
  }
  EXPECT_EQ(read(scene_of(lights)).lights.all_paths(), 64u);
  lights["lamps"].push_back(point());
  EXPECT_EQ(complaint(scene_of(lights)).substr(0, 18), "s: /lights/lamps: ");
  lights["paths"] = 12;
  EXPECT_EQ(read(scene_of(lights)).lights.all_paths(), 60u);
}

}  // namespace
}  // namespace nullcone::test
