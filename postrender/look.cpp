#include "postrender/look.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace nullcone::postrender {

namespace {

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

}  // namespace

Look parse_look(const nlohmann::json& document, const LookSource& source, const Manifest& manifest) {
  JsonObject in(document, source.place, source.pointer, source.survey);
  Look look;
  look.objects = parse_objects(in.object_or_empty("objects"), source, manifest);
  look.lights = parse_lamps(in.object_or_empty("lights"), source, manifest.lights);
  look.effects = parse_effects(in.object_or_empty("effects"));
  look.sensor = parse_sensor(in, "sensor", source);
  look.pixel_filter = parse_pixel_filter(in.object_or_empty("pixel_filter"));
  look.develop = parse_develop(in, source);
  if (in.has("legend")) look.legend = parse_legend(in.object("legend"), source, document, manifest);
  look.background = parse_color_or(in, "background", {});
  in.finish();
  return look;
}

}  // namespace nullcone::postrender
