// Where a look comes from: the scene, a file, and overrides on the command line.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "postrender/look.h"

namespace nullcone::postrender {

/// Overrides one entry, as `--set path=value` does. The path runs over dots ("objects.earth.spectrum") or,
/// when it holds a slash, is a JSON pointer ("/objects/earth/spectrum"). The value is JSON, or else a text.
/// It is merged (RFC 7386: objects entry by entry, null removes), a path into nothing makes the objects on
/// its way, and a number on the path picks from a list. Throws InputError for what is no such override.
void set_entry(nlohmann::json& look, const std::string& assignment);

/// The look of a dataset: that of its scene (or, without one, the empty look), replaced by `look_file` unless
/// that is empty, then overridden by `settings` one after the other. Throws InputError.
Look read_look(const Manifest& manifest, const std::string& dataset_file, const std::string& look_file,
               const std::vector<std::string>& settings);

}  // namespace nullcone::postrender
