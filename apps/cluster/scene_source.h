// The scene that is submitted, as a sequence.
#pragma once

#include <string>

#include "apps/cluster/folder.h"
#include "apps/trace_frames.h"

namespace nullcone::cluster {

struct SceneSource {
  WholeJson file;      ///< with all that it includes; a scene without frames has become a sequence of one
  std::string sha256;  ///< without its look

  /// Throws InputError.
  explicit SceneSource(const std::string& path);
};

/// Reads the scenes of all frames that are asked for: a mistake in the last shall not show after hours.
/// Throws InputError.
void check_scenes(const TraceFrames& frames, int shards);

/// Meshes that the scene names must lie in the folder, beside its scene: throws InputError, which names one.
void check_meshes(const SceneSource& scene, const Folder& folder);

/// Frames of another scene that may not be overwritten: throws InputError, which names one.
void refuse_strangers(const TraceFrames& frames, int threads);

/// Makes it the folder's scene, and its look the folder's look.
void adopt(const SceneSource& scene, const Folder& folder);

}  // namespace nullcone::cluster
