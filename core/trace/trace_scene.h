// From a scene to a dataset in memory: bands of scan lines on all threads.
#pragma once

#include <functional>
#include <stdexcept>

#include "core/record/dataset.h"
#include "core/trace/spacetime.h"

namespace nullcone {

/// Called with the number of finished and of all rays after each band, in order, by one thread at a time.
/// What it throws ends the tracing.
using Progress = std::function<void(std::size_t done, std::size_t all)>;

/// What a Progress may throw when somebody asked to stop.
struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Full-precision records of a whole picture, for tests; the dataset keeps floats of them.
struct TracedBand {
  std::vector<HitRecord> hits;
  std::vector<RayRecord> rays;
};

/// Chooses max_lookback where the scene leaves it open, and makes the scene ready. Throws InputError (with
/// the JSON pointer) for what the spacetime or the memory cannot hold.
std::unique_ptr<Tracer> prepare_scene(const Spacetime& spacetime, Scene& scene, const std::string& place);

/// Refuses a picture whose dataset would not fit into so many bytes if every pixel were hit: better now than
/// after hours. Throws InputError.
void check_memory(const Camera& camera, std::uint64_t available, const std::string& place);

/// Traces every band. The numbers do not depend on the number of threads (0: as many as there are cores).
std::vector<TracedBand> trace_bands(const Tracer& tracer, const Camera& camera, int threads,
                                    const Progress& progress, double& core_seconds);

/// Called with a line for every doubt about the scene that does not hinder tracing.
using Note = std::function<void(const std::string&)>;

/// The whole way: prepares, traces, gathers, fingerprints.
Dataset trace_scene(const Spacetime& spacetime, Scene scene, const std::string& place, int threads = 0,
                    const Progress& progress = {}, const Note& note = {});

}  // namespace nullcone
