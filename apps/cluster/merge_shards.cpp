#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "apps/cluster/rounds.h"

namespace nullcone::cluster {

namespace {

/// Of one frame, unless some are missing.
void merge(const TraceFrames& frames, int frame, int shards) {
  const std::string whole = frames.whole_file(frame);
  std::vector<std::string> names;
  std::error_code error;
  for (int i = 1; i <= shards; ++i) {
    names.push_back(shard_path(whole, {i, shards}));
    if (!std::filesystem::exists(names.back(), error)) return;
  }
  const Scene scene = frames.scene(frame);
  if (!unfinished(whole, scene, {}).empty()) {
    std::vector<std::string> words = {program_folder() + "/nullcone-merge", "--quiet", "-o", whole};
    words.insert(words.end(), names.begin(), names.end());
    if (!run_child(words, {STDERR_FILENO, STDERR_FILENO}).good() || !unfinished(whole, scene, {}).empty())
      return;
  }
  for (const std::string& name : names) std::filesystem::remove(name, error);
}

}  // namespace

void merge_shards(const TraceFrames& frames, int shards, int threads) {
  if (shards < 2) return;
  tbb::task_arena(std::max(threads, 1)).execute([&] {
    tbb::parallel_for(std::size_t{0}, frames.numbers().size(),
                      [&](std::size_t i) { merge(frames, frames.numbers()[i], shards); });
  });
}

}  // namespace nullcone::cluster
