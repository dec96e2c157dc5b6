// Sequences: the plain scene of each frame, and what is refused with its place.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/frame_numbers.h"
#include "core/base/json.h"
#include "core/scene/read_scene.h"
#include "core/scene/sequence.h"
#include "metrics/registry.h"

namespace nullcone {
namespace {

using nlohmann::json;
using Pointer = json::json_pointer;

/// Five frames at the coordinate times 0.5, 1, 1.5, 2, 2.5, with a camera that turns.
json sequence() {
  return json::parse(R"({
    "frames": {"count": 5, "from": 0.5, "to": 2.5},
    "metric": {"name": "goedel", "a": {"keyframes": [[0.5, 1], [2.5, 3]]}},
    "observer": {"event": [0, 0.25, 0, {"keyframes": [[1, 0], [2, 0.5]], "interpolation": "smooth"}]},
    "camera": {"type": "panorama", "azimuth_deg": {"keyframes": [[0.5, 10], [2.5, 50]], "by": "time"},
               "fov_deg": [90, 45], "resolution": [8, 4]},
    "objects": [{"name": "ball", "shape": {"type": "sphere", "radius": 0.1},
                 "placing": {"type": "coordinate", "centre": [0.5, 0.5, 0]}}],
    "look": {"exposure": {"ev": {"keyframes": [[0, -1], [4, 1]]}}}})");
}

json sequence_with(const char* pointer, const json& value) {
  json out = sequence();
  out[Pointer(pointer)] = value;
  return out;
}

json at(const json& scene, int frame) { return scene_at(scene, read_frames(scene, "s"), frame, "s"); }

template <class F>
std::string complaint(F&& f) {
  try {
    f();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

void expect_frame_refused(const json& scene, const std::string& start, const std::string& part = "") {
  const std::string found =
      complaint([&] { read_scene(canonical_json(at(scene, 1)), "s", metric_descriptions()); });
  EXPECT_TRUE(found.starts_with(start)) << "'" << found << "' does not begin with '" << start << "'";
  EXPECT_NE(found.find(part), std::string::npos) << "'" << found << "' lacks '" << part << "'";
}

TEST(Sequence, AFrameIsThePlainSceneByHand) {
  json by_hand = sequence();
  by_hand.erase("frames");
  by_hand["metric"]["a"] = 2;
  by_hand["observer"]["event"] = {1.5, 0.25, 0, 0.25};  // half way between keys, for smooth ones as well
  by_hand["camera"]["azimuth_deg"] = 30;
  EXPECT_EQ(at(sequence(), 2), by_hand);
  const auto metrics = metric_descriptions();
  const Scene made = read_scene(canonical_json(at(sequence(), 2)), "s", metrics),
              written = read_scene(canonical_json(by_hand), "s", metrics);
  EXPECT_EQ(made.canonical, written.canonical) << "whole numbers without a point, as people write them";
  EXPECT_EQ(made.sha256, written.sha256);
}

TEST(Sequence, TimesAreEvenAndTheEndsExact) {
  Frames frames{250, 0.9, 2.4, true};
  EXPECT_EQ(frames.time(0), 0.9);
  EXPECT_EQ(frames.time(249), 2.4);
  for (int i = 1; i < 250; ++i)  // rounding of numbers of that size
    EXPECT_NEAR(frames.time(i) - frames.time(i - 1), 1.5 / 249, 1e-15) << i;
  EXPECT_EQ((Frames{1, 3, 7, true}.time(0)), 3);
  EXPECT_EQ((Frames{3, 4, -4, true}.time(1)), 0) << "time may run backwards";
}

TEST(Sequence, ByProperTimeTheSceneItselfSaysWhereTheCameraIs) {
  json scene = sequence_with("/frames/time", "proper");
  scene["observer"]["event"][0] = json::parse(R"({"keyframes": [[0.5, 0], [2.5, 6]]})");
  EXPECT_EQ(at(scene, 1)["observer"]["event"], json::parse("[1.5, 0.25, 0, 0]"));
}

TEST(Sequence, LooksKeepTheirKeyframes) {
  EXPECT_EQ(at(sequence(), 3)["look"], sequence()["look"]);
  json other = sequence();
  other["look"] = json::object();
  const auto sha = [](const json& scene) {
    return read_scene(canonical_json(at(scene, 3)), "s", metric_descriptions()).sha256;
  };
  EXPECT_EQ(sha(other), sha(sequence())) << "the look is no part of the hash";
}

TEST(Sequence, WhatMakesNoSenseIsRefusedWithItsPlace) {
  const json keys = json::parse(R"({"keyframes": [[0, 1], [2, 3]]})");
  expect_frame_refused(sequence_with("/frames/count", 0), "s: /frames/count:", "from 1 to 1000000");
  expect_frame_refused(sequence_with("/frames/count", 1'000'001), "s: /frames/count:");
  expect_frame_refused(sequence_with("/frames/count", 2.5), "s: /frames/count:", "whole number");
  expect_frame_refused(sequence_with("/frames/step", 1), "s: /frames/step:", "unknown key");
  expect_frame_refused(sequence_with("/frames/time", "tau"), "s: /frames/time:", "coordinate, proper");
  expect_frame_refused(sequence_with("/frames/to", keys), "s: /frames/to:", "expected a number");
  expect_frame_refused(sequence_with("/frames", 25), "s: /frames:");
  expect_frame_refused(sequence_with("/observer/event/0", 1), "s: /observer/event/0:", "expected 0");
  expect_frame_refused(sequence_with("/observer/event/0", keys), "s: /observer/event/0:", "expected 0");
  expect_frame_refused(sequence_with("/camera/azimuth_deg/by", "frame"),
                       "s: /camera/azimuth_deg/by:", "time");
  expect_frame_refused(sequence_with("/camera/azimuth_deg/keyframes/1/0", 0.5),
                       "s: /camera/azimuth_deg/keyframes/1:", "later time");
  expect_frame_refused(sequence_with("/objects/0/name", keys), "s: /objects/0/name:", "found number");
  expect_frame_refused(sequence_with("/metric/name", keys), "s: /metric/name:", "found number");
  expect_frame_refused(sequence_with("/camera", keys), "s: /camera:", "expected an object");
  expect_frame_refused(
      sequence_with("/camera/resolution/0", json::parse(R"({"keyframes": [[0, 8], [2, 9]]})")),
      "s: /camera/resolution:", "whole numbers");
}

TEST(Sequence, TheReaderOfScenesTakesNone) {
  const auto read = [](const json& scene) {
    return complaint([&] { read_scene(canonical_json(scene), "s", metric_descriptions()); });
  };
  EXPECT_TRUE(read(sequence()).starts_with("s: /frames: this is a sequence")) << read(sequence());
  json scene = sequence();
  scene.erase("frames");
  EXPECT_TRUE(read(scene).starts_with("s: /camera/azimuth_deg: has keyframes")) << read(scene);
  EXPECT_FALSE(is_sequence(scene));
  EXPECT_EQ(read(at(sequence(), 0)), "") << "keyframes of the look are post-rendering's";
}

TEST(Sequence, NumbersAreListedInRuns) {
  EXPECT_EQ(runs_of({}), "");
  EXPECT_EQ(runs_of({7}), "7");
  EXPECT_EQ(runs_of({7, 2, 0, 1, 3}), "0-3,7");
  EXPECT_EQ(runs_of({5, 3, 1}), "1,3,5");
}

}  // namespace
}  // namespace nullcone
