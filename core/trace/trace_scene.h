// From a scene to a dataset in memory: bands of scan lines on all threads.
#pragma once

#include <functional>

#include "core/record/dataset.h"
#include "core/trace/spacetime.h"

namespace nullcone {

/// Called now and then, from any thread, with the number of finished and of all rays.
using Progress = std::function<void(std::size_t done, std::size_t all)>;

/// Full-precision records of a whole picture, for tests; the dataset keeps floats of them.
struct TracedBand {
  std::vector<HitRecord> hits;
  std::vector<RayRecord> rays;
};

/// Chooses max_lookback where the scene leaves it open, and makes the scene ready. Throws InputError (with
/// the object's JSON pointer) for what the spacetime cannot hold.
std::unique_ptr<Tracer> prepare_scene(const Spacetime& spacetime, Scene& scene, const std::string& place);

/// Traces every band. The numbers do not depend on the number of threads (0: as many as there are cores).
std::vector<TracedBand> trace_bands(const Tracer& tracer, const Camera& camera, int threads,
                                    const Progress& progress, double& core_seconds);

/// The whole way: prepares, traces, gathers, fingerprints.
Dataset trace_scene(const Spacetime& spacetime, Scene scene, const std::string& place, int threads = 0,
                    const Progress& progress = {});

}  // namespace nullcone
