// The scene's entry `lights`: lamps, and which of their light is written down.
#pragma once

#include <vector>

#include "core/base/json.h"
#include "core/scene/scene.h"

namespace nullcone {

/// Throws InputError also for a lamp whose body is none of the `objects`, or the sky.
Lights read_lights(JsonObject lights, const std::vector<Object>& objects);

}  // namespace nullcone
