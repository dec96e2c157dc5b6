// How observers and objects move, as scenes tell it.
#pragma once

#include "core/base/json.h"
#include "core/scene/scene.h"

namespace nullcone {

/// The words that an entry `worldline` may have as its type, besides those of what rests.
std::vector<std::string> motion_types();

/// An entry `worldline` of something that moves.
Motion read_motion(JsonObject line);

}  // namespace nullcone
