#include "postrender/look_source.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/keyframes.h"
#include "postrender/look_path.h"

namespace nullcone::postrender {

using nlohmann::json;

namespace {

json parse_value(const std::string& text, const std::string& place) {
  try {
    return parse_json(text, place);
  } catch (const InputError&) {
    // A broken list or object is a mistake; anything else is meant as a text.
    if (!text.empty() && (text[0] == '{' || text[0] == '[' || text[0] == '"')) throw;
    char* end = nullptr;
    const bool number = !text.empty() && !std::isfinite(std::strtod(text.c_str(), &end)) && *end == '\0';
    if (number) throw InputError(place, "expected a finite number (a text of that kind in quotes)");
    return text;
  }
}

json& list_entry(json& list, const std::string& key, const std::string& place) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
  if (error != std::errc() || end != key.data() + key.size() || index >= list.size())
    throw InputError(place,
                     "no entry '" + printable(key, 40) + "' in a list of " + std::to_string(list.size()));
  return list[index];
}

/// Whole numbers without a point, so that 1 and 1.0 are told alike.
json told_alike(json value) {
  if (value.is_structured())
    for (json& item : value) item = told_alike(std::move(item));
  if (!value.is_number_float()) return value;
  const double number = value.get<double>();
  const bool whole =
      number == std::floor(number) && std::abs(number) < 1e15 && !(number == 0 && std::signbit(number));
  return whole ? json(static_cast<std::int64_t>(number)) : value;
}

std::string folder_of(const std::string& file) { return std::filesystem::path(file).parent_path().string(); }

}  // namespace

void set_entry(json& look, const std::string& assignment) {
  const std::string place = "--set " + printable(assignment, 80);
  const auto equals = assignment.find('=');
  if (equals == std::string::npos) throw InputError(place, "expected path=value");
  const std::vector<std::string> keys = split_path(assignment.substr(0, equals), place);

  // Step 1: walk through what is there; from where nothing is, the rest becomes a patch.
  json* at = &look;
  std::size_t done = 0;
  while (done < keys.size()) {
    if (at->is_array()) {
      at = &list_entry(*at, keys[done++], place);
    } else if (at->is_object() && at->contains(keys[done]) && done + 1 < keys.size()) {
      at = &(*at)[keys[done++]];
    } else {
      break;
    }
  }
  // Step 2: wrap the value in the objects that are missing, and merge.
  json patch = parse_value(assignment.substr(equals + 1), place);
  for (std::size_t i = keys.size(); i > done; --i) {
    json outer = json::object();
    outer[keys[i - 1]] = std::move(patch);
    patch = std::move(outer);
  }
  at->merge_patch(patch);
}

LookDocument read_document(const Manifest& manifest, const std::string& dataset_file,
                           const std::string& look_file, const std::vector<std::string>& settings) {
  json document = json::object();
  LookSource source{dataset_file, "/look", folder_of(dataset_file)};
  JsonOrigin origin;
  if (!look_file.empty()) {
    WholeJson look = include_files(parse_json_file(look_file), look_file);
    document = std::move(look.document), origin = std::move(look.origin);
    source = {look_file, "", folder_of(look_file)};
  } else if (!manifest.scene.empty()) {
    const json scene = parse_json(manifest.scene, dataset_file);
    if (scene.is_object() && scene.contains("look")) document = scene["look"];
  }
  for (const std::string& setting : settings) set_entry(document, setting);
  return {std::make_shared<const json>(std::move(document)), source, std::move(origin)};
}

Look look_at(const LookDocument& document, const Manifest& manifest, double frame, LookInFull* in_full) try {
  LookSource source = document.source;
  source.frame = frame;
  if (in_full != nullptr) {
    source.survey = &in_full->survey;
    source.files = &in_full->files;
  }
  const json now = at_frame(*document.json, frame, source.place, source.pointer);
  Look look = parse_look(now, source, manifest);
  if (in_full != nullptr)
    in_full->text = canonical_json(told_alike(in_full->survey.complete(now, source.pointer)));
  return look;
} catch (const InputError& error) {
  throw document.origin.told(error, document.source.place);
}

Look read_look(const Manifest& manifest, const std::string& dataset_file, const std::string& look_file,
               const std::vector<std::string>& settings, double frame) {
  return look_at(read_document(manifest, dataset_file, look_file, settings), manifest, frame);
}

}  // namespace nullcone::postrender
