#include "postrender/needed_channels.h"

#include <algorithm>
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

struct HasFootprint {
  bool operator()(const ColorTexture&) const { return false; }
  bool operator()(const CheckerboardTexture&) const { return true; }
  bool operator()(const ImageLook& image) const { return image.filter != Filter::bilinear; }
  bool operator()(const CubeLook& cube) const { return cube.filter != Filter::bilinear; }
  bool operator()(const MovingLook& moving) const { return std::visit(*this, moving.frames.front()); }
};

struct HasColorAlone {
  template <class T>
  bool operator()(const T&) const {
    return std::is_same_v<T, ColorTexture>;
  }
  bool operator()(const MovingLook& moving) const { return std::visit(*this, moving.frames.front()); }
};

/// Channels t and tau of the entry at `pointer`.
void add_clocks(const Clocks& clocks, const std::string& pointer, const std::string& remedy, Needs& out) {
  if (clocks.t) out.required.push_back({"t", pointer, remedy});
  if (clocks.tau) out.required.push_back({"tau", pointer, remedy});
}

Clocks clocks_of(const TextureLook& texture) {
  Clocks out;
  const auto* moving = std::get_if<MovingLook>(&texture);
  if (moving == nullptr) return out;
  if (moving->placement) out.add(moving->placement->clocks());
  if (moving->frames.size() > 1) out.add(moving->timeline.clock);
  return out;
}

Clocks clocks_of(const SpectrumInTime& spectrum) {
  Clocks out;
  if (spectrum.temperature_K) out.add(*spectrum.temperature_K);
  if (!spectrum.nodes.empty()) out.add(spectrum.timeline.clock);
  return out;
}

/// What one appearance itself says of the time of emission; what is inherited its owner has said.
void add_times(const AppearanceLook& own, const std::string& pointer, Needs& out) {
  constexpr const char* kKeys = "use numbers without keyframes by the time of emission";
  if (own.texture) add_clocks(clocks_of(*own.texture), pointer + "/texture", kKeys, out);
  add_clocks(clocks_of(own.spectrum_in_time), pointer + "/spectrum", kKeys, out);
  Emission emission;
  emission.intensity = own.intensity.value_or(Number{1});
  add_clocks(emission.clocks(), pointer + "/intensity", kKeys, out);
  emission = {};
  emission.blink = own.blink;
  add_clocks(emission.clocks(), pointer + "/blink", "leave it out", out);
}

bool is_spectral(const SpectrumLook& spectrum) {
  return spectrum.kind != SpectrumLook::Kind::display && spectrum.kind != SpectrumLook::Kind::total_radiance;
}
bool is_spectral(const AppearanceLook& appearance) {
  return appearance.spectrum && is_spectral(*appearance.spectrum);
}

/// Whether wavelengths come from any light that falls on surfaces.
bool has_spectral_light(const Look& look) {
  return (look.ambient && is_spectral(look.ambient->spectrum)) ||
         std::ranges::any_of(look.lights, [](const auto& entry) {
           const LampLook& lamp = entry.second;
           return lamp.shines() && (is_spectral(lamp.light) ||
                                    std::ranges::any_of(lamp.time_slices, [](const TimeSliceLook& slice) {
                                      return is_spectral(slice.appearance);
                                    }));
         });
}

/// The light of lamps, if any shine. Lamps that the look does not name do.
bool needs_lamps(const Look& look, const Manifest& manifest) {
  return std::ranges::any_of(manifest.lights, [&](const ObjectEntry& lamp) {
    const auto found = look.lights.find(lamp.name);
    return found == look.lights.end() || found->second.shines();
  });
}

/// What one appearance asks for; `pointer` is its entry in the look.
void add_needs(const AppearanceLook& appearance, const std::string& pointer, const Effects& effects,
               bool spectral, const Manifest& manifest, Needs& out) {
  const TextureLook texture = appearance.texture.value_or(ColorTexture{});
  if (!std::visit(HasColorAlone{}, texture))
    out.required.push_back({"uv", pointer + "/texture", "use a texture of type color"});
  if (std::visit(HasFootprint{}, texture))
    out.useful = out.useful | ChannelSet::of(manifest.channels.has("duv") ? "duv" : "order");
  if (spectral) out.useful = out.useful | ChannelSet::of("shift");
  if (spectral && effects.doppler) {
    out.required.push_back({"shift", "/effects/doppler", "switch the effect off"});
  } else if (effects.searchlight) {
    out.required.push_back({"shift", "/effects/searchlight", "switch the effect off"});
  }
}

void add_stars(const std::string& pointer, const Effects& effects, Needs& out) {
  out.required.push_back({"uv", pointer, "leave the stars out"});
  if (effects.doppler || effects.searchlight)
    out.required.push_back(
        {"shift", effects.doppler ? "/effects/doppler" : "/effects/searchlight", "switch the effect off"});
}

Needs needs_of(const Look& look, const Manifest& manifest) {
  Needs out;
  for (const ObjectEntry& entry : manifest.objects) {
    const auto found = look.objects.find(entry.name);
    const ObjectLook object = found == look.objects.end() ? ObjectLook{} : found->second;
    if (object.opacity.always(0)) continue;
    const std::string pointer = "/objects/" + entry.name;
    Clocks opacity;
    opacity.add(object.opacity);
    add_clocks(opacity, pointer + "/opacity", "use a number without keyframes", out);
    add_times(object.appearance, pointer, out);
    const auto add = [&](const AppearanceLook& whole, const std::string& place) {
      const bool spectral = object.is_lit() ? has_spectral_light(look) : is_spectral(whole);
      add_needs(whole, place, look.effects, spectral, manifest, out);
    };
    if (object.stars) add_stars(pointer + "/stars", look.effects, out);
    if (object.is_lit() && needs_lamps(look, manifest))
      out.required.push_back({"light", pointer + "/surface", "switch all lamps off"});
    add(object.appearance, pointer);
    for (std::size_t i = 0; i < object.time_slices.size(); ++i) {
      const TimeSliceLook& slice = object.time_slices[i];
      const std::string place = pointer + "/time_slices/" + std::to_string(i);
      Clocks clocks;
      clocks.add(slice.when.clock);
      add_clocks(clocks, place, "leave the time slice out", out);
      add_times(slice.appearance, place, out);
      add(inherited(slice.appearance, object.appearance), slice.appearance.texture ? place : pointer);
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
