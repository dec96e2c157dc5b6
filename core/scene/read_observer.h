// The scene's entry `observer`.
#pragma once

#include "core/base/json.h"
#include "core/scene/scene.h"

namespace nullcone {

/// Where and how fast, or along which worldline until which proper time.
Observer read_observer(JsonObject observer);

}  // namespace nullcone
