// The first step of a picture: from a look to a shading.
#include <algorithm>
#include <limits>

#include "core/base/error.h"
#include "postrender/color.h"
#include "postrender/needed_channels.h"
#include "postrender/renderer.h"
#include "postrender/shading_in_time.h"
#include "postrender/texture_maker.h"

namespace nullcone::postrender {

Emission emission_of(const AppearanceLook& look, const Effects& effects) {
  Emission out;
  out.intensity = look.intensity.value_or(Number{1});
  out.blink = look.blink;
  if (look.spectrum_in_time.temperature_K)
    out.temperature = {*look.spectrum_in_time.temperature_K, look.spectrum_in_time.reference_K, effects};
  return out;
}

/// The light of one spectrum as a look has it; where its temperature changes, that of the reference.
Light Renderer::light_of(const SpectrumLook& spectrum, const Emission& emission, std::uint32_t id,
                         const Look& look) {
  const ShiftRange shifts = shifts_[id - 1];
  if (emission.temperature)
    return lights_.get(spectrum, Effects{}, *look.sensor, reference_range(*emission.temperature, shifts));
  return lights_.get(spectrum, look.effects, *look.sensor, shifts);
}

/// A texture of materials shows three at a time.
void Renderer::add_materials(Appearance& out, TextureMaker& textures, const TextureLook& texture,
                             const SpectrumLook& materials, std::uint32_t id, const Look& look) {
  const std::size_t count = materials.spectra.size();
  for (std::size_t first = 0; first < count; first += 3) {
    const MaterialGroup group{static_cast<int>(first), static_cast<int>(count)};
    Appearance::Component one{textures.make(of_materials(texture, group)),
                              light_of(three_materials(materials, first), out.emission, id, look)};
    if (first > 0) {
      out.more.push_back(std::move(one));
    } else {
      out.texture = std::move(one.texture);
      out.light = std::move(one.light);
    }
  }
}

std::size_t Renderer::add_appearance(Shading& shading, TextureMaker& textures, const AppearanceLook& own,
                                     const ObjectLook& object, std::span<const LampLight> lamps,
                                     std::uint32_t id, const Look& look) {
  const std::string& name = manifest_.objects[id - 1].name;
  const SpectrumLook spectrum = own.spectrum.value_or(SpectrumLook{});
  // What radiates by itself, or is lit, needs no colour; what is shown as it is gets its flat one.
  // Behind stars it is dark.
  const Rgb plain = object.stars                           ? Rgb{}
                    : spectrum.physical || object.is_lit() ? Rgb{1, 1, 1}
                                                           : default_color(id);
  const TextureLook texture = own.texture.value_or(ColorTexture{plain});
  const bool materials = is_of_materials(texture);
  Appearance out{materials ? ColorTexture{} : textures.make(texture), {}};
  const Number& opacity = object.opacity;
  out.opacity = opacity.keys ? 1.0f : static_cast<float>(opacity.constant);
  out.emission = emission_of(own, look.effects);
  if (opacity.keys) out.emission.opacity = opacity;
  out.changes = out.emission != Emission{};
  const std::size_t first = shading.appearances.size();
  const auto add = [&](const SpectrumLook& one) {
    const std::string unknown = unknown_wavelengths(one, look.effects, *look.sensor, shifts_[id - 1]);
    if (!unknown.empty()) shading.notes.push_back("/objects/" + name + "/spectrum: " + unknown);
    if (object.is_lit()) {
      light_up(out, one, lamps, id, look);
    } else if (materials) {
      out.more.clear();
      add_materials(out, textures, texture, one, id, look);
    } else {
      out.light = light_of(one, out.emission, id, look);
    }
    shading.appearances.push_back(out);
  };
  if (own.spectrum_in_time.nodes.empty()) {
    add(spectrum);
  } else {
    std::ranges::for_each(own.spectrum_in_time.nodes, add);
  }
  return first;
}

/// Points have the sky's opacity and intensity, and no time of emission.
void Renderer::add_stars_of(Shading& shading, const ObjectLook& object, std::uint32_t id, const Look& look) {
  if (!object.stars || object.opacity.always(0)) return;
  constexpr double kLongAgo = -std::numeric_limits<double>::infinity();
  StarShading out{id, stars_->field(*object.stars), {}, look.effects.doppler, look.effects.power(),
                  1,  object.stars->style};
  if (look.effects.doppler) out.power -= 5;  // L(g lambda; T) = g^-5 B(lambda; g T)
  out.intensity = out.style.intensity;
  if (object.appearance.intensity) out.intensity *= object.appearance.intensity->at({kLongAgo, kLongAgo});
  const ShiftRange shifts = look.effects.doppler ? shifts_[id - 1] : ShiftRange{};
  const auto [coldest, hottest] = out.field->temperatures();
  constexpr auto kReference = static_cast<float>(kReferenceStar_K);
  const SpectrumLook body{SpectrumLook::Kind::filtered, true, {black_body(kReferenceStar_K)}, "stars"};
  out.light = lights_.get(body, Effects{}, *look.sensor,
                          {shifts.from * coldest / kReference, shifts.to * hottest / kReference});
  shading.stars.push_back(std::move(out));
}

Shading Renderer::prepare(const Look& look) {
  check_channels(look, manifest_, dataset_.hits.channels, "dataset");
  Shading shading{{}, {}, look.background, {}};
  const std::vector<LampLight> lamps = add_lamps(shading, look);
  TextureMaker textures(*textures_);
  for (std::uint32_t id = 1; id <= manifest_.objects.size(); ++id) {
    const ObjectEntry& entry = manifest_.objects[id - 1];
    const auto found = look.objects.find(entry.name);
    const ObjectLook object = found == look.objects.end() ? ObjectLook{} : found->second;
    const auto add = [&](const AppearanceLook& appearance) {
      return add_appearance(shading, textures, appearance, object, lamps, id, look);
    };
    add_stars_of(shading, object, id, look);
    shading.objects.push_back(shading_in_time(entry.tau_origin, object.appearance, object.time_slices, add));
  }
  note_light(shading, look, lamps);
  textures.read_films(dataset_, shading);
  return shading;
}

}  // namespace nullcone::postrender
