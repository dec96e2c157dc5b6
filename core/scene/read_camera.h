// The scene's entry `camera`.
#pragma once

#include "core/base/json.h"
#include "core/scene/scene.h"

namespace nullcone {

Camera read_camera(JsonObject camera);

}  // namespace nullcone
