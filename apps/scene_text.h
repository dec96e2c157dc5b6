// Where scenes come from.
#pragma once

#include <string>

namespace nullcone {

/// The text of a scene: a JSON file, or the scene that a dataset carries in its header. Throws InputError.
std::string scene_text(const std::string& path);

}  // namespace nullcone
