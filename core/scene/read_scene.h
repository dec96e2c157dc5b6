// From JSON to a Scene. Strict: what is unknown, missing, double or out of range is refused with its place.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene.h"

namespace nullcone {

class MeshShelf;

/// One parameter of a metric, as scenes and command lines name it.
struct MetricParameter {
  std::string_view name;
  double fallback, least, most;
  std::array<std::string_view, 2>
      words{};  ///< where not empty, one of these is given, and stands for its number
};

/// What the reader must know of a spacetime.
struct MetricDescription {
  std::string_view name;
  std::vector<MetricParameter> parameters;
  int skies = 0;  ///< how many infinities hold a sky
  bool closed_paths = false;
  bool stationary = true;  ///< nothing in it changes with time
  bool isometric = false;  ///< an isometry carries any event to any other, and is known
};

/// Reads a scene from JSON text; `place` (a file's name) stands before complaints. `max_lookback` stays 0
/// where the scene does not give one: the spacetime then says what suits it. Throws InputError, also for a
/// sequence (see scene_at()). Meshes are taken from the shelf, if there is one, and put there: give it to all
/// readings that may have the same ones.
Scene read_scene(const std::string& text, const std::string& place,
                 std::span<const MetricDescription> metrics, MeshShelf* shelf = nullptr);

}  // namespace nullcone
