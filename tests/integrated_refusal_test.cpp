// What integrated scenes refuse, and where they say so.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "tests/traced.h"

namespace nullcone::test {
namespace {

using nlohmann::json;

json hole() {
  return json::parse(R"({"metric": {"name": "kerr_schild", "spin": 0.5}, "observer": {"event": [0, 9, 0, 2]},
    "camera": {"type": "sphere", "resolution": [12, 6]}, "objects": [{"name": "ball", "shape": {"type": "sphere",
    "radius": 0.5}, "placing": {"type": "local", "worldline": {"type": "static", "event": [0, -5, 2, 1]}}}]})");
}
json with(const char* pointer, const json& value) {
  json out = hole();
  out[json::json_pointer(pointer)] = value;
  return out;
}
std::string complaint(const json& scene) {
  try {
    trace_text(scene.dump(), 1);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(IntegratedRefusal, WrongEntriesAreNamedWithTheirPlace) {
  const std::vector<std::tuple<const char*, json, const char*, const char*>> wrong = {
      {"/paths", "closed", "test: /paths: ", "no closed-form"},
      {"/paths", "bent", "test: /paths: ", "closed, integrated"},
      {"/accuracy", "best", "test: /accuracy: ", "draft, balanced, reference"},
      {"/accuracy", 1e-8, "test: /accuracy: ", "expected an object"},
      {"/accuracy", json::object(), "test: /accuracy/rtol: ", "missing"},
      {"/accuracy", {{"rtol", 0}}, "test: /accuracy/rtol: ", "1e-15"},
      {"/accuracy", {{"rtol", 1}}, "test: /accuracy/rtol: ", "0.01"},
      {"/accuracy", {{"rtol", nullptr}}, "test: /accuracy/rtol: ", "expected a number"},
      {"/accuracy", {{"rtol", 1e-8}, {"atol", -1}}, "test: /accuracy/atol: ", "from 0"},
      {"/accuracy", {{"rtol", 1e-8}, {"integrator", "euler"}}, "test: /accuracy/integrator: ", "dopri5"},
      {"/accuracy", {{"rtol", 1e-8}, {"steps", 3}}, "test: /accuracy/steps: ", "unknown key"},
      {"/metric/spin", 1.01, "test: /metric/spin: ", "from -1 to 1"},
      {"/metric/chart", "inside", "test: /metric/chart: ", "outgoing, ingoing"},
      {"/metric/chart", 1, "test: /metric/chart: ", "expected a text"},
      {"/observer/frame", "rotating", "test: /observer/frame: ", "static, normal"},
      {"/observer/event", {0, 1, 0, 0}, "test: /observer: ", "normal"},
      {"/objects/0/placing/worldline/event", {0, 1.2, 0, 0}, "test: /objects/0: ", "faster than light"},
      {"/objects/0/placing/worldline",
       {{"type", "circular"}, {"event", {0, -5, 2, 1}}, {"speed", "closed"}},
       "test: /objects/0/placing/worldline: ",
       "no closed timelike circle"},
      {"/objects/0/shape/radius", 20, "test: /objects/0: ", ""},
      {"/objects/0",
       {{"name", "s"}, {"shape", {{"type", "sky"}, {"side", 2}}}},
       "test: /objects/0/shape/side: ",
       "one sky"},
      {"/objects/0",
       {{"name", "s"}, {"shape", {{"type", "sky"}, {"side", 1.5}}}},
       "test: /objects/0/shape/side: ",
       ""}};
  for (const auto& [pointer, value, start, part] : wrong) {
    const std::string found = complaint(with(pointer, value));
    EXPECT_TRUE(found.starts_with(start)) << pointer << " " << value << ": " << found;
    EXPECT_NE(found.find(part), std::string::npos) << pointer << " " << value << ": " << found;
  }
  json goedel = hole();
  goedel["metric"] = {{"name", "goedel"}};
  goedel["observer"]["frame"] = "normal";
  EXPECT_TRUE(complaint(goedel).starts_with("test: /observer/frame: ")) << complaint(goedel);
}

TEST(IntegratedRefusal, RightEntriesAreNot) {
  for (const json& accuracy : std::vector<json>{
           "draft", "balanced", "reference", {{"rtol", 1e-6}, {"atol", 1e-3}, {"integrator", "fehlberg78"}}})
    EXPECT_EQ(complaint(with("/accuracy", accuracy)), "");
  json inside =
      with("/observer", {{"event", {0, 1.2, 0.1, 0}}, {"frame", "normal"}, {"velocity", {0.3, 0, 0}}});
  inside["metric"]["chart"] = "ingoing";
  EXPECT_EQ(complaint(inside), "");
  EXPECT_EQ(complaint(with("/max_lookback", 3)), "");
}

TEST(IntegratedRefusal, WhatCannotBeReachedEndsWithAStatus) {
  // Tolerances beyond double, and lookbacks that end in the middle of a step.
  const Traced sharp = trace_text(with("/accuracy", {{"rtol", 1e-15}, {"integrator", "dopri5"}}).dump());
  EXPECT_EQ(sharp.rays_with(Status::not_finite), 0U);
  const Traced near = trace_text(with("/max_lookback", 3).dump());
  EXPECT_EQ(near.rays_with(Status::lookback_reached), 72U);
}

}  // namespace
}  // namespace nullcone::test
