#include "postrender/look_stars.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "postrender/look_changing.h"
#include "postrender/texture_cache.h"

namespace nullcone::postrender {

namespace {

constexpr double kLargestSeed = 9007199254740991;  // 2^53 - 1: whole numbers that JSON carries safely

std::array<double, 2> parse_range(JsonObject& in, const char* key, const std::array<double, 2>& usual,
                                  const Bounds& bounds) {
  const std::vector<double> ends = in.numbers_or(key, {usual[0], usual[1]}, bounds.least, bounds.most);
  if (!(ends[0] <= ends[1])) in.refuse(key, "expected [from, to] in increasing order");
  return {ends[0], ends[1]};
}

RandomStars parse_random(JsonObject in) {
  RandomStars out;
  out.count = static_cast<std::size_t>(in.integer("count", 0, static_cast<long>(kMostStars)));
  const double seed = in.number_or("seed", 1, 0, kLargestSeed);
  if (seed != std::floor(seed)) in.refuse("seed", "expected a whole number");
  out.seed = static_cast<std::uint64_t>(seed);
  out.magnitudes = parse_range(in, "magnitudes", out.magnitudes, {kBrightestMagnitude, kFaintestMagnitude});
  out.temperatures_K =
      parse_range(in, "temperatures_K", out.temperatures_K, {kColdestStar_K, kHottestStar_K});
  out.slope = in.number_or("slope", out.slope, 0, 2);
  if (in.has("around_deg")) {
    const std::vector<double> around = in.numbers("around_deg", 2, -360, 360);
    if (!(std::abs(around[1]) <= 90)) in.refuse("around_deg/1", "expected a declination from -90 to 90");
    out.around_deg = {around[0], around[1]};
    out.spread_deg = in.number("spread_deg", 0, 180);
  }
  in.finish();
  return out;
}

}  // namespace

StarsLook parse_stars(JsonObject& object, const LookSource& source) {
  JsonObject in = object.object("stars");
  StarsLook out;
  if (in.has("file")) {
    out.file = parse_file(in, "file", source);
    out.pointer = pointer_of(in, "file", source);
  }
  std::size_t count = 0;
  if (in.has("random"))
    for (JsonObject& one : in.objects("random")) {
      out.random.push_back(parse_random(one));
      count += out.random.back().count;
    }
  if (out.file.empty() && out.random.empty()) in.refuse("", "expected file, or random, or both");
  if (count > kMostStars) in.refuse("random", "expected at most 4 million stars");
  if (in.has("rotate_deg")) {
    out.rotation = parse_rotation(in, source);
    if (out.rotation->changes())
      in.refuse("rotate_deg", "stars have no time of emission; expected numbers, or keyframes by frame");
  }
  out.style.intensity = in.number_or("intensity", out.style.intensity, 0, 1e12);
  out.style.size_px = in.number_or("size_px", out.style.size_px, 0.1, 4);
  out.style.most_magnified = in.number_or("most_magnified", out.style.most_magnified, 1, 1e12);
  in.finish();
  return out;
}

std::string key_of(const StarsLook& look) {
  std::string out = look.file + "\n" + (look.file.empty() ? "" : file_stamp(look.file));
  const auto add = [&](double number) {
    char text[32];
    std::snprintf(text, sizeof text, "|%.17g", number);
    out += text;
  };
  for (const RandomStars& rule : look.random) {
    out += "\n";
    for (const double number :
         {static_cast<double>(rule.count), static_cast<double>(rule.seed), rule.magnitudes[0],
          rule.magnitudes[1], rule.temperatures_K[0], rule.temperatures_K[1], rule.slope})
      add(number);
    if (!rule.around_deg) continue;
    for (const double number : {(*rule.around_deg)[0], (*rule.around_deg)[1], rule.spread_deg}) add(number);
  }
  out += "\n";
  if (look.rotation)
    for (const float entry : look.rotation->to_texture({})) add(static_cast<double>(entry));
  return out;
}

StarField make_stars(const StarsLook& look) {
  std::vector<Star> stars;
  if (!look.file.empty()) stars = read_stars(look.file, look.pointer);
  for (const RandomStars& rule : look.random) add_random_stars(rule, stars);
  if (look.rotation) {
    // What is at p is seen at R p; the matrix is that of the way back.
    const std::array<float, 9> m = look.rotation->to_texture({});
    for (Star& star : stars) {
      const auto [x, y, z] = star.direction;
      for (std::size_t i = 0; i < 3; ++i) star.direction[i] = m[i] * x + m[3 + i] * y + m[6 + i] * z;
    }
  }
  return StarField(std::move(stars));
}

}  // namespace nullcone::postrender
