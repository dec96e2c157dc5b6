#include "postrender/look_light.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace nullcone::postrender {

namespace {

std::set<int> parse_paths(JsonObject& in, int recorded) {
  std::set<int> out;
  const nlohmann::json& list = in.at("paths");
  if (!list.is_array()) in.refuse("paths", "expected a list of numbers of paths, from 0");
  for (std::size_t i = 0; i < list.size(); ++i) {
    const bool there = list[i].is_number() && list[i] >= 0 && list[i] < recorded &&
                       list[i] == std::floor(list[i].get<double>());
    if (!there)
      in.refuse("paths/" + std::to_string(i),
                "expected a whole number from 0 to " + std::to_string(recorded - 1) + ": the dataset has " +
                    std::to_string(recorded) + (recorded == 1 ? " path" : " paths") + " a lamp");
    out.insert(list[i].get<int>());
  }
  return out;
}

/// Light has one spectrum, or none.
void check_spectrum(const AppearanceLook& light, const JsonObject& in, const std::string& key) {
  using Kind = SpectrumLook::Kind;
  if (light.spectrum && light.spectrum->kind != Kind::filtered && light.spectrum->kind != Kind::display)
    in.refuse(key + "/type", "expected a spectrum of light, as black_body, or display");
}

LampLook parse_lamp(JsonObject in, const LookSource& source, int recorded_paths) {
  LampLook out;
  out.on = in.boolean("on", true);
  out.light = parse_light(in, source);
  if (!out.light.intensity) in.note("intensity", 1);
  if (!out.light.spectrum) in.note("spectrum", {{"type", "display"}});
  check_spectrum(out.light, in, "spectrum");
  out.time_slices = parse_time_slices(in, [&](JsonObject& slice) { return parse_light(slice, source); });
  for (std::size_t i = 0; i < out.time_slices.size(); ++i)
    check_spectrum(out.time_slices[i].appearance, in, "time_slices/" + std::to_string(i) + "/spectrum");
  if (in.has("paths")) out.paths = parse_paths(in, recorded_paths);
  in.finish();
  return out;
}

}  // namespace

std::map<std::string, LampLook> parse_lamps(JsonObject in, const LookSource& source,
                                            const Manifest& manifest) {
  std::string names;
  for (const ObjectEntry& lamp : manifest.lights) names += (names.empty() ? "" : ", ") + lamp.name;
  for (const std::string& name : in.keys())
    if (std::ranges::find(manifest.lights, name, &ObjectEntry::name) == manifest.lights.end())
      in.refuse(name, names.empty() ? "the dataset has no lamps"
                                    : "the dataset has no such lamp; expected one of " + names);
  std::map<std::string, LampLook> out;
  for (const ObjectEntry& lamp : manifest.lights)
    out.emplace(lamp.name, parse_lamp(in.object_or_empty(lamp.name), source, manifest.light_paths));
  return out;
}

AmbientLook parse_ambient(JsonObject in, const LookSource& source) {
  AmbientLook out;
  out.intensity = in.number_or("intensity", 1, 0, kMostIntense);
  if (in.has("spectrum")) {
    out.spectrum = parse_spectrum(in.object("spectrum"), source);
    check_spectrum({{}, out.spectrum, {}, {}, {}}, in, "spectrum");
  } else {
    in.note("spectrum", {{"type", "display"}});
  }
  in.finish();
  return out;
}

}  // namespace nullcone::postrender
