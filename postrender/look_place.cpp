#include "postrender/look_place.h"

#include <filesystem>

#include "postrender/color.h"

namespace nullcone::postrender {

std::string parse_file(JsonObject& in, std::string_view key, const LookSource& source) {
  const std::string file = in.text(key);
  if (file.empty() || file.find('\0') != std::string::npos) in.refuse(key, "expected the name of a file");
  return (std::filesystem::path(source.folder) / file).lexically_normal().string();
}

Rgb decoded(const std::vector<double>& srgb) {
  return {static_cast<float>(srgb_decoded(srgb[0])), static_cast<float>(srgb_decoded(srgb[1])),
          static_cast<float>(srgb_decoded(srgb[2]))};
}

Rgb parse_color(JsonObject& in, std::string_view key) { return decoded(in.numbers(key, 3, 0, 1)); }

Rgb parse_color_or(JsonObject& in, std::string_view key, Rgb fallback) {
  return in.has(key) ? parse_color(in, key) : fallback;
}

}  // namespace nullcone::postrender
