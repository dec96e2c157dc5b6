#include "postrender/look_place.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "postrender/color.h"

namespace nullcone::postrender {

std::string parse_file_name(JsonObject& in, std::string_view key, const LookSource& source) {
  const std::string file = in.text(key);
  if (file.empty() || file.find('\0') != std::string::npos) in.refuse(key, "expected the name of a file");
  if (source.names != nullptr) {
    const auto known = source.names->find(file);
    if (known == source.names->end())
      in.refuse(key, "expected a file of the first look, or one that was sent");
    return known->second;
  }
  const std::filesystem::path path = (std::filesystem::path(source.folder) / file).lexically_normal();
  // A look that is explained may be kept elsewhere.
  if (source.survey != nullptr) in.note(key, std::filesystem::absolute(path).string());
  return path.string();
}

std::string parse_file(JsonObject& in, std::string_view key, const LookSource& source) {
  const std::string path = parse_file_name(in, key, source);
  if (source.files != nullptr) source.files->named.insert(path);
  return path;
}

Rgb decoded(const std::vector<double>& srgb) {
  return {static_cast<float>(srgb_decoded(srgb[0])), static_cast<float>(srgb_decoded(srgb[1])),
          static_cast<float>(srgb_decoded(srgb[2]))};
}

Rgb parse_color(JsonObject& in, std::string_view key) { return decoded(in.numbers(key, 3, 0, 1)); }

Rgb parse_color_or(JsonObject& in, std::string_view key, Rgb fallback) {
  if (in.has(key)) return parse_color(in, key);
  const auto encoded = [](float linear) { return srgb_encoded(static_cast<double>(linear)); };
  in.note(key, {encoded(fallback.r), encoded(fallback.g), encoded(fallback.b)});
  return fallback;
}

}  // namespace nullcone::postrender
