// Paths of entries of a look: "objects.earth.spectrum", or the JSON pointer "/objects/earth/spectrum".
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace nullcone::postrender {

/// The steps of a path, which runs over dots or, when it holds a slash, is a JSON pointer. Throws InputError
/// "place: ..." for empty steps and for more than 32 of them.
std::vector<std::string> split_path(const std::string& path, const std::string& place);

/// What stands there, or null.
const nlohmann::json* find_entry(const nlohmann::json& document, const std::vector<std::string>& keys);

}  // namespace nullcone::postrender
