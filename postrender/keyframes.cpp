#include "postrender/keyframes.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/json.h"

namespace nullcone::postrender {

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

Keyframes parse_keyframes(const json& value, const std::string& place, const std::string& pointer) {
  JsonObject in(value, place, pointer);
  Keyframes out;
  const std::string by = in.word("by", {"frame", "t", "tau"}, "frame");
  out.clock = by == "frame" ? Keyframes::Clock::frame
              : by == "t"   ? Keyframes::Clock::t
                            : Keyframes::Clock::tau;
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

json at_frame(json document, double frame, const std::string& place, const std::string& pointer) {
  if (is_keyframes(document)) {
    const Keyframes keys = parse_keyframes(document, place, pointer);
    return keys.clock == Keyframes::Clock::frame ? json(keys.at(frame)) : document;
  }
  if (document.is_object())
    for (auto& [key, value] : document.items())
      value = at_frame(std::move(value), frame, place, pointer + "/" + escape_pointer(key));
  if (document.is_array())
    for (std::size_t i = 0; i < document.size(); ++i)
      document[i] = at_frame(std::move(document[i]), frame, place, pointer + "/" + std::to_string(i));
  return document;
}

}  // namespace nullcone::postrender
