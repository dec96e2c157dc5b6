#include "core/trace/trace_scene.h"

#include <tbb/global_control.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/version.h"
#include "core/record/memory.h"

namespace nullcone {

namespace {

std::vector<double> parameters_of(const Spacetime& spacetime, const Scene& scene) {
  std::vector<double> out;
  for (const MetricParameter& parameter : spacetime.description().parameters)
    out.push_back(scene.metric_parameters.at(std::string(parameter.name)));
  return out;
}

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

/// What a dataset keeps of a band.
struct BandColumns {
  Hits hits;
  Rays rays;
};

BandColumns to_columns(const TracedBand& band) {
  const auto to_float = [](double x) { return static_cast<float>(x); };
  BandColumns out;
  Hits& hits = out.hits;
  for_each_channel(hits, kHitChannels, [&](const auto&, auto& column) { column.reserve(band.hits.size()); });
  std::size_t next = 0;
  for (std::size_t pixel = 0; pixel < band.rays.size(); ++pixel) {
    for (; next < band.hits.size() && band.hits[next].pixel == pixel; ++next) {
      const HitRecord& hit = band.hits[next];
      hits.Z.push_back(to_float(hit.Z));
      hits.A.push_back(1.0F);
      hits.id.push_back(hit.id);
      hits.order.push_back(hit.order);
      hits.u.push_back(to_float(hit.u));
      hits.v.push_back(to_float(hit.v));
      hits.shift.push_back(to_float(hit.shift));
      hits.t.push_back(to_float(hit.t));
      hits.tau.push_back(to_float(hit.tau));
      hits.mu.push_back(to_float(hit.mu));
    }
    hits.offset.push_back(hits.Z.size());
    const RayRecord& ray = band.rays[pixel];
    out.rays.status.push_back(ray.status);
    out.rays.steps.push_back(ray.steps);
    out.rays.error.push_back(ray.error);
    out.rays.drift.push_back(ray.drift);
  }
  return out;
}

/// Room for one crossing a pixel. Pages that are never touched cost nothing.
void reserve(Dataset& dataset) {
  dataset.hits.offset.reserve(dataset.pixels() + 1);
  for_each_channel(dataset.hits, kHitChannels,
                   [&](const auto&, auto& column) { column.reserve(dataset.pixels()); });
  for_each_channel(dataset.rays, kRayChannels,
                   [&](const auto&, auto& column) { column.reserve(dataset.pixels()); });
}

template <class Table, class Channels>
void append(Table& to, const Table& from, const Channels& channels) {
  for_each_channel(to, channels, [&](const auto& channel, auto& column) {
    const auto& more = from.*channel.column;
    column.insert(column.end(), more.begin(), more.end());
  });
}

void append(Dataset& dataset, const BandColumns& band) {
  const std::size_t before = dataset.hits.count();
  for (std::size_t i = 1; i < band.hits.offset.size(); ++i)
    dataset.hits.offset.push_back(before + band.hits.offset[i]);
  append(dataset.hits, band.hits, kHitChannels);
  append(dataset.rays, band.rays, kRayChannels);
}

TracedBand trace_one(const Tracer& tracer, const Camera& camera, int first_line) {
  const int lines = std::min(kBandLines, camera.height - first_line);
  const std::size_t pixels = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(lines);
  TracedBand out{std::vector<HitRecord>(pixels), std::vector<RayRecord>(pixels)};
  out.hits.resize(tracer.trace_band(first_line, lines, {out.hits, out.rays}));
  return out;
}

/// Takes bands in order, one at a time, and tells how far it has come. What is thrown is kept until the
/// pipeline is empty: what is in flight when an exception crosses a pipeline of TBB is never freed.
struct BandCounter {
  const Camera& camera;
  const Progress& progress;
  int next_line = 0, done_lines = 0;
  std::atomic<bool> stopped = false;
  std::exception_ptr failure = nullptr;

