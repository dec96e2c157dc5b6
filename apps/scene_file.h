// Where scenes come from.
#pragma once

#include <string>

#include "core/base/include.h"

namespace nullcone {

/// A scene: from a JSON file with what it includes, or the one that a dataset carries in its header, which
/// includes nothing. Throws InputError.
WholeJson read_scene_file(const std::string& path);

}  // namespace nullcone
