#include "postrender/look.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace nullcone::postrender {

namespace {

/// Only skies have stars, as far as the scene tells what they are.
void check_stars(const std::map<std::string, ObjectLook>& objects, const JsonObject& in,
                 const Manifest& manifest) {
  if (manifest.scene.empty() ||
      std::ranges::none_of(objects, [](const auto& o) { return o.second.stars.has_value(); }))
    return;
  const nlohmann::json scene = nlohmann::json::parse(manifest.scene, nullptr, false);
  if (!scene.is_object() || !scene.contains("objects") || !scene["objects"].is_array()) return;
  for (const nlohmann::json& object : scene["objects"]) {
    const nlohmann::json shape = object.value("/shape/type"_json_pointer, nlohmann::json());
    const auto found = objects.find(object.value("name", std::string()));
    if (found != objects.end() && found->second.stars && shape != "sky")
      in.refuse(found->first + "/stars", "is no sky; expected stars on a sky only");
  }
}

std::map<std::string, ObjectLook> parse_objects(JsonObject in, const LookSource& source,
                                                const Manifest& manifest) {
  std::string names;
  for (const ObjectEntry& object : manifest.objects) names += (names.empty() ? "" : ", ") + object.name;
  std::map<std::string, ObjectLook> out;
  for (const std::string& name : in.keys()) {
    const bool known =
        std::ranges::any_of(manifest.objects, [&](const auto& object) { return object.name == name; });
    if (!known) in.refuse(name, "the dataset has no such object; expected one of " + names);
  }
  for (const ObjectEntry& object : manifest.objects)
    out.emplace(object.name, parse_object(in.object_or_empty(object.name), source));
  check_stars(out, in, manifest);
  return out;
}

PixelFilter parse_pixel_filter(JsonObject in) {
  using Type = PixelFilter::Type;
  PixelFilter filter;
  const std::string type = in.word("type", {"box", "gaussian", "mitchell"}, "box");
  filter.type = type == "box" ? Type::box : type == "gaussian" ? Type::gaussian : Type::mitchell;
  filter.width = in.number_or("width", usual_width(filter.type), 1, kWidestFilter);
  in.finish();
  return filter;
}

Beaming parse_beaming(JsonObject exponents) {
  Beaming out;
  out.spectral = exponents.number_or("spectral", out.spectral, -10, 10);
  out.integrated = exponents.number_or("integrated", out.integrated, -10, 10);
  exponents.finish();
  return out;
}

Effects parse_effects(JsonObject in) {
  Effects out;
  out.doppler = in.boolean("doppler", true);
  out.searchlight = in.boolean("searchlight", true);
  out.radiance = parse_beaming(in.object_or_empty("radiance_exponents"));
  out.irradiance = parse_beaming(in.object_or_empty("irradiance_exponents"));
  in.finish();
  return out;
}

bool has_spectrum(const AppearanceLook& appearance) {
  return appearance.spectrum && appearance.spectrum->kind != SpectrumLook::Kind::display;
}

/// The entry of the first light that shines on surfaces without a spectrum; empty if none does.
std::string light_without_spectrum(const Look& look) {
  const auto shown_as_it_is = [](const TimeSliceLook& slice) {
    return slice.appearance.spectrum && !has_spectrum(slice.appearance);
  };
  for (const auto& [name, lamp] : look.lights)
    if (lamp.on && (!has_spectrum(lamp.light) || std::ranges::any_of(lamp.time_slices, shown_as_it_is)))
      return "lights/" + name;
  return look.ambient && look.ambient->spectrum.kind == SpectrumLook::Kind::display ? "ambient" : "";
}

/// A reflectance by wavelength says nothing about light without wavelengths.
void check_light(const Look& look, const JsonObject& in) {
  const std::string without = light_without_spectrum(look);
  for (const auto& [name, object] : look.objects) {
    if (object.surface != SurfaceType::lambertian) continue;
    const auto in_slice = [](const TimeSliceLook& slice) { return has_spectrum(slice.appearance); };
    const bool spectral =
        has_spectrum(object.appearance) || std::ranges::any_of(object.time_slices, in_slice);
    if (spectral && !without.empty())
      in.refuse(without, "needs a spectrum, because objects/" + name + " has a reflectance by wavelength");
    if (look.legend.scale && look.legend.scale->object == name)
      in.refuse("legend/scale/object", "expected an object that is self-luminous");
  }
}

}  // namespace

Look parse_look(const nlohmann::json& document, const LookSource& source, const Manifest& manifest) {
  JsonObject in(document, source.place, source.pointer, source.survey);
  Look look;
  look.objects = parse_objects(in.object_or_empty("objects"), source, manifest);
  look.lights = parse_lamps(in.object_or_empty("lights"), source, manifest);
  if (in.has("ambient")) look.ambient = parse_ambient(in.object("ambient"), source);
  look.effects = parse_effects(in.object_or_empty("effects"));
  look.sensor = parse_sensor(in, "sensor", source);
  look.pixel_filter = parse_pixel_filter(in.object_or_empty("pixel_filter"));
  look.develop = parse_develop(in, source);
  if (in.has("legend")) look.legend = parse_legend(in.object("legend"), source, document, manifest);
  look.background = parse_color_or(in, "background", {});
  if (document.contains("$schema")) in.text("$schema");  // for editors; no step of a path
  in.finish();
  check_light(look, in);
  return look;
}

}  // namespace nullcone::postrender
