// Bodies and what set operations make of them: union, intersection, difference.
#pragma once

#include <memory>
#include <string>

#include "core/base/json.h"
#include "core/scene/solid.h"

namespace nullcone {

/// Lengths of bodies are no less: its square is a number still.
inline constexpr double kLeastLength = 1e-100;

/// The solid that a shape of a type "ellipsoid", "box", "cylinder", "disk", "ring", "union", "intersection"
/// or "difference" describes. The caller finishes the shape.
std::shared_ptr<const Solid> read_solid(JsonObject& shape, const std::string& type);

}  // namespace nullcone
