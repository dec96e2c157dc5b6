#include "postrender/look_light.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "postrender/look_changing.h"

namespace nullcone::postrender {

namespace {

constexpr double kBrightest = 1e12;
constexpr int kMostPaths = 64;

std::set<int> parse_paths(JsonObject& in) {
  std::set<int> out;
  const nlohmann::json& list = in.at("paths");
  if (!list.is_array()) in.refuse("paths", "expected a list of numbers of paths, from 0");
  for (std::size_t i = 0; i < list.size(); ++i) {
    const bool whole = list[i].is_number_integer() && list[i] >= 0 && list[i] < kMostPaths;
    if (!whole) in.refuse("paths/" + std::to_string(i), "expected a whole number from 0 to 63");
    out.insert(list[i].get<int>());
  }
  return out;
}

LampLook parse_lamp(JsonObject in, const LookSource& source) {
  LampLook out;
  out.intensity = parse_number_or(in, "intensity", source, 1, {0, kBrightest});
  if (in.has("blink")) out.blink = parse_blink(in.object("blink"), source);
  if (in.has("spectrum")) {
    out.spectrum = parse_spectrum(in.object("spectrum"), source);
    if (out.spectrum.kind != SpectrumLook::Kind::filtered)
      in.refuse("spectrum/type", "expected a spectrum of light, as black_body");
  }
  if (in.has("paths")) out.paths = parse_paths(in);
  in.finish();
  return out;
}

}  // namespace

std::map<std::string, LampLook> parse_lamps(JsonObject in, const LookSource& source,
                                            const std::vector<ObjectEntry>& lamps) {
  std::map<std::string, LampLook> out;
  for (const std::string& name : in.keys()) {
    if (std::ranges::find(lamps, name, &ObjectEntry::name) == lamps.end())
      in.refuse(name, lamps.empty() ? "the dataset has no lamps" : "the dataset has no such lamp");
    out.emplace(name, parse_lamp(in.object(name), source));
  }
  return out;
}

}  // namespace nullcone::postrender
