// Where a look comes from: the scene, a file, and overrides on the command line.
#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/base/include.h"
#include "postrender/look.h"

namespace nullcone::postrender {

/// Overrides one entry, as `--set path=value` does. The path runs over dots ("objects.earth.spectrum") or,
/// when it holds a slash, is a JSON pointer ("/objects/earth/spectrum"). The value is JSON, or else a text.
/// It is merged (RFC 7386: objects entry by entry, null removes), a path into nothing makes the objects on
/// its way, and a number on the path picks from a list. Throws InputError for what is no such override.
void set_entry(nlohmann::json& look, const std::string& assignment);

/// A look as JSON: overridden, not yet parsed, with its keyframes.
struct LookDocument {
  std::shared_ptr<const nlohmann::json> json;
  LookSource source;
  JsonOrigin origin = {};  ///< of a look file: where what it includes was written
};

/// What a parsed look amounts to.
struct LookInFull {
  std::string text;  ///< JSON: a look that gives the same picture, with all defaults; canonical
  LookFiles files;
  JsonSurvey survey;
};

/// The look of a dataset: that of its scene (or, without one, the empty look), replaced by `look_file` unless
/// that is empty, then overridden by `settings` one after the other. Throws InputError.
LookDocument read_document(const Manifest& manifest, const std::string& dataset_file,
                           const std::string& look_file, const std::vector<std::string>& settings);

/// The look of one frame: keyframes by frame are evaluated there. Throws InputError as parse_look() does.
Look look_at(const LookDocument& document, const Manifest& manifest, double frame,
             LookInFull* in_full = nullptr);

/// Both.
Look read_look(const Manifest& manifest, const std::string& dataset_file, const std::string& look_file,
               const std::vector<std::string>& settings, double frame = 0);

}  // namespace nullcone::postrender
