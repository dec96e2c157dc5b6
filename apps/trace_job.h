// One run of nullcone-trace: what shall be traced, where it goes, and how an interrupted run goes on.
#pragma once

#include <string>

#include "core/record/dataset_file.h"
#include "core/trace/trace_scene.h"

namespace nullcone {

/// Fails before the work, not after it, where no dataset can be written; removes what killed runs left there.
/// Throws InputError and WorkError.
void check_output_name(const std::string& path);

/// One of `count` equal runs of bands, counted from 1.
struct Shard {
  int number = 1, count = 1;
};
/// From "i/n". Throws InputError.
Shard read_shard(const std::string& text);
/// Its scan lines of a picture. Throws InputError where there are fewer bands than shards.
Lines lines_of(const Shard& shard, int height);

/// NAME.shard-i-of-n.exr beside NAME.exr.
std::string shard_path(const std::string& output, const Shard& shard);

/// Where an interrupted run leaves what it has: NAME.partial.exr beside NAME.exr.
std::string partial_path(const std::string& output);

/// Puts the lines that an interrupted run of the same scene and window has traced into the writer. Throws
/// InputError for a file of another scene, window or version, or one that is damaged. Returns that run's
/// manifest.
Manifest resume_from(const std::string& path, DatasetWriter& writer);

struct Traced {
  Effort effort;  ///< without the time from start to end, which began before
  std::size_t hits = 0;
};
/// Traces the scan lines that the writer still lacks into it, or fewer after `stop`.
Traced trace_into(DatasetWriter& writer, const Tracer& tracer, const Scene& scene, int threads,
                  const Progress& progress, const StopFlag* stop = nullptr);

/// Why two datasets are not of the same picture, as "A instead of B"; empty if they are.
std::string difference(const Manifest& a, const Manifest& b);

}  // namespace nullcone
