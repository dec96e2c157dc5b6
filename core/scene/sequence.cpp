#include "core/scene/sequence.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/keyframes.h"
#include "core/scene/read_placing.h"

namespace nullcone {

using nlohmann::json;

namespace {

constexpr long kMostFrames = 1'000'000;

/// As people write it: whole numbers without a point, so that a frame has the hash of the same scene by hand.
json as_written(double value) {
  constexpr double kExact = 1e15;
  if (value == std::floor(value) && std::abs(value) < kExact) return static_cast<std::int64_t>(value);
  return value;
}

/// The proper time of an observer who moves.
void set_proper_time(json& scene, double time, const std::string& place) {
  if (!scene.contains(json::json_pointer("/observer/worldline"))) return;
  json& entry = scene["observer"]["proper_time"];
  if (!entry.is_null() && entry != 0)
    throw InputError(
        place + ": /observer/proper_time",
        "is the time of the frame (\"frames\" goes by proper time); expected 0 there, or nothing");
  entry = as_written(time);
}

/// The observer's event at the time of the frame.
void set_time(json& scene, double time, const std::string& place) {
  if (scene.contains(json::json_pointer("/observer/worldline")))
    throw InputError(place + ": /frames/time",
                     "expected \"proper\", for the observer moves along a worldline");
  const json::json_pointer event("/observer/event");
  if (!scene.contains(event)) return;  // the reader of scenes says what is missing
  json& entry = scene[event];
  if (!entry.is_array() || entry.empty()) return;
  const bool open = entry[0].is_null() || (entry[0].is_number() && entry[0].get<double>() == 0);
  if (!open)
    throw InputError(place + ": /observer/event/0",
                     "is the time of the frame (\"frames\" goes by coordinate time); expected 0 there");
  entry[0] = as_written(time);
}

}  // namespace

double Frames::time(int frame) const {
  return count == 1 ? from : std::lerp(from, to, static_cast<double>(frame) / (count - 1));
}

bool is_sequence(const json& scene) { return scene.is_object() && scene.contains("frames"); }

Frames read_frames(const json& scene, const std::string& place) {
  JsonObject in = JsonObject(scene, place, "").object("frames");
  Frames out;
  out.count = static_cast<int>(in.integer("count", 1, kMostFrames));
  out.from = in.number("from", -kLargest, kLargest);
  out.to = in.number("to", -kLargest, kLargest);
  out.coordinate = in.word("time", {"coordinate", "proper"}, "coordinate") == "coordinate";
  in.finish();
  return out;
}

json scene_at(json scene, const Frames& frames, int frame, const std::string& place) {
  const double time = frames.time(frame);
  scene.erase("frames");
  if (frames.coordinate)
    set_time(scene, time, place);
  else
    set_proper_time(scene, time, place);
  for (auto& [key, value] : scene.items())
    if (key != "look")
      value = replace_keyframes(
          std::move(value), "/" + escape_pointer(key), [&](const json& keys, const std::string& pointer) {
            return as_written(parse_keyframes(keys, place, pointer, {Keyframes::Clock::time}).at(time));
          });
  return scene;
}

void refuse_sequence(const json& scene, const std::string& place) {
  if (is_sequence(scene))
    throw InputError(place + ": /frames",
                     "this is a sequence; expected the scene of one frame, as nullcone-trace makes it with "
                     "--frames or --frame");
  if (!scene.is_object()) return;
  for (const auto& [key, value] : scene.items())
    if (key != "look")
      replace_keyframes(
          value, "/" + escape_pointer(key), [&](const json&, const std::string& pointer) -> json {
            throw InputError(place + ": " + pointer,
                             "has keyframes; expected a number, or \"frames\" in the scene too");
          });
}

}  // namespace nullcone
