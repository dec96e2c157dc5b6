// A scene that is traced again and again, with other numbers in it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/record/dataset.h"
#include "core/scene/read_scene.h"

namespace nullcone::view {

/// What one request may ask for, in memory and for a file: rays and paths of lamps' light to what they meet,
/// and seconds.
struct LiveLimits {
  double paths = 1 << 23, seconds = 10;
  double saved_paths = 1 << 26, saved_seconds = 120;
};

/// Immutable: any number of threads may trace it.
class LiveScene {
 public:
  /// Why the scene of a dataset, which was read from the file `dataset`, cannot be traced live, in one line;
  /// empty if it can. Meshes are looked for beside that file, unless they are on the shelf.
  static std::string hindrance(const Manifest& manifest, const std::string& dataset,
                               MeshShelf* meshes = nullptr);

  /// Throws InputError where there is a hindrance. The shelf, if there is one, stays where it is.
  LiveScene(const Manifest& manifest, const std::string& dataset, MeshShelf* meshes = nullptr,
            const LiveLimits& limits = {});

  /// Traces the scene with `changes` (scene_changes.h) in memory, its resolution divided by `scale` (1 to 8),
  /// with one ray a pixel where that is not 1; without fingerprints. Throws InputError with the place of what
  /// is wrong in the changes, for what no spacetime can hold, and for what goes beyond the limits.
  Dataset trace(const nlohmann::json& changes, int scale) const;

  /// A dataset file as nullcone-trace writes it; `look` replaces that in the scene, unless it is null. Throws
  /// InputError and WorkError.
  void save(const nlohmann::json& changes, const nlohmann::json& look, const std::string& path) const;

 private:
  Scene changed(const nlohmann::json& changes, const nlohmann::json& look, int scale) const;

  nlohmann::json scene_;
  std::string dataset_;
  MetricDescription metric_;
  MeshShelf* meshes_;
  LiveLimits limits_;
};

}  // namespace nullcone::view
