// From a scene to records: bands of scan lines on all threads.
#pragma once

#include <atomic>
#include <functional>
#include <memory>

#include "core/record/dataset.h"
#include "core/trace/spacetime.h"

namespace nullcone {

/// Called with the number of finished and of all pixels after each band, in order, by one thread at a time.
/// What it throws ends the tracing.
using Progress = std::function<void(std::size_t done, std::size_t all)>;

/// Called with a line for every doubt about the scene that does not hinder tracing.
using Note = std::function<void(const std::string&)>;

/// Records of a band in full precision; the dataset keeps floats of them.
struct TracedBand {
  std::vector<HitRecord> hits;
  std::vector<HitDetail> details;  ///< one a hit, where the scene asks for any
  std::vector<HitLight> lights;    ///< of each hit the paths of all lamps, lamp by lamp
  std::vector<RayRecord> rays;
};

/// Chooses max_lookback where the scene leaves it open, and makes the scene ready; the tracer's pixels are
/// the samples of the camera. The scene must outlive the tracer. Throws InputError (with the JSON pointer)
/// for what the spacetime cannot hold.
std::unique_ptr<Tracer> prepare_scene(const Spacetime& spacetime, Scene& scene, const std::string& place);

/// Tells of objects that are not small against the curvature, and of lamps that objects shut in.
void note_doubts(const Tracer& tracer, const Scene& scene, const std::string& place, const Note& note);

/// The oldest version of the file format that holds what the scene asks for.
int format_of(const Scene& scene);

/// What a dataset of the whole picture says of itself before it is traced.
Manifest describe(const Spacetime& spacetime, const Scene& scene, const Tracer& tracer);

/// Refuses what would not fit into so many bytes: better now than after hours. `bands`: how many are held at
/// a time if every ray hits something; all for a whole dataset. Throws InputError.
void check_memory(const Scene& scene, int bands, std::uint64_t available, const std::string& place);

/// Bands that are held at a time when `threads` threads trace (0: as many as there are cores).
int bands_in_flight(int threads);

/// Crossings in vectors, of bands traced one after the other.
class Gathering final : public HitSink {
 public:
  /// The pixels of the next lines count from here.
  std::uint32_t first_pixel = 0;
  bool with_details = false;
  std::size_t light_paths = 0;  ///< of all lamps
  std::vector<HitRecord> hits;
  std::vector<HitDetail> details;  ///< one a hit, or none
  std::vector<HitLight> lights;    ///< light_paths a hit

  HitRoom extend(std::size_t count) override;
  void keep(std::size_t count) override;

 private:
  void resize(std::size_t count);

  std::size_t kept_ = 0;
};

/// Scan lines of the picture, whole bands but for the last.
struct Lines {
  int first, end;
};

/// Set from outside (by a signal, say) to stop: bands in flight are finished, no more are begun.
using StopFlag = std::atomic<bool>;

/// Traces bands on `threads` threads and hands them over in order, one at a time. The numbers do not depend
/// on the number of threads. Returns the processor time used.
double trace_bands(const Tracer& tracer, const Scene& scene, Lines lines, int threads,
                   const Progress& progress, const std::function<void(Band&&)>& take,
                   const StopFlag* stop = nullptr);

/// The same for tests, in full precision, of the whole picture; hits are counted in samples.
std::vector<TracedBand> trace_exactly(const Tracer& tracer, const Scene& scene, int threads = 0);

/// The whole way in memory: prepares, traces, gathers, fingerprints.
Dataset trace_scene(const Spacetime& spacetime, Scene scene, const std::string& place, int threads = 0,
                    const Progress& progress = {}, const Note& note = {});

}  // namespace nullcone
