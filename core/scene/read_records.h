// The scene's entry `records`: what is written down of a ray.
#pragma once

#include "core/base/json.h"
#include "core/scene/scene.h"

namespace nullcone {

/// Reads `records` of the scene's `root`, where it is there. More than one sample a pixel is always told
/// apart, and light of lamps always recorded: `scene` has its camera and its lamps already.
Records read_records(JsonObject& root, const Scene& scene);

}  // namespace nullcone
