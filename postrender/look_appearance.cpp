#include "postrender/look_appearance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "postrender/look_changing.h"

namespace nullcone::postrender {

using nlohmann::json;

namespace {

constexpr std::size_t kSteps = 64;  ///< between two keyframes of a spectrum
constexpr double kColdest_K = 1, kHottest_K = 1e9;

Clock parse_clock(JsonObject& in, std::string_view key) {
  return in.word(key, {"t", "tau"}) == "tau" ? Clock::tau : Clock::t;
}

/// Between the keys' extremes, as a factor.
double middle(const Keyframes& keys) {
  const auto [least, most] = std::ranges::minmax(keys.values);
  return std::sqrt(least) * std::sqrt(most);
}

void parse_spectrum_in_time(JsonObject& outer, const LookSource& source, AppearanceLook& out) {
  json entry = outer.at("spectrum");
  const std::string pointer = pointer_of(outer, "spectrum", source);
  // Step 1: the temperature of a black body is exact for every pixel.
  if (entry.is_object() && entry.contains("temperature_K") && is_keyframes(entry["temperature_K"]) &&
      !entry.contains("luminance_cd_m2") && entry.contains("type") && entry["type"] == "black_body") {
    JsonObject in = outer.object("spectrum");
    out.spectrum_in_time.temperature_K = parse_number(in, "temperature_K", source, {kColdest_K, kHottest_K});
    entry["temperature_K"] = out.spectrum_in_time.reference_K =
        middle(*out.spectrum_in_time.temperature_K->keys);
  }
  // Step 2: whatever else changes, node by node.
  const Nodes nodes = at_nodes(entry, kSteps, {}, source.place, pointer);
  if (nodes.timeline.nodes.empty() && !out.spectrum_in_time.temperature_K) {
    out.spectrum = parse_spectrum(outer.object("spectrum"), source);
    return;
  }
  std::vector<SpectrumLook> spectra;
  for (const json& value : nodes.values)
    spectra.push_back(parse_spectrum(JsonObject(value, source.place, pointer), source));
  out.spectrum = spectra.front();
  if (spectra.size() == 1) return;
  out.spectrum_in_time.timeline = nodes.timeline;
  out.spectrum_in_time.nodes = std::move(spectra);
}

Blink parse_blink(JsonObject in, const LookSource& source) {
  Blink out;
  out.clock = parse_clock(in, "channel");
  out.period = in.positive("period");
  out.duty = parse_number_or(in, "duty", source, 0.5, {0, 1});
  out.phase = parse_number_or(in, "phase", source, 0, {-1e9, 1e9});
  out.fade = in.number_or("fade", 0, 0);
  out.transparent = in.word("off", {"black", "transparent"}, "black") == "transparent";
  in.finish();
  return out;
}

AppearanceLook parse_appearance(JsonObject& in, const LookSource& source) {
  std::optional<TextureLook> texture;
  if (in.has("texture")) texture = parse_texture(in, source);
  AppearanceLook out = parse_light(in, source);
  out.texture = std::move(texture);
  return out;
}

/// A duration, or one for coming and one for going.
void parse_fade(JsonObject& in, Slice& out) {
  if (!in.has("fade")) return;
  if (in.at("fade").is_array()) {
    const std::vector<double> both = in.numbers("fade", 2, 0);
    out.fade_in = both[0];
    out.fade_out = both[1];
  } else {
    out.fade_in = out.fade_out = in.number("fade", 0);
  }
}

using ParseAppearance = std::function<AppearanceLook(JsonObject&)>;

TimeSliceLook parse_time_slice(JsonObject in, const ParseAppearance& parse_what) {
  TimeSliceLook out;
  Slice& when = out.when;
  when.clock = parse_clock(in, "channel");
  when.from = in.number_or("from", -std::numeric_limits<double>::infinity());
  when.to = in.number_or("to", std::numeric_limits<double>::infinity());
  if (!(when.from < when.to)) in.refuse("to", "expected a number greater than from");
  parse_fade(in, when);
  out.appearance = parse_what(in);
  in.finish();
  if (out.appearance.empty()) in.refuse("", "expected another texture, spectrum, intensity or blink");
  return out;
}

/// All that hold at once are laid over one another; there is a limit.
void check_fades(const JsonObject& in, const std::vector<TimeSliceLook>& looks) {
  std::vector<Slice> slices;
  for (const TimeSliceLook& look : looks) slices.push_back(look.when);
  try {
    SliceTable{slices};
  } catch (const SliceTable::TooManyFades& many) {
    in.refuse("time_slices", "more than " + std::to_string(SliceTable::kMostFades) +
                                 " slices fade into one another after " + json(many.time).dump());
  }
}

/// Textures and spectra of materials go together.
void check_materials(const AppearanceLook& look, const JsonObject& in, const std::string& key) {
  const bool spectra = look.spectrum && look.spectrum->kind == SpectrumLook::Kind::materials,
             texture = look.texture && is_of_materials(*look.texture);
  if (spectra != texture) in.refuse(key, "a texture and a spectrum of type materials go together");
}

SurfaceType parse_surface(JsonObject in) {
  const std::string type = in.word("type", {"self_luminous", "lambertian"}, "self_luminous");
  in.finish();
  return type == "lambertian" ? SurfaceType::lambertian : SurfaceType::self_luminous;
}

/// A reflectance is one spectrum of pure numbers.
void check_reflectance(const AppearanceLook& own, const JsonObject& in, const std::string& key) {
  if (!own.spectrum || own.spectrum->kind == SpectrumLook::Kind::display) return;
  if (own.spectrum_in_time.temperature_K)
    in.refuse(key, "the spectrum of a lambertian surface is its reflectance, which has no temperature");
  if (own.spectrum->kind != SpectrumLook::Kind::filtered)
    in.refuse(key + "/type",
              "the spectrum of a lambertian surface is its reflectance: expected one spectrum");
  if (!own.spectrum->spectra[0]->lines().empty()) in.refuse(key, "a reflectance cannot have lines");
}

}  // namespace

AppearanceLook parse_light(JsonObject& in, const LookSource& source) {
  AppearanceLook out;
  if (in.has("spectrum")) parse_spectrum_in_time(in, source, out);
  if (in.has("intensity")) out.intensity = parse_number(in, "intensity", source, {0, kMostIntense});
  if (in.has("blink")) out.blink = parse_blink(in.object("blink"), source);
  return out;
}

AppearanceLook inherited(const AppearanceLook& own, const AppearanceLook& from) {
  AppearanceLook out = own;
  if (!own.texture) out.texture = from.texture;
  if (!own.spectrum) {
    out.spectrum = from.spectrum;
    out.spectrum_in_time = from.spectrum_in_time;
  }
  if (!own.intensity) out.intensity = from.intensity;
  if (!own.blink) out.blink = from.blink;
  return out;
}

std::vector<TimeSliceLook> parse_time_slices(JsonObject& in, const ParseAppearance& parse_what) {
  std::vector<TimeSliceLook> out;
  if (in.has("time_slices"))
    for (JsonObject& slice : in.objects("time_slices")) out.push_back(parse_time_slice(slice, parse_what));
  check_fades(in, out);
  return out;
}

ObjectLook parse_object(JsonObject in, const LookSource& source) {
  ObjectLook object;
  object.surface = parse_surface(in.object_or_empty("surface"));
  object.appearance = parse_appearance(in, source);
  if (!object.appearance.spectrum) in.note("spectrum", {{"type", "display"}});
  if (in.has("stars")) object.stars = parse_stars(in, source);
  object.opacity = parse_number_or(in, "opacity", source, 1, {0, 1});
  object.time_slices =
      parse_time_slices(in, [&](JsonObject& slice) { return parse_appearance(slice, source); });
  const bool lit = object.surface == SurfaceType::lambertian;
  if (lit) check_reflectance(object.appearance, in, "spectrum");
  check_materials(object.appearance, in, "");
  for (std::size_t i = 0; i < object.time_slices.size(); ++i) {
    const AppearanceLook& own = object.time_slices[i].appearance;
    const std::string place = "time_slices/" + std::to_string(i);
    if (lit) check_reflectance(own, in, place + "/spectrum");
    check_materials(inherited(own, object.appearance), in, place);
  }
  in.finish();
  return object;
}

}  // namespace nullcone::postrender
