#include "postrender/look_appearance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace nullcone::postrender {

namespace {

std::array<float, 2> parse_pair(JsonObject& in, std::string_view key, std::array<float, 2> fallback) {
  const auto pair =
      in.numbers_or(key, {static_cast<double>(fallback[0]), static_cast<double>(fallback[1])}, -1e4, 1e4);
  return {static_cast<float>(pair[0]), static_cast<float>(pair[1])};
}

TextureLook parse_image(JsonObject& in, const LookSource& source) {
  ImageLook image;
  image.file = parse_file(in, "file", source);
  const std::string where = in.where("file");
  image.pointer = where.substr(std::min(where.size(), source.place.size() + 2));
  image.uv.offset = parse_pair(in, "offset", {0, 0});
  image.uv.scale = parse_pair(in, "scale", {1, 1});
  image.mipmap = in.word("filter", {"mipmap", "bilinear"}, "mipmap") == "mipmap";
  image.alpha = in.boolean("alpha", false);
  return image;
}

/// A list of two colours under `key`.
std::array<Rgb, 2> parse_two_colors(JsonObject& in, std::string_view key) {
  const nlohmann::json& list = in.at(key);
  if (!list.is_array() || list.size() != 2)
    in.refuse(key, "expected a list of two colours [[r, g, b], [r, g, b]]");
  std::array<Rgb, 2> out;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string place = std::string(key) + "/" + std::to_string(i);
    if (!list[i].is_array() || list[i].size() != 3) in.refuse(place, "expected a list of 3 numbers");
    std::vector<double> srgb;
    for (const nlohmann::json& number : list[i]) {
      if (!number.is_number() || !(number.get<double>() >= 0 && number.get<double>() <= 1))
        in.refuse(place, "expected 3 numbers from 0 to 1");
      srgb.push_back(number.get<double>());
    }
    out[i] = decoded(srgb);
  }
  return out;
}

TextureLook parse_checkerboard(JsonObject& in) {
  CheckerboardTexture board;
  const auto counts = in.numbers("counts", 2, 1, 100000);
  for (std::size_t i = 0; i < 2; ++i) {
    if (counts[i] != std::floor(counts[i]))
      in.refuse("counts/" + std::to_string(i), "expected a whole number");
    board.counts[i] = static_cast<float>(counts[i]);
  }
  if (in.has("colors") == in.has("gradient")) in.refuse("", "expected either colors or gradient");
  if (in.has("colors")) {
    const auto colors = parse_two_colors(in, "colors");
    board.even = {colors[0], colors[0]};
    board.odd = {colors[1], colors[1]};
    return board;
  }
  JsonObject gradient = in.object("gradient");
  board.axis = gradient.word("along", {"u", "v"}) == "u" ? 0 : 1;
  board.even = {parse_color(gradient, "from"), parse_color(gradient, "to")};
  const auto dark = static_cast<float>(gradient.number_or("dark", 0.25, 0, 1));
  board.odd = {dark * board.even[0], dark * board.even[1]};
  gradient.finish();
  return board;
}

TextureLook parse_texture(JsonObject in, const LookSource& source) {
  const std::string type = in.word("type", {"image", "checkerboard", "color"});
  TextureLook texture;
  if (type == "image") texture = parse_image(in, source);
  if (type == "checkerboard") texture = parse_checkerboard(in);
  if (type == "color") texture = ColorTexture{parse_color(in, "rgb")};
  in.finish();
  return texture;
}

AppearanceLook parse_appearance(JsonObject& in, const LookSource& source) {
  AppearanceLook out;
  if (in.has("texture")) out.texture = parse_texture(in.object("texture"), source);
  if (in.has("spectrum")) out.spectrum = parse_spectrum(in.object("spectrum"), source);
  return out;
}

TimeSliceLook parse_time_slice(JsonObject in, const LookSource& source) {
  TimeSliceLook slice;
  slice.own_clock = in.word("channel", {"t", "tau"}) == "tau";
  slice.from = in.number_or("from", -std::numeric_limits<double>::infinity());
  slice.to = in.number_or("to", std::numeric_limits<double>::infinity());
  if (!(slice.from < slice.to)) in.refuse("to", "expected a number greater than from");
  slice.appearance = parse_appearance(in, source);
  if (!slice.appearance.texture && !slice.appearance.spectrum)
    in.refuse("", "expected a texture or a spectrum");
  in.finish();
  return slice;
}

}  // namespace

AppearanceLook inherited(const AppearanceLook& own, const AppearanceLook& from) {
  return {own.texture ? own.texture : from.texture, own.spectrum ? own.spectrum : from.spectrum};
}

ObjectLook parse_object(JsonObject in, const LookSource& source) {
  ObjectLook object;
  object.appearance = parse_appearance(in, source);
  if (!object.appearance.spectrum) in.note("spectrum", {{"type", "display"}});
  object.opacity = in.number_or("opacity", 1, 0, 1);
  if (in.has("time_slices"))
    for (JsonObject& slice : in.objects("time_slices"))
      object.time_slices.push_back(parse_time_slice(slice, source));
  in.finish();
  return object;
}

}  // namespace nullcone::postrender
