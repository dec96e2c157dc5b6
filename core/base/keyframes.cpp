#include "core/base/keyframes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/error.h"
#include "core/base/json.h"

namespace nullcone {

using nlohmann::json;

std::vector<double> monotone_slopes(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  std::vector<double> out(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = (y[i] - y[i - 1]) / (x[i] - x[i - 1]),
                 after = (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
    if (before * after > 0) {
      const double w = (x[i + 1] - x[i - 1] + x[i + 1] - x[i]) / (3 * (x[i + 1] - x[i - 1]));
      out[i] = before * after / (w * before + (1 - w) * after);
    }
  }
  return out;
}

double Keyframes::at(double time) const {
  if (!(time > times.front())) return values.front();
  if (time >= times.back()) return values.back();
  const auto next = static_cast<std::size_t>(std::ranges::upper_bound(times, time) - times.begin());
  const std::size_t i = next - 1;
  const double width = times[next] - times[i], s = (time - times[i]) / width;
  if (slopes.empty()) return std::lerp(values[i], values[next], s);
  const double from = 1 - s;
  return from * from * ((1 + 2 * s) * values[i] + s * width * slopes[i]) +
         s * s * ((1 + 2 * from) * values[next] - from * width * slopes[next]);
}

bool is_keyframes(const json& value) { return value.is_object() && value.contains("keyframes"); }

namespace {

/// In the order of Keyframes::Clock.
constexpr std::array<const char*, 4> kClockNames = {"frame", "t", "tau", "time"};

Keyframes::Clock read_clock(JsonObject& in, const std::vector<Keyframes::Clock>& clocks) {
  std::vector<std::string> words;
  words.reserve(clocks.size());
  for (const Keyframes::Clock clock : clocks)
    words.emplace_back(kClockNames[static_cast<std::size_t>(clock)]);
  const std::string by = in.word("by", words, words.front());
  return clocks[static_cast<std::size_t>(std::ranges::find(words, by) - words.begin())];
}

}  // namespace

Keyframes parse_keyframes(const json& value, const std::string& place, const std::string& pointer,
                          const std::vector<Keyframes::Clock>& clocks) {
  JsonObject in(value, place, pointer);
  Keyframes out;
  out.clock = read_clock(in, clocks);
  const bool smooth = in.word("interpolation", {"linear", "smooth"}, "linear") == "smooth";
  const json& keys = in.at("keyframes");
  if (!keys.is_array() || keys.empty()) in.refuse("keyframes", "expected a list [[time, value], ...]");
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const json& key = keys[i];
    const std::string where = "keyframes/" + std::to_string(i);
    if (!key.is_array() || key.size() != 2 || !key[0].is_number() || !key[1].is_number())
      in.refuse(where, "expected [time, value]");
    out.times.push_back(key[0].get<double>());
    out.values.push_back(key[1].get<double>());
    if (!std::isfinite(out.times.back()) || !std::isfinite(out.values.back()))
      in.refuse(where, "expected finite numbers");
    if (i > 0 && !(out.times[i] > out.times[i - 1])) in.refuse(where, "expected a later time than before");
  }
  in.finish();
  if (smooth) out.slopes = monotone_slopes(out.times, out.values);
  return out;
}

json replace_keyframes(json document, const std::string& pointer,
                       const std::function<json(const json&, const std::string& pointer)>& by) {
  if (is_keyframes(document)) return by(document, pointer);
  if (document.is_object())
    for (auto& [key, value] : document.items())
      value = replace_keyframes(std::move(value), pointer + "/" + escape_pointer(key), by);
  if (document.is_array())
    for (std::size_t i = 0; i < document.size(); ++i)
      document[i] = replace_keyframes(std::move(document[i]), pointer + "/" + std::to_string(i), by);
  return document;
}

json at_frame(json document, double frame, const std::string& place, const std::string& pointer) {
  return replace_keyframes(std::move(document), pointer, [&](const json& value, const std::string& where) {
    const Keyframes keys = parse_keyframes(value, place, where);
    return keys.clock == Keyframes::Clock::frame ? json(keys.at(frame)) : value;
  });
}

}  // namespace nullcone
