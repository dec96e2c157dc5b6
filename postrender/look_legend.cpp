#include "postrender/look_legend.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "postrender/look_path.h"

namespace nullcone::postrender {

namespace {

bool is_object(const std::string& name, const Manifest& manifest) {
  return std::ranges::any_of(manifest.objects, [&](const auto& object) { return object.name == name; });
}

std::string in_digits(double value, int digits) {
  std::array<char, 400> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value == 0 ? 0.0 : value);
  return text.data();
}

/// A short text that the font can write.
std::string parse_label(JsonObject& in, std::string_view key, const std::string& fallback) {
  const std::string label = in.text(key, fallback);
  if (label.size() > 24 || !std::ranges::all_of(label, [](char c) { return c >= ' ' && c <= '~'; }))
    in.refuse(key, "expected up to 24 letters of ASCII");
  return label;
}

/// "t = 1.25 s".
std::string line_of(const std::string& label, const std::string& number, const std::string& unit) {
  return (label.empty() ? "" : label + " = ") + number + (unit.empty() ? "" : " " + unit);
}

std::string parse_time(JsonObject in, double frame) {
  const std::string label = parse_label(in, "label", "t"), unit = parse_label(in, "unit", "");
  const double start = in.number_or("start", 0, -1e15, 1e15), step = in.number_or("step", 1, -1e9, 1e9);
  const long digits = in.has("digits") ? in.integer("digits", 0, 9) : 2;
  const double now = start + step * frame;
  // A look that is explained stands for this frame alone.
  in.note("digits", digits);
  in.note("start", now);
  in.note("step", 0);
  in.finish();
  return line_of(label, in_digits(now, static_cast<int>(digits)), unit);
}

std::string parse_temperature(JsonObject& in, const nlohmann::json& look, const Manifest& manifest) {
  const std::string path = in.text("temperature");
  const auto keys = is_object(path, manifest)
                        ? std::vector<std::string>{"objects", path, "spectrum", "temperature_K"}
                        : split_path(path, in.where("temperature"));
  const nlohmann::json* value = find_entry(look, keys);
  if (value == nullptr || !value->is_number())
    in.refuse("temperature",
              "'" + path +
                  "' is no number of this look; expected an object with a temperature_K, or the "
                  "path of a number, as /objects/NAME/spectrum/temperature_K");
  return line_of("T", in_digits(value->get<double>(), 0), "K");
}

ScaleLook parse_scale(JsonObject in, const Manifest& manifest) {
  ScaleLook out;
  out.object = in.text("object");
  if (!is_object(out.object, manifest)) in.refuse("object", "the dataset has no such object");
  out.from = in.number_or("from", out.from, 1e-3, 1e3);
  out.to = in.number_or("to", out.to, 1e-3, 1e3);
  if (!(out.to >= 1.01 * out.from)) in.refuse("to", "expected a number above 1.01 times from");
  in.finish();
  return out;
}

}  // namespace

LegendLook parse_legend(JsonObject in, const LookSource& source, const nlohmann::json& look,
                        const Manifest& manifest) {
  LegendLook out;
  const std::string corner =
      in.word("corner", {"bottom_left", "bottom_right", "top_left", "top_right"}, "bottom_left");
  out.left = corner.ends_with("left");
  out.top = corner.starts_with("top");
  if (in.has("size")) out.size = static_cast<int>(in.integer("size", 1, 64));
  if (in.has("time") && in.at("time") != false)
    out.lines.push_back(parse_time(in.object_or_true("time"), source.frame));
  if (in.has("temperature")) out.lines.push_back(parse_temperature(in, look, manifest));
  if (in.has("scale")) out.scale = parse_scale(in.object("scale"), manifest);
  in.finish();
  return out;
}

}  // namespace nullcone::postrender
