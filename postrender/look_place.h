// Where a look stands, and how colours are written in it.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/json.h"
#include "postrender/image.h"

namespace nullcone::postrender {

/// Files that a look names; resolved.
struct LookFiles {
  std::set<std::string> named;
  std::set<std::string> numbered;  ///< of image sequences: they need not all be there
};

/// A look as JSON and where it came from.
struct LookSource {
  std::string place;             ///< a file's name, for complaints
  std::string pointer;           ///< of the look inside that file: "" or "/look"
  std::string folder;            ///< relative files are resolved against this
  double frame = 0;              ///< of a sequence, for what shows the time
  JsonSurvey* survey = nullptr;  ///< where asked for: told of all defaults
  LookFiles* files = nullptr;    ///< where asked for: gets all files that the look names
  /// For looks by strangers: the only names of files that may stand in it, and their paths.
  const std::map<std::string, std::string>* names = nullptr;
};

/// The name under `key`, resolved against the folder of the look; not noted as that of a file.
std::string parse_file_name(JsonObject& in, std::string_view key, const LookSource& source);
/// The same of a file, which is noted in `source.files`.
std::string parse_file(JsonObject& in, std::string_view key, const LookSource& source);

/// Colours in JSON are sRGB numbers in [0, 1], as colour pickers show them; in memory they are linear.
Rgb parse_color(JsonObject& in, std::string_view key);
Rgb parse_color_or(JsonObject& in, std::string_view key, Rgb fallback);
/// From three sRGB numbers.
Rgb decoded(const std::vector<double>& srgb);

}  // namespace nullcone::postrender
