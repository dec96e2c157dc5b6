// An object's shape: spheres, boxes, quads, the sky; other bodies, and what set operations make of them.
#pragma once

#include "core/base/json.h"
#include "core/scene/read_scene.h"

namespace nullcone {

/// An object's `shape`.
Shape read_shape(JsonObject shape, const MetricDescription& metric);

}  // namespace nullcone
