// The scenes of a sequence's frames, and the datasets that belong to them.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/trace_job.h"
#include "apps/trace_options.h"
#include "core/scene/read_scene.h"
#include "core/scene/sequence.h"

namespace nullcone {

/// Why the file is not the dataset of this scene (of a shard of it): what is wrong, in words. Empty where it
/// is finished: whole, verified, and of the same scene (the hash leaves out the look) and format.
std::string unfinished(const std::string& path, const Scene& scene, const std::optional<Shard>& shard);

class TraceFrames {
 public:
  /// Throws InputError for what is no sequence, for frames that it does not have, and for a name without #.
  explicit TraceFrames(const TraceOptions& options);

  const std::vector<int>& numbers() const { return numbers_; }
  /// For complaints.
  std::string place(int frame) const { return source_ + " (frame " + std::to_string(frame) + ")"; }
  Scene scene(int frame) const;
  /// The whole picture of a frame.
  std::string whole_file(int frame) const;

 private:
  std::string source_, output_;
  nlohmann::json document_;
  std::vector<int> numbers_;
  Frames frames_;
  std::vector<MetricDescription> metrics_;
};

}  // namespace nullcone