  template <class Take>
  void take_next(const Take& take) {
    if (stopped) return;
    try {
      take();
      done_lines = std::min(done_lines + kBandLines, camera.height);
      const auto width = static_cast<std::size_t>(camera.width);
      if (progress)
        progress(width * static_cast<std::size_t>(done_lines),
                 width * static_cast<std::size_t>(camera.height));
    } catch (...) {
      failure = std::current_exception();
      stopped = true;
    }
  }
};

/// Traces every band on `threads` threads. `convert` makes of each what shall be kept of it, in the thread
/// that traced it; `take` gets these in order, one at a time. Only a few bands are in flight at once, so
/// memory is bounded by what `take` keeps. Returns the processor time used.
template <class Convert, class Take>
double for_each_band(const Tracer& tracer, const Camera& camera, int threads, const Progress& progress,
                     const Convert& convert, const Take& take) {
  std::optional<tbb::global_control> limit;
  if (threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  const auto in_flight = 2 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  std::atomic<long> nanoseconds = 0;
  BandCounter counter{camera, progress};
  const auto next = [&](tbb::flow_control& flow) {
    if (counter.stopped || counter.next_line >= camera.height) flow.stop();
    return std::exchange(counter.next_line, counter.next_line + kBandLines);
  };
  using Kept = std::shared_ptr<decltype(convert(TracedBand{}))>;
  const auto trace = [&](int first_line) -> Kept {
    if (counter.stopped) return {};
    const double start = thread_seconds();
    auto kept = std::make_shared<typename Kept::element_type>(convert(trace_one(tracer, camera, first_line)));
    nanoseconds += static_cast<long>(1e9 * (thread_seconds() - start));
    return kept;
  };
  const auto finish = [&](const Kept& kept) { counter.take_next([&] { take(std::move(*kept)); }); };
  using tbb::filter_mode, tbb::make_filter;
  tbb::parallel_pipeline(in_flight, make_filter<void, int>(filter_mode::serial_in_order, next) &
                                        make_filter<int, Kept>(filter_mode::parallel, trace) &
                                        make_filter<Kept, void>(filter_mode::serial_in_order, finish));
  if (counter.failure) std::rethrow_exception(counter.failure);
  return 1e-9 * static_cast<double>(nanoseconds.load());
}

void note_distortions(const Tracer& tracer, const Scene& scene, const std::string& place, const Note& note) {
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const double percent = 100 * tracer.distortion(i);
    if (!(percent > 1)) continue;
    std::array<char, 24> text{};
    std::snprintf(text.data(), text.size(), "%.1f %%", percent);
    note(place + ": /objects/" + std::to_string(i) + ": note: '" + scene.objects[i].name +
         "' is not small against the curvature: lengths in its frame are off by up to " + text.data());
  }
}

}  // namespace

std::unique_ptr<Tracer> prepare_scene(const Spacetime& spacetime, Scene& scene, const std::string& place) {
  check_memory(scene.camera, available_memory(), place);
  const std::vector<double> parameters = parameters_of(spacetime, scene);
  if (scene.max_lookback == 0) scene.max_lookback = spacetime.default_lookback(parameters);
  Unfit unfit{};
  auto tracer = spacetime.prepare(parameters, scene, unfit);
  if (tracer) return tracer;
  if (unfit.object == Unfit::kObserver) throw InputError(place + ": /observer", unfit.reason);
  std::string message = "'" + scene.objects[unfit.object].name + "' " + unfit.reason;
  if (unfit.limit > 0) message += "; expected a radius below about " + std::to_string(unfit.limit);
  throw InputError(place + ": /objects/" + std::to_string(unfit.object), message);
}

void check_memory(const Camera& camera, std::uint64_t available, const std::string& place) {
  const std::uint64_t needed =
      dataset_bytes(static_cast<std::uint64_t>(camera.width) * static_cast<std::uint64_t>(camera.height), 1);
  if (needed <= available) return;
  const auto gibibytes = [](std::uint64_t bytes) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.2f GiB", std::ldexp(static_cast<double>(bytes), -30));
    return std::string(text.data());
  };
  throw InputError(place + ": /camera/resolution", "the dataset would take up to " + gibibytes(needed) +
                                                       " of memory, but only " + gibibytes(available) +
                                                       " are available; expected fewer pixels");
}

std::vector<TracedBand> trace_bands(const Tracer& tracer, const Camera& camera, int threads,
                                    const Progress& progress, double& core_seconds) {
  std::vector<TracedBand> out;
  core_seconds = for_each_band(
      tracer, camera, threads, progress,
      [](TracedBand&& band) {
        band.hits.shrink_to_fit();
        return std::move(band);
      },
      [&](TracedBand&& band) { out.push_back(std::move(band)); });
  return out;
}

Dataset trace_scene(const Spacetime& spacetime, Scene scene, const std::string& place, int threads,
                    const Progress& progress, const Note& note) {
  const auto tracer = prepare_scene(spacetime, scene, place);
  if (note) note_distortions(*tracer, scene, place, note);
  Dataset dataset;
  Manifest& manifest = dataset.manifest;
  manifest.width = scene.camera.width;
  manifest.height = scene.camera.height;
  reserve(dataset);
  manifest.core_seconds = for_each_band(*tracer, scene.camera, threads, progress, to_columns,
                                        [&](const BandColumns& band) { append(dataset, band); });
  manifest.scene = scene.canonical;
  manifest.scene_sha256 = scene.sha256;
  manifest.metric = scene.metric;
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    manifest.objects.push_back({scene.objects[i].name, tracer->tau_origin(i)});
  manifest.version = code_version();
  manifest.isa = spacetime.isa();
  manifest.host = host_name();
  manifest.hits_sha256 = payload_sha256(dataset.hits);
  manifest.rays_sha256 = payload_sha256(dataset.rays);
  return dataset;
}

}  // namespace nullcone
