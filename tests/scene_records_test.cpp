// What a scene says of its records: channels, crossings, opacity, samples.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/scene/read_scene.h"
#include "metrics/registry.h"

namespace nullcone::test {
namespace {

using nlohmann::json;

/// A small scene, changed by a merge patch.
Scene scene_with(const char* patch) {
  json scene = json::parse(R"({"metric": {"name": "minkowski"}, "observer": {"event": [0, 0, 0, 0]},
    "camera": {"type": "sphere", "resolution": [8, 4]},
    "objects": [{"name": "ball", "shape": {"type": "sphere", "radius": 1},
                 "placing": {"type": "coordinate", "centre": [3, 0, 0]}}]})");
  scene.merge_patch(json::parse(patch));
  return read_scene(scene.dump(), "s", metric_descriptions());
}
std::string complaint(const char* patch) {
  try {
    scene_with(patch);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}
/// The object, changed.
std::string object(const char* more) {
  return std::string(R"({"objects": [{"name": "ball", "shape": {"type": "sphere", "radius": 1},
    "placing": {"type": "coordinate", "centre": [3, 0, 0]}, )") +
         more + "}]}";
}

TEST(Records, DefaultsAreTheFirstOpaqueCrossingAndWhatPostRenderingNeeds) {
  const Scene scene = scene_with("{}");
  EXPECT_EQ(scene.records.max_hits, 0u);
  EXPECT_EQ(scene.records.max_order, Records::kAnyOrder);
  EXPECT_EQ(scene.records.channels, kDefaultChannels);
  EXPECT_EQ(scene.camera.samples, 1);
  EXPECT_EQ(scene.objects[0].opacity, 1);
  EXPECT_FALSE(scene.objects[0].transparent);
}

TEST(Records, ChannelsAreChosenByTheirGroups) {
  const ChannelSet least = ChannelSet::of("Z") | ChannelSet::of("A") | ChannelSet::of("id");
  EXPECT_EQ(scene_with(R"({"records": {"channels": []}})").records.channels, least);
  EXPECT_EQ(scene_with(R"({"records": {"channels": ["N", "uv", "Z"]}})").records.channels,
            least | ChannelSet::of("N") | ChannelSet::of("uv"));
  EXPECT_EQ(scene_with(R"({"records": {"differentials": true}})").records.channels,
            kDefaultChannels | ChannelSet::of("duv"));
  EXPECT_EQ(scene_with(R"({"camera": {"samples": 3}, "records": {"channels": ["t"]}})").records.channels,
            least | ChannelSet::of("t") | ChannelSet::of("sample"));
  EXPECT_EQ(scene_with(R"({"camera": {"samples": 2}})").records.channels,
            kDefaultChannels | ChannelSet::of("sample"));
  EXPECT_EQ(ChannelSet::of("nonsense").bits, 0u);
}

TEST(Records, ObjectsMayBeTransparent) {
  EXPECT_TRUE(scene_with(object(R"("opacity": 0.25)").c_str()).objects[0].transparent);
  EXPECT_EQ(scene_with(object(R"("opacity": 0.25)").c_str()).objects[0].opacity, 0.25);
  EXPECT_TRUE(scene_with(object(R"("transparent": true)").c_str()).objects[0].transparent);
  EXPECT_EQ(scene_with(object(R"("transparent": true)").c_str()).objects[0].opacity, 1);
}

TEST(Records, SamplesDivideThePicture) {
  const Scene scene = scene_with(R"({"camera": {"samples": 4}})");
  const Camera rays = sample_camera(scene.camera);
  EXPECT_EQ(rays.width, 32);
  EXPECT_EQ(rays.height, 16);
  EXPECT_EQ(rays.fov_horizontal, scene.camera.fov_horizontal);
}

TEST(Records, WhatIsWrongIsRefusedWithItsPlace) {
  const std::pair<std::string, const char*> cases[] = {
      {R"({"records": 3})", "/records"},
      {R"({"records": {"max_hit": 3}})", "/records/max_hit"},
      {R"({"records": {"max_hits": 0}})", "/records/max_hits"},
      {R"({"records": {"max_hits": 1.5}})", "/records/max_hits"},
      {R"({"records": {"order": -1}})", "/records/order"},
      {R"({"records": {"channels": "uv"}})", "/records/channels"},
      {R"({"records": {"channels": ["uv", "uw"]}})", "/records/channels/1: expected one of Z, A, id, order,"},
      {R"({"records": {"channels": [7]}})", "/records/channels/0"},
      {R"({"records": {"differentials": 1}})", "/records/differentials"},
      {R"({"camera": {"samples": 0}})", "/camera/samples"},
      {R"({"camera": {"samples": 17}})", "/camera/samples"},
      {R"({"camera": {"samples": 16, "resolution": [16384, 128]}})", "/camera/samples"},
      {object(R"("opacity": 1.5)"), "/objects/0/opacity"},
      {object(R"("opacity": "half")"), "/objects/0/opacity"},
      {object(R"("opacity": 0.5, "transparent": false)"), "/objects/0/transparent"},
  };
  for (const auto& [patch, place] : cases) {
    const std::string found = complaint(patch.c_str());
    EXPECT_NE(found.find(place), std::string::npos) << patch << ": '" << found << "'";
  }
}

}  // namespace
}  // namespace nullcone::test
