// Scenes: whatever is wrong with one is refused with its place, and whatever is accepted can be traced.
#include "core/scene/read_scene.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/base/error.h"
#include "core/record/dataset.h"
#include "core/trace/trace_scene.h"
#include "metrics/registry.h"

namespace nullcone {
namespace {

using nlohmann::json;
using Pointer = json::json_pointer;

json demo() {
  json out = json::parse(std::ifstream(NULLCONE_SOURCE "/scenes/goedel_earth.json"));
  out["camera"]["resolution"] = {22, 5};
  out.erase("look");  // not the scene reader's affair
  return out;
}

json object_at(const char* name, const json& shape, const std::vector<double>& event) {
  return {{"name", name},
          {"shape", shape},
          {"placing", {{"type", "local"}, {"worldline", {{"type", "static"}, {"event", event}}}}}};
}

json small_scene(const char* metric, const std::vector<json>& objects) {
  return {{"metric", {{"name", metric}}},
          {"observer", {{"event", {0.5, 0.25, -0.25, 0.125}}}},
          {"camera", {{"type", "sphere"}, {"resolution", {16, 8}}}},
          {"max_lookback", 8},
          {"objects", objects}};
}

Dataset trace(const std::string& text) {
  const auto metrics = metric_descriptions();
  const Scene scene = read_scene(text, "file", metrics);
  return trace_scene(find_spacetime(scene.metric), scene, "file", 1);
}

/// What reading and tracing complain about; empty if the scene gives a dataset.
std::string complaint(const std::string& text) {
  try {
    trace(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}
std::string complaint(const json& scene) { return complaint(scene.dump()); }

void expect_refused(const json& scene, const std::string& start, const std::string& part = "") {
  const std::string found = complaint(scene);
  EXPECT_EQ(found.compare(0, start.size(), start), 0)
      << "'" << found << "' does not begin with '" << start << "'";
  EXPECT_NE(found.find(part), std::string::npos) << "'" << found << "' lacks '" << part << "'";
}

/// The demo with one place changed.
json with(const char* pointer, const json& value) {
  json out = demo();
  out[Pointer(pointer)] = value;
  return out;
}

TEST(Scene, TheDemoIsRead) { EXPECT_EQ(complaint(demo()), ""); }

TEST(Scene, ValuesOutOfRangeAreRefusedWithTheirPointer) {
  const struct {
    const char* pointer;
    json value;
    const char *place, *part;
  } cases[] = {
      {"/objects/0/shape/radius", -0.1, "/objects/0/shape/radius", "greater than 0"},
      {"/objects/0/shape/radius", 0, "/objects/0/shape/radius", "greater than 0"},
      {"/objects/0/shape/radius", 1e16, "/objects/0/shape/radius", "1e15"},
      {"/objects/1/shape/edges/1", 0, "/objects/1/shape/edges/1", "expected"},
      {"/objects/1/shape/edges/0", -1, "/objects/1/shape/edges/0", "expected"},
      {"/objects/1/shape",
       {{"type", "box"}, {"edges", {1, 1e-101, 1}}},
       "/objects/1/shape/edges/1",
       "1e-100"},
      {"/objects/1/shape/edges", {1, 2, 3}, "/objects/1/shape/edges", "2 numbers"},
      {"/camera/resolution/0", 0, "/camera/resolution/0", "expected"},
      {"/camera/resolution/1", -5, "/camera/resolution/1", "expected"},
      {"/camera/resolution/1", 1.5, "/camera/resolution", "whole"},
      {"/camera/resolution", {1000000, 1000000}, "/camera/resolution", "more than"},
      {"/camera/resolution/0", 1e300, "/camera/resolution/0", "expected"},
      {"/camera/fov_deg/0", 0, "/camera/fov_deg/0", "expected"},
      {"/camera/fov_deg/0", 361, "/camera/fov_deg/0", "360"},
      {"/camera/fov_deg/1", 181, "/camera/fov_deg/1", "180"},
      {"/camera/fov_deg", 90, "/camera/fov_deg", "2 numbers"},
      {"/camera/elevation_deg", 91, "/camera/elevation_deg", "90"},
      {"/metric/a", 0, "/metric/a", "expected"},
      {"/metric/a", -1, "/metric/a", "expected"},
      {"/metric/name", "goedell", "/metric/name", "expected one of"},
      {"/max_lookback", 0, "/max_lookback", "expected"},
      {"/max_lookback", -1, "/max_lookback", "expected"},
      {"/observer/event/3", 1e16, "/observer/event/3", "expected"},
      {"/observer/worldline", {{"type", "geodesic"}}, "/observer/event", "beside worldline"},
      {"/observer/proper_time", 3, "/observer/proper_time", "expected worldline"},
      {"/objects", json::array(), "/objects", "empty"},
  };
  for (const auto& [pointer, value, place, part] : cases)
    expect_refused(with(pointer, value), std::string("file: ") + place + ": ", part);
}

TEST(Scene, NothingIsAsFastAsLight) {
  for (const json& v : {json{1, 0, 0}, json{0.8, 0.6, 0.0}, json{0.9, 0.9, 0.9}, json{0, 0, -1}}) {
    expect_refused(with("/observer/velocity", v), "file: /observer/velocity: ", "slower than light");
    const char* earth = "/objects/0/placing/worldline/velocity";
    expect_refused(with(earth, v), std::string("file: ") + earth + ": ", "slower than light");
  }
  expect_refused(with("/observer/velocity", {1.5, 0, 0}), "file: /observer/velocity/0: ");
  // The largest double below 1 is a speed like any other: read, and traced or refused cleanly.
  complaint(with("/observer/velocity", {0, std::nextafter(1.0, 0.0), 0}));
  complaint(with("/objects/0/placing/worldline/velocity", {std::nextafter(1.0, 0.0), 0, 0}));
}

TEST(Scene, AxesMustSpanAPlane) {
  const char *z = "/objects/1/placing/z_axis", *y = "/objects/1/placing/y_axis";
  expect_refused(with(z, {0, 0, 0}), std::string("file: ") + z, "zero");
  expect_refused(with(z, {0, 0, 2}), std::string("file: ") + y, "parallel");
  expect_refused(with(z, {0, 0, -1e-3}), std::string("file: ") + y, "parallel");
}

TEST(Scene, NamesAreCheckedAndTakenOnce) {
  for (const char* name :
       {"", "1st", "_x", "a b", "a.b", "a/b", "\xc3\xa4rth", "a\n", "a23456789012345678901234567890123"})
    expect_refused(with("/objects/2/name", name), "file: /objects/2/name: ", "expected a letter");
  expect_refused(with("/objects/2/name", "earth"), "file: /objects/2/name: ", "names two of them");
  EXPECT_EQ(complaint(with("/objects/2/name", "a2345678901234567890123456789-_Z")), "");
}

TEST(Scene, UnknownAndMissingKeysAreRefused) {
  const char* owners[] = {"",
                          "/metric",
                          "/observer",
                          "/camera",
                          "/objects/0",
                          "/objects/0/shape",
                          "/objects/1/shape",
                          "/objects/0/placing",
                          "/objects/0/placing/worldline"};
  for (const std::string owner : owners) {
    const json changed = with((owner + "/colour").c_str(), 1);
    expect_refused(changed, "file: " + owner + "/colour: ", "unknown key");
  }
  for (const char* key :
       {"/metric", "/metric/name", "/observer", "/observer/event", "/camera", "/camera/type",
        "/camera/resolution", "/camera/fov_deg", "/objects", "/objects/0/name", "/objects/0/shape",
        "/objects/0/shape/type", "/objects/0/shape/radius", "/objects/1/shape/edges", "/objects/0/placing",
        "/objects/0/placing/type", "/objects/0/placing/worldline", "/objects/0/placing/worldline/event"}) {
    json changed = demo();
    const Pointer pointer(key);
    changed[pointer.parent_pointer()].erase(pointer.back());
    expect_refused(changed, std::string("file: ") + key + ": missing");
  }
}

TEST(Scene, GoedelHasNoSkyAndASkyNoPlacing) {
  const json sky = {{"name", "stars"}, {"shape", {{"type", "sky"}}}};
  json flat = small_scene("minkowski", {sky}), curved = small_scene("goedel", {sky});
  expect_refused(curved, "file: /objects/0/shape/type: ", "no infinity");
  flat.erase("max_lookback");
  EXPECT_EQ(complaint(flat), "");
  flat["objects"][0]["placing"] = {{"type", "coordinate"}, {"centre", {0, 0, 0}}};
  expect_refused(flat, "file: /objects/0/placing: ", "unknown key");
  flat["objects"] = {sky, sky};
  flat["objects"][1]["name"] = "more_stars";
  expect_refused(flat, "file: /objects/1", "sky");
}

TEST(Scene, AThousandObjectsAndNotOneMore) {
  std::vector<json> objects;
  for (int i = 0; i < 1000; ++i)
    objects.push_back(object_at(("s" + std::to_string(i)).c_str(), {{"type", "sphere"}, {"radius", 0.001}},
                                {0, 1.0 + 0.001 * i, 0, 0}));
  json scene = small_scene("minkowski", objects);
  EXPECT_EQ(complaint(scene), "");
  scene["objects"].push_back(object_at("last", {{"type", "sphere"}, {"radius", 0.001}}, {0, 0, 1, 0}));
  expect_refused(scene, "file: /objects: ", "at most 1000");
}

TEST(Scene, TheFingerprintForgetsTheLookAndNothingElse) {
  const auto metrics = metric_descriptions();
  const auto read = [&](const json& scene) { return read_scene(scene.dump(), "file", metrics); };
  const std::string plain = read(demo()).sha256;
  EXPECT_EQ(read(with("/look", {{"exposure", 2}})).sha256, plain);
  EXPECT_NE(read(with("/look", {{"exposure", 2}})).canonical, read(demo()).canonical);
  EXPECT_NE(read(with("/objects/0/shape/radius", 0.14)).sha256, plain);
  std::stringstream as_written;
  as_written << std::ifstream(NULLCONE_SOURCE "/scenes/goedel_earth.json").rdbuf();
  const Scene written = read_scene(as_written.str(), "file", metrics);
  EXPECT_EQ(read_scene(written.canonical, "file", metrics).sha256, written.sha256);
}

TEST(Scene, WhoStandsWhereIsChecked) {
  for (const char* metric : {"minkowski", "goedel"}) {
    const std::vector<double> here = {0, 0.25, -0.25, 0.125}, near = {0, 0.35, -0.25, 0.125},
                              far = {0, 2, 1, 0};
    const json ball = {{"type", "sphere"}, {"radius", 0.3}},
               dome = {{"type", "sphere"}, {"radius", 0.3}, {"dome", true}};
    const char* first = "file: /objects/0: 'o' ";
    expect_refused(small_scene(metric, {object_at("o", ball, here)}), first, "holds the observer");
    expect_refused(small_scene(metric, {object_at("o", ball, near)}), first, "holds the observer");
    expect_refused(small_scene(metric, {object_at("o", dome, far)}), first, "stands outside");
    EXPECT_EQ(complaint(small_scene(metric, {object_at("o", ball, far)})), "");
    EXPECT_EQ(complaint(small_scene(metric, {object_at("o", dome, here)})), "");
  }
}

/// Every pixel of a dataset that a scene gave is accounted for.
void expect_whole(const std::string& text, const std::string& what) {
  const Dataset dataset = trace(text);
  EXPECT_TRUE(verify(dataset).empty()) << what << ": " << verify(dataset).front();
  for (const float shift : dataset.hits.shift) ASSERT_TRUE(shift >= 0) << what;
  for (const float mu : dataset.hits.mu) ASSERT_TRUE(mu >= 0 && mu <= 1) << what;
  for (std::size_t i = 0; i < dataset.pixels(); ++i) {
    const bool hit = dataset.hits.offset[i + 1] > dataset.hits.offset[i];
    const auto status = static_cast<Status>(dataset.rays.status[i]);
    ASSERT_TRUE(!hit || status == Status::hit || status == Status::step_limit || status == Status::sky)
        << what;
    ASSERT_TRUE(hit || status != Status::hit) << what;
  }
}

/// Reads and traces; a clean refusal or a whole dataset, in time. Returns whether it was refused.
bool survives(const std::string& text, const std::string& what) {
  const auto start = std::chrono::steady_clock::now();
  const std::string found = complaint(text);
  if (found.empty()) expect_whole(text, what);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  // 110 rays, three objects, 2000 steps of 1 us at most, twice: 2 s; the rest is for a busy machine under
  // sanitizers.
  EXPECT_LT(taken.count(), 60) << what;
  EXPECT_EQ(found.compare(0, found.empty() ? 0 : 6, found.empty() ? "" : "file: "), 0)
      << what << ": " << found;
  return !found.empty();
}

TEST(Scene, ExtremeSizesAndPlacesAreSurvived) {
  for (const char* metric : {"minkowski", "goedel"})
    for (const double size : {1e-300, 1e-12, 1e-6, 1.0, 1e6, 1e15})
      for (const std::vector<double>& event : {std::vector<double>{0.5, 0.25, -0.25, 0.125},
                                               {0, 1, 0, 0},
                                               {1e15, 0, 0, 0},
                                               {-1e15, 1e15, -1e15, 1e15},
                                               {0, 1e-300, 0, 0}}) {
        const std::string what = std::string(metric) + ", size " + std::to_string(size) + ", event t " +
                                 std::to_string(event[0]) + ", x " + std::to_string(event[1]);
        for (const json& shape :
             {json{{"type", "sphere"}, {"radius", size}}, json{{"type", "quad"}, {"edges", {size, 1e-300}}},
              json{{"type", "box"}, {"edges", {size, 1e-300, size}}},
              json{{"type", "sphere"}, {"radius", size}, {"dome", true}}}) {
          json scene = small_scene(metric, {object_at("o", shape, event)});
          survives(scene.dump(), what + " " + shape.dump());
          scene["objects"][0]["placing"]["worldline"] = {
              {"type", "geodesic"}, {"event", event}, {"velocity", {0.3, -0.5, 0.1}}};
          survives(scene.dump(), what + " moving " + shape.dump());
          scene["objects"][0]["placing"] = {{"type", "coordinate"},
                                            {"centre", {event[1], event[2], event[3]}}};
          survives(scene.dump(), what + " in the chart " + shape.dump());
        }
      }
}

TEST(Scene, EveryNumberMayBecomeAnything) {
  const json scene = demo(), flat = scene.flatten();
  const std::string mark = "MARK";
  int refused = 0, changed = 0;
  for (const auto& [pointer, value] : flat.items()) {
    if (!value.is_number()) continue;
    for (const char* text : {"null", "\"x\"", "1e999", "-1e308", "1e308", "0", "-1", "1e-300", "NaN", "[]",
                             "{}", "true", "9007199254740993", "-9223372036854775809"}) {
      json marked = scene;
      marked[Pointer(pointer)] = mark;
      std::string source = marked.dump();
      source.replace(source.find("\"" + mark + "\""), mark.size() + 2, text);
      ++changed;
      refused += survives(source, pointer + " = " + text);
    }
  }
  EXPECT_GT(changed, 400);
  EXPECT_GT(refused, changed / 2);  // eight of the fourteen are never numbers that a scene may hold
}

TEST(Scene, WrongTypesAreRefusedEverywhere) {
  const json flat = demo().flatten();
  for (const auto& [pointer, value] : flat.items()) {
    if (!value.is_number()) continue;
    for (const json& wrong : {json(nullptr), json("x"), json(true), json::array(), json::object()})
      expect_refused(with(pointer.c_str(), wrong), "file: " + pointer + ": expected a number");
  }
}

}  // namespace
}  // namespace nullcone
