#include "postrender/needed_channels.h"

#include <string_view>

#include "core/base/error.h"

namespace nullcone::postrender {

namespace {

/// A channel that a look cannot do without, the entry that asks for it, and what else the user may do.
struct Need {
  std::string_view channel;
  std::string entry, remedy;
};

struct Needs {
  std::vector<Need> required;
  ChannelSet useful;
};

bool has_footprint(const TextureLook& texture) {
  if (const auto* image = std::get_if<ImageLook>(&texture)) return image->mipmap;
  return std::holds_alternative<CheckerboardTexture>(texture);
}

/// What one appearance asks for; `pointer` is its entry in the look.
void add_needs(const AppearanceLook& appearance, const std::string& pointer, const Effects& effects,
               const Manifest& manifest, Needs& out) {
  const TextureLook texture = appearance.texture.value_or(ColorTexture{});
  if (!std::holds_alternative<ColorTexture>(texture))
    out.required.push_back({"uv", pointer + "/texture", "use a texture of type color"});
  if (has_footprint(texture))
    out.useful = out.useful | ChannelSet::of(manifest.channels.has("duv") ? "duv" : "order");
  using Kind = SpectrumLook::Kind;
  const Kind kind = appearance.spectrum ? appearance.spectrum->kind : Kind::display;
  const bool spectral = kind != Kind::display && kind != Kind::total_radiance;
  if (spectral) out.useful = out.useful | ChannelSet::of("shift");
  if (spectral && effects.doppler) {
    out.required.push_back({"shift", "/effects/doppler", "switch the effect off"});
  } else if (effects.searchlight) {
    out.required.push_back({"shift", "/effects/searchlight", "switch the effect off"});
  }
}

Needs needs_of(const Look& look, const Manifest& manifest) {
  Needs out;
  for (const ObjectEntry& entry : manifest.objects) {
    const auto found = look.objects.find(entry.name);
    const ObjectLook object = found == look.objects.end() ? ObjectLook{} : found->second;
    if (object.opacity == 0) continue;
    const std::string pointer = "/objects/" + entry.name;
    add_needs(object.appearance, pointer, look.effects, manifest, out);
    for (std::size_t i = 0; i < object.time_slices.size(); ++i) {
      const TimeSliceLook& slice = object.time_slices[i];
      const std::string place = pointer + "/time_slices/" + std::to_string(i);
      out.required.push_back({slice.own_clock ? "tau" : "t", place, "leave the time slice out"});
      add_needs(inherited(slice.appearance, object.appearance), slice.appearance.texture ? place : pointer,
                look.effects, manifest, out);
    }
  }
  return out;
}

}  // namespace

ChannelSet needed_channels(const Look& look, const Manifest& manifest) {
  const Needs needs = needs_of(look, manifest);
  ChannelSet out = ChannelSet::of("A") | ChannelSet::of("id") | needs.useful;
  if (manifest.samples > 1) out = out | ChannelSet::of("sample");
  for (const Need& need : needs.required) out = out | ChannelSet::of(need.channel);
  return out;
}

void check_channels(const Look& look, const Manifest& manifest, ChannelSet there, const std::string& place) {
  for (const Need& need : needs_of(look, manifest).required)
    if (!there.has(need.channel))
      throw InputError(place, "has no channel '" + std::string(need.channel) +
                                  "', which the look needs for " + need.entry +
                                  "; trace with records.channels that include it, or " + need.remedy);
}

}  // namespace nullcone::postrender
