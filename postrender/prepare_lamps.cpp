// The first step of a picture, as far as light falls on surfaces: from what a look says of lamps to tables.
#include <algorithm>

#include "postrender/renderer.h"
#include "postrender/shading_in_time.h"

namespace nullcone::postrender {

namespace {

bool is_lit(const Look& look, const ObjectEntry& entry) {
  const auto found = look.objects.find(entry.name);
  return found != look.objects.end() && found->second.is_lit();
}

/// All ratios of either.
void join(ShiftRange& range, ShiftRange more) {
  range = {std::min(range.from, more.from), std::max(range.to, more.to)};
}

}  // namespace

/// A lamp without time slices has one state, or one for each node of its spectrum.
void Renderer::add_lamp_state(Shading& shading, std::vector<LampLight>& out, const AppearanceLook& own,
                              std::size_t lamp, const Effects& effects) const {
  const Emission emission = emission_of(own, effects);
  const auto add = [&](const SpectrumLook& spectrum) {
    shading.lamp_states.push_back(emission);
    out.push_back({{spectrum, emission.temperature}, lamp});
  };
  if (own.spectrum_in_time.nodes.empty()) {
    add(own.spectrum.value_or(SpectrumLook{}));
  } else {
    std::ranges::for_each(own.spectrum_in_time.nodes, add);
  }
}

/// All that shine; none where nothing is lit: then their channels need not be there.
std::vector<Renderer::LampLight> Renderer::add_lamps(Shading& shading, const Look& look) const {
  std::vector<LampLight> out;
  const auto lit = [&](const ObjectEntry& entry) { return is_lit(look, entry); };
  if (std::ranges::none_of(manifest_.objects, lit)) return out;
  for (std::size_t number = 0; number < manifest_.lights.size(); ++number) {
    const ObjectEntry& entry = manifest_.lights[number];
    const auto found = look.lights.find(entry.name);
    const LampLook lamp = found == look.lights.end() ? LampLook{} : found->second;
    if (!lamp.shines()) continue;
    const auto add = [&](const AppearanceLook& own) {
      const std::size_t first = shading.lamp_states.size();
      add_lamp_state(shading, out, own, number, look.effects);
      return first;
    };
    LampShading& shines = shading.lamps.emplace_back();
    for (int path = 0; path < manifest_.light_paths; ++path)
      if (lamp.shines_along(path))
        shines.paths.push_back(number * static_cast<std::size_t>(manifest_.light_paths) +
                               static_cast<std::size_t>(path));
    shines.when = shading_in_time(entry.tau_origin, lamp.light, lamp.time_slices, add);
  }
  return out;
}

/// What a surface of this spectrum (its reflectance) shows of all light that falls on it.
void Renderer::light_up(Appearance& out, const SpectrumLook& spectrum, std::span<const LampLight> lamps,
                        std::uint32_t id, const Look& look) {
  const SpectrumLook* reflectance = spectrum.kind == SpectrumLook::Kind::filtered ? &spectrum : nullptr;
  out.light = {};
  out.own_light = 0;
  if (look.ambient) {
    const SpectrumLook& ambient = look.ambient->spectrum;
    out.own_light = static_cast<float>(look.ambient->intensity);
    out.light = light_of(reflectance == nullptr ? ambient : reflected(ambient, *reflectance), {}, id, look);
  }
  out.reflections.clear();
  for (const LampLight& lamp : lamps)
    out.reflections.push_back(reflections_.get(lights_, lamp.light, reflectance, look.effects, *look.sensor,
                                               shifts_[id - 1], light_shifts_[id - 1][lamp.lamp]));
}

/// What users should know of light.
void Renderer::note_light(Shading& shading, const Look& look, std::span<const LampLight> lamps) const {
  const auto note = [&](const std::string& place, const SpectrumLook& spectrum, ShiftRange range) {
    const std::string unknown = unknown_wavelengths(spectrum, look.effects, *look.sensor, range);
    const std::string text = place + "/spectrum: " + unknown;
    const bool told = std::ranges::find(shading.notes, text) != shading.notes.end();
    if (!unknown.empty() && !told) shading.notes.push_back(text);
  };
  std::vector<std::size_t> lit;
  for (std::size_t i = 0; i < manifest_.objects.size(); ++i)
    if (is_lit(look, manifest_.objects[i])) lit.push_back(i);
  if (lit.empty()) return;
  if (manifest_.lights.empty() && !look.ambient)
    for (const std::size_t i : lit)
      shading.notes.push_back("/objects/" + manifest_.objects[i].name +
                              "/surface: nothing lights it: the dataset has no lamps, and the look no "
                              "ambient light");
  for (const LampLight& lamp : lamps) {
    ShiftRange range = light_shifts_[lit.front()][lamp.lamp].product;
    for (const std::size_t i : lit) join(range, light_shifts_[i][lamp.lamp].product);
    note("/lights/" + manifest_.lights[lamp.lamp].name, lamp.light.spectrum, range);
  }
  if (!look.ambient) return;
  ShiftRange range = shifts_[lit.front()];
  for (const std::size_t i : lit) join(range, shifts_[i]);
  note("/ambient", look.ambient->spectrum, range);
}

}  // namespace nullcone::postrender
