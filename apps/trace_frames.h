// The scenes of a sequence's frames, the datasets that belong to them, and which of these are missing.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/trace_job.h"
#include "core/base/include.h"
#include "core/scene/mesh_shelf.h"
#include "core/scene/read_scene.h"
#include "core/scene/sequence.h"

namespace nullcone {

/// Why the file is not the dataset of this scene (of a shard of it), by its header alone: what is wrong, in
/// words. Empty where the header says: whole, of the same scene (the hash leaves out the look) and format.
std::string unlike(const std::string& path, const Scene& scene, const std::optional<Shard>& shard);

/// The same by every byte of the file. Empty where it is finished: it is not unlike(), and as it was written.
std::string unfinished(const std::string& path, const Scene& scene, const std::optional<Shard>& shard);

class TraceFrames {
 public:
  /// `output`: the names of whole frames, with #; `frames`: a list such as 0-249, empty for all. Throws
  /// InputError for what is no sequence, for frames that it does not have, and for a name without #.
  TraceFrames(const std::string& scene, std::string output, const std::string& frames);
  /// The same of a scene that was read from `source`.
  TraceFrames(std::string source, WholeJson scene, std::string output, const std::string& frames);

  /// Those that are asked for.
  const std::vector<int>& numbers() const { return numbers_; }
  /// So many frames the sequence has.
  int count() const { return frames_.count; }
  /// For complaints.
  std::string place(int frame) const { return source_ + " (frame " + std::to_string(frame) + ")"; }
  Scene scene(int frame) const;
  /// Whose complaints are told of the files that the scene includes.
  const WholeJson& file() const { return file_; }
  /// The whole picture of a frame.
  std::string whole_file(int frame) const;

 private:
  std::string source_, output_;
  WholeJson file_;
  Frames frames_;
  std::vector<int> numbers_;
  std::vector<MetricDescription> metrics_;
  std::unique_ptr<MeshShelf> meshes_ = std::make_unique<MeshShelf>();
};

/// What is believed of a file that is there.
enum class Check { header, everything };

/// The pieces that are not finished, ascending. With `shards` = 0 a piece is a frame, and its number the
/// frame's; else it is a shard, frame * shards + i - 1, and a finished frame counts for all of its shards.
/// `threads`: 0 for all. Nothing where `stop_wanted` came before the end.
std::optional<std::vector<std::int64_t>> missing_pieces(const TraceFrames& frames, int shards, int threads,
                                                        Check check = Check::everything);

}  // namespace nullcone
