#include "core/trace/trace_scene.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <ctime>
#include <optional>

#include "core/base/error.h"
#include "core/base/version.h"

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

/// Appends a band to the columns, in floats.
void gather(const TracedBand& band, Hits& hits, Rays& rays) {
  const auto to_float = [](double x) { return static_cast<float>(x); };
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
    rays.status.push_back(ray.status);
    rays.steps.push_back(ray.steps);
    rays.error.push_back(ray.error);
    rays.drift.push_back(ray.drift);
  }
}

}  // namespace

std::unique_ptr<Tracer> prepare_scene(const Spacetime& spacetime, Scene& scene, const std::string& place) {
  const std::vector<double> parameters = parameters_of(spacetime, scene);
  if (scene.max_lookback == 0) scene.max_lookback = spacetime.default_lookback(parameters);
  Unfit unfit{};
  auto tracer = spacetime.prepare(parameters, scene, unfit);
  if (tracer) return tracer;
  std::string message = "'" + scene.objects[unfit.object].name + "' " + unfit.reason;
  if (unfit.limit > 0) message += "; expected a radius below about " + std::to_string(unfit.limit);
  throw InputError(place + ": /objects/" + std::to_string(unfit.object), message);
}

std::vector<TracedBand> trace_bands(const Tracer& tracer, const Camera& camera, int threads,
                                    const Progress& progress, double& core_seconds) {
  const int bands = (camera.height + kBandLines - 1) / kBandLines;
  const auto width = static_cast<std::size_t>(camera.width), height = static_cast<std::size_t>(camera.height);
  std::vector<TracedBand> out(static_cast<std::size_t>(bands));
  std::atomic<std::size_t> done = 0;
  std::atomic<long> nanoseconds = 0;
  const auto trace_one = [&](int band) {
    const double start = thread_seconds();
    const int first = band * kBandLines, lines = std::min(kBandLines, camera.height - first);
    TracedBand& result = out[static_cast<std::size_t>(band)];
    const std::size_t pixels = width * static_cast<std::size_t>(lines);
    result.hits.resize(pixels);
    result.rays.resize(pixels);
    result.hits.resize(tracer.trace_band(first, lines, {result.hits, result.rays}));
    result.hits.shrink_to_fit();
    nanoseconds += static_cast<long>(1e9 * (thread_seconds() - start));
    const std::size_t now = done += pixels;
    if (progress) progress(now, width * height);
  };
  std::optional<tbb::global_control> limit;
  if (threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::parallel_for(0, bands, trace_one);
  core_seconds = 1e-9 * static_cast<double>(nanoseconds.load());
  return out;
}

Dataset trace_scene(const Spacetime& spacetime, Scene scene, const std::string& place, int threads,
                    const Progress& progress) {
  const auto tracer = prepare_scene(spacetime, scene, place);
  Dataset dataset;
  Manifest& manifest = dataset.manifest;
  for (const TracedBand& band : trace_bands(*tracer, scene.camera, threads, progress, manifest.core_seconds))
    gather(band, dataset.hits, dataset.rays);
  manifest.width = scene.camera.width;
  manifest.height = scene.camera.height;
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
