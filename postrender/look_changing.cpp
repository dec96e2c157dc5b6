#include "postrender/look_changing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace nullcone::postrender {

using nlohmann::json;

namespace {

constexpr double kLatest = 1e100;  ///< so that differences of times and their slopes stay finite
constexpr std::size_t kMostNodes = 16384, kFewestSteps = 4;

Keyframes parse_emission_keyframes(const json& value, const std::string& place, const std::string& pointer) {
  Keyframes keys = parse_keyframes(value, place, pointer);
  if (keys.clock == Clock::frame)
    throw InputError(place + ": " + pointer + "/by", "expected keyframes by t or tau here");
  for (std::size_t i = 0; i < keys.times.size(); ++i)
    if (std::abs(keys.times[i]) > kLatest)
      throw InputError(place + ": " + pointer + "/keyframes/" + std::to_string(i),
                       "expected a time of at most 1e100");
  return keys;
}

/// One number of the object `in`, which stands under `key` (or deeper).
Number parse_value(const JsonObject& in, const json& value, const std::string& key, const LookSource& source,
                   const Bounds& bounds) {
  if (!is_keyframes(value)) {
    if (!value.is_number()) in.refuse(key, "expected a number, or keyframes by t or tau");
    const double number = value.get<double>();
    if (!(number >= bounds.least && number <= bounds.most) || !std::isfinite(number))
      in.refuse(key,
                "expected a number from " + json(bounds.least).dump() + " to " + json(bounds.most).dump());
    return {number};
  }
  const std::string pointer = pointer_of(in, key, source);
  Number out{0, parse_emission_keyframes(value, source.place, pointer)};
  for (std::size_t i = 0; i < out.keys->values.size(); ++i)
    if (!(out.keys->values[i] >= bounds.least && out.keys->values[i] <= bounds.most))
      in.refuse(key + "/keyframes/" + std::to_string(i),
                "expected values from " + json(bounds.least).dump() + " to " + json(bounds.most).dump());
  return out;
}

/// All keyframes of a document, by where they stand in it.
using Parsed = std::map<const json*, Keyframes>;

/// Those that go by the time of emission; others are refused.
void parse_all(const json& entry, const std::string& place, const std::string& pointer, Parsed& out) {
  if (is_keyframes(entry)) {
    out.emplace(&entry, parse_emission_keyframes(entry, place, pointer));
    return;
  }
  if (entry.is_object())
    for (const auto& [key, value] : entry.items())
      parse_all(value, place, pointer + "/" + escape_pointer(key), out);
  if (entry.is_array())
    for (std::size_t i = 0; i < entry.size(); ++i)
      parse_all(entry[i], place, pointer + "/" + std::to_string(i), out);
}

/// The document as it is at one time.
json at_time(const json& entry, double time, bool whole, const std::vector<std::string>& whole_keys,
             const Parsed& parsed) {
  if (!entry.is_structured()) return entry;
  if (const auto found = parsed.find(&entry); found != parsed.end()) {
    const double value = found->second.at(time);
    return whole ? json(std::round(value)) : json(value);
  }
  json out = entry.is_object() ? json::object() : json::array();
  if (entry.is_object())
    for (const auto& [key, value] : entry.items())
      out[key] = at_time(value, time, whole || std::ranges::find(whole_keys, key) != whole_keys.end(),
                         whole_keys, parsed);
  if (entry.is_array())
    for (const json& value : entry) out.push_back(at_time(value, time, whole, whole_keys, parsed));
  return out;
}

}  // namespace

std::string pointer_of(const JsonObject& in, std::string_view key, const LookSource& source) {
  const std::string where = in.where(key);
  return where.substr(std::min(where.size(), source.place.size() + 2));
}

Number parse_number(JsonObject& in, std::string_view key, const LookSource& source, const Bounds& bounds) {
  return parse_value(in, in.at(key), std::string(key), source, bounds);
}

Number parse_number_or(JsonObject& in, std::string_view key, const LookSource& source, double fallback,
                       const Bounds& bounds) {
  if (in.has(key)) return parse_number(in, key, source, bounds);
  in.note(key, fallback);
  return Number{fallback};
}

std::vector<Number> parse_numbers(JsonObject& in, std::string_view key, const LookSource& source,
                                  std::size_t count, const Bounds& bounds) {
  const json& list = in.at(key);
  if (!list.is_array() || list.size() != count)
    in.refuse(key, "expected a list of " + std::to_string(count) + " numbers");
  std::vector<Number> out;
  for (std::size_t i = 0; i < count; ++i)
    out.push_back(parse_value(in, list[i], std::string(key) + "/" + std::to_string(i), source, bounds));
  return out;
}

Nodes at_nodes(const json& entry, std::size_t steps, const std::vector<std::string>& whole,
               const std::string& place, const std::string& pointer) {
  Nodes out;
  std::vector<double> times;
  Parsed parsed;  // once: there are many nodes
  parse_all(entry, place, pointer, parsed);
  for (const auto& [at, keys] : parsed) {
    if (!times.empty() && keys.clock != out.timeline.clock)
      throw InputError(place + ": " + pointer, "expected all its keyframes by t, or all by tau");
    out.timeline.clock = keys.clock;
    times.insert(times.end(), keys.times.begin(), keys.times.end());
  }
  if (times.empty()) return {{}, {entry}};
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  if (times.size() > kMostNodes / kFewestSteps)
    throw InputError(place + ": " + pointer, "expected keyframes at no more than 4096 times");
  steps = std::clamp(kMostNodes / times.size(), kFewestSteps, std::max(steps, kFewestSteps));
  std::vector<double>& nodes = out.timeline.nodes;
  for (std::size_t i = 0; i + 1 < times.size(); ++i)
    for (std::size_t k = 0; k < steps; ++k)
      nodes.push_back(std::lerp(times[i], times[i + 1], static_cast<double>(k) / static_cast<double>(steps)));
  nodes.push_back(times.back());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  for (const double time : nodes) out.values.push_back(at_time(entry, time, false, whole, parsed));
  out.timeline.count = nodes.size();
  return out;
}

}  // namespace nullcone::postrender
