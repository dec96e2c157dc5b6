#include "postrender/look_develop.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace nullcone::postrender {

using nlohmann::json;

namespace {

constexpr double kLeastWhite = 1e-20, kMostWhite = 1e20;

AutoWhite parse_auto_white(JsonObject in) {
  AutoWhite out;
  if (in.word("auto", {"percentile", "log_average"}) == "percentile") {
    out.percentile = in.number_or("percentile", out.percentile, 0, 100);
  } else {
    out.mode = AutoWhite::Mode::log_average;
    out.key = in.number_or("key", out.key, 1e-6, 1e6);
  }
  in.finish();
  return out;
}

void parse_exposure(JsonObject in, DevelopLook& develop) {
  if (in.has("white_cd_m2")) {
    const json& white = in.at("white_cd_m2");
    if (white.is_number()) {
      develop.white_cd_m2 = in.number("white_cd_m2", kLeastWhite, kMostWhite);
    } else if (white.is_object()) {
      develop.auto_white = parse_auto_white(in.object("white_cd_m2"));
    } else if (white != "auto") {
      in.refuse("white_cd_m2", "expected a number in cd/m^2, \"auto\", or {\"auto\": ...}");
    }
  } else {
    in.note("white_cd_m2", "auto");
  }
  develop.ev = in.number_or("ev", 0, -64, 64);
  in.finish();
}

using Points = std::vector<std::pair<double, double>>;

Points parse_points(JsonObject& in) {
  const json& points = in.at("points");
  if (!points.is_array()) in.refuse("points", "expected a list [[luminance, shown], ...]");
  Points out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const json& point = points[i];
    if (!point.is_array() || point.size() != 2 || !point[0].is_number() || !point[1].is_number())
      in.refuse("points/" + std::to_string(i), "expected [luminance, shown]");
    out.emplace_back(point[0].get<double>(), point[1].get<double>());
  }
  return out;
}

/// What is wrong with the points of a curve, or "".
std::string fault_of(const Points& points) {
  if (points.empty()) return "expected at least one point";
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [L, shown] = points[i];
    const std::string point = "point " + std::to_string(i) + ": ";
    if (!(L >= 0 && L <= kMostWhite)) return point + "expected a luminance from 0 to 1e20";
    if (!(shown >= 0 && shown <= 1)) return point + "expected 0 to 1 to be shown";
    if (L == 0 && shown != 0) return point + "expected 0 to be shown for 0";
    if (i > 0 && !(L > points[i - 1].first)) return point + "expected a greater luminance than before";
  }
  return points.back().first >= kLeastWhite ? "" : "expected a last luminance from 1e-20 on";
}

ToneTable parse_table(JsonObject& in, const LookSource& source) {
  const bool from_file = in.has("file");
  if (from_file && in.has("points")) in.refuse("file", "expected either points or a file");
  const Points points = from_file ? read_tone_csv(parse_file(in, "file", source)) : parse_points(in);
  const std::string fault = fault_of(points);
  if (!fault.empty()) in.refuse(from_file ? "file" : "points", fault);
  std::vector<double> luminance, shown;
  for (const auto& [L, out] : points) {
    luminance.push_back(L);
    shown.push_back(out);
  }
  return {luminance, shown, in.word("interpolation", {"linear", "smooth"}, "linear") == "smooth"};
}

void parse_tone(JsonObject in, const LookSource& source, DevelopLook& develop) {
  using Curve = DevelopLook::Curve;
  const std::string curve = in.word("curve", {"linear", "exponential", "filmic", "table"}, "linear");
  if (curve == "exponential") {
    develop.curve = Curve::exponential;
    develop.k = in.number_or("k", develop.k, 1e-6, 1e6);
  } else if (curve == "filmic") {
    develop.curve = Curve::filmic;
    develop.filmic_white = in.number_or("white", develop.filmic_white, 1e-3, 1e6);
  } else if (curve == "table") {
    develop.curve = Curve::table;
    develop.table = parse_table(in, source);
  }
  in.finish();
}

Chromaticity parse_white_light(JsonObject in) {
  Chromaticity out;
  if (in.has("temperature_K") == in.has("xy")) in.refuse({}, "expected either temperature_K or xy");
  if (in.has("temperature_K")) {
    out = black_body_chromaticity(in.number("temperature_K", 1000, 1e9));
  } else {
    const std::vector<double> xy = in.numbers("xy", 2, 0, 1);
    out = {xy[0], xy[1]};
    if (!(out.x + out.y <= 1) || !(out.y > 0) || !adaptation(out, kD65))
      in.refuse("xy", "no light that could be seen as white");
  }
  in.finish();
  return out;
}

Chromaticity parse_white_point(JsonObject& look) {
  const json& white = look.at("white_point");
  if (white.is_object()) return parse_white_light(look.object("white_point"));
  if (white == "D65") return kD65;
  if (white == "equal_energy") return kEqualEnergy;
  look.refuse("white_point", R"(expected "D65", "equal_energy", {"temperature_K": T} or {"xy": [x, y]})");
}

Output parse_output(JsonObject in) {
  Output out;
  std::vector<std::string> names;
  for (const auto& space : kOutputSpaces) names.emplace_back(space.first);
  const std::string name = in.word("space", names, "srgb");
  for (const auto& [known, space] : kOutputSpaces)
    if (known == name) out.space = space;
  if (in.has("jpeg_quality")) {
    out.jpeg_quality = static_cast<int>(in.integer("jpeg_quality", 1, 100));
  } else {
    in.note("jpeg_quality", out.jpeg_quality);
  }
  in.finish();
  return out;
}

}  // namespace

DevelopLook parse_develop(JsonObject& look, const LookSource& source) {
  DevelopLook out;
  parse_exposure(look.object_or_empty("exposure"), out);
  parse_tone(look.object_or_empty("tone"), source, out);
  if (look.word("gamut", {"hue_preserving", "clip"}, "hue_preserving") == "clip")
    out.gamut = DevelopLook::Gamut::clip;
  if (look.has("white_point")) {
    out.white_point = parse_white_point(look);
  } else {
    look.note("white_point", "D65");
  }
  out.output = parse_output(look.object_or_empty("output"));
  return out;
}

}  // namespace nullcone::postrender
