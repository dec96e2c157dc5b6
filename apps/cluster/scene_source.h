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
  /// Notes in it which mesh files it names just now: from then on other ones are refused, and the hash covers
  /// them. Throws InputError. `frames` are of this scene.
  void pin_meshes(const TraceFrames& frames);
};

/// Reads the scenes of all frames that are asked for: a mistake in the last shall not show after hours.
/// Throws InputError.
void check_scenes(const TraceFrames& frames, int shards);

/// Frames of another scene that may not be overwritten: throws InputError, which names one.
void refuse_strangers(const TraceFrames& frames, int threads);

/// Makes it the folder's scene, and its look the folder's look; its meshes are copied to the same places
/// beside it. Throws InputError for meshes that have changed since they were pinned.
void adopt(const SceneSource& scene, const Folder& folder);

}  // namespace nullcone::cluster
