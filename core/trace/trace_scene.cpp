#include "core/trace/trace_scene.h"

#include <tbb/global_control.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/handover.h"
#include "core/record/memory.h"
#include "core/trace/course.h"
#include "core/trace/follow.h"
#include "core/trace/gather.h"

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

/// Counts all times from the observation: far from t = 0, times would lose the digits of their differences.
void count_from_observation(Scene& scene) {
  const double now = std::exchange(scene.observer.event[0], 0.0);
  for (Object& object : scene.objects) object.placing.worldline.event[0] -= now;
  for (Lamp& lamp : scene.lights.lamps) lamp.placing.worldline.event[0] -= now;
}

char pipelines = 0;  ///< what whoever begins one has done before, all its stages know

/// Traces every band on `threads` threads: what `trace_one` makes of a band's first line `take` gets, in
/// order, one at a time. Only a few bands are in flight at once, each in the place of one that is finished,
/// so memory is bounded by what `take` keeps. Returns the processor time used. What `take` or `progress`
/// throws ends it.
template <class Trace, class Take>
double for_each_band(const Camera& camera, Lines lines, int threads, const Progress& progress,
                     const StopFlag* stop, const Trace& trace_one, const Take& take) {
  std::optional<tbb::global_control> limit;
  if (threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  std::atomic<long> nanoseconds = 0;
  int next_line = lines.first, done_lines = lines.first;
  std::vector<std::optional<decltype(trace_one(0))>> kept(static_cast<std::size_t>(bands_in_flight(threads)));
  const auto place_of = [&](int line) -> auto& {
    return kept[static_cast<std::size_t>((line - lines.first) / kBandLines) % kept.size()];
  };
  const auto next = [&](tbb::flow_control& flow) {
    take_over(&pipelines), take_over(&next_line);
    if (next_line >= lines.end || (stop && *stop)) flow.stop();
    const int line = std::exchange(next_line, next_line + kBandLines);
    hand_over(&next_line);
    return line;
  };
  const auto trace = [&](int line) {
    take_over(&pipelines);
    auto& place = place_of(line);
    take_over(&place);
    const double start = thread_seconds();
    place.emplace(trace_one(line));
    nanoseconds += static_cast<long>(1e9 * (thread_seconds() - start));
    hand_over(&place);
    return line;
  };
  const auto finish = [&](int line) {
    take_over(&pipelines), take_over(&done_lines);
    auto& place = place_of(line);
    take_over(&place);
    take(std::move(*place));
    place.reset();
    done_lines = std::min(done_lines + kBandLines, lines.end);
    const auto width = static_cast<std::size_t>(camera.width);
    if (progress)
      progress(width * static_cast<std::size_t>(done_lines - lines.first),
               width * static_cast<std::size_t>(lines.end - lines.first));
    hand_over(&place), hand_over(&done_lines);
  };
  using tbb::filter_mode, tbb::make_filter;
  hand_over(&pipelines);
  tbb::parallel_pipeline(kept.size(),
                         make_filter<void, int>(filter_mode::serial_in_order, unwatched(next)) &
                             make_filter<int, int>(filter_mode::parallel, unwatched(trace)) &
                             make_filter<int, void>(filter_mode::serial_in_order, unwatched(finish)));
  take_over(&next_line), take_over(&done_lines);
  return 1e-9 * static_cast<double>(nanoseconds.load());
}

/// Tells of objects that are not small against the curvature.
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

/// Tells of lamps that objects shut in.
void note_hidden_lamps(const Tracer& tracer, const Scene& scene, const std::string& place, const Note& note) {
  for (std::size_t i = 0; i < scene.lights.lamps.size(); ++i) {
    const std::uint32_t about = tracer.object_about_lamp(i);
    if (about == 0) continue;
    const std::string& object = scene.objects[about - 1].name;
    note(place + ": /lights/lamps/" + std::to_string(i) + ": note: the lamp is inside of '" + object +
         "', which shuts its light in; if it belongs to the lamp, say \"body\": \"" + object + "\"");
  }
}

}  // namespace

void note_doubts(const Tracer& tracer, const Scene& scene, const std::string& place, const Note& note) {
  note_distortions(tracer, scene, place, note);
  note_hidden_lamps(tracer, scene, place, note);
}

int bands_in_flight(int threads) {
  return 2 * (threads > 0 ? threads : tbb::this_task_arena::max_concurrency());
}

std::unique_ptr<Tracer> prepare_scene(const Spacetime& spacetime, Scene& scene, const std::string& place) {
  const std::vector<double> parameters = parameters_of(spacetime, scene);
  settle_observer(spacetime, parameters, scene, place);
  if (scene.max_lookback == 0) scene.max_lookback = spacetime.default_lookback(parameters);
  settle_objects(spacetime, parameters, scene, place);
  Scene sampled = scene;
  sampled.camera = sample_camera(scene.camera);
  if (spacetime.description().stationary) count_from_observation(sampled);
  Unfit unfit{};
  auto tracer = spacetime.prepare(parameters, sampled, unfit);
  if (tracer) return tracer;
  if (unfit.thing == Unfit::Thing::observer) throw InputError(place + ": /observer", unfit.reason);
  const bool lamp = unfit.thing == Unfit::Thing::lamp;
  std::string message = "'" +
                        (lamp ? scene.lights.lamps[unfit.number].name : scene.objects[unfit.number].name) +
                        "' " + unfit.reason;
  if (unfit.limit > 0) message += "; expected a radius below about " + std::to_string(unfit.limit);
  throw InputError(place + (lamp ? ": /lights/lamps/" : ": /objects/") + std::to_string(unfit.number),
                   message);
}

void check_memory(const Scene& scene, int bands, std::uint64_t available, const std::string& place) {
  const Camera& camera = scene.camera;
  const auto lines = std::min<std::int64_t>(camera.height, std::int64_t{kBandLines} * bands);
  const std::uint64_t pixels = static_cast<std::uint64_t>(camera.width) * static_cast<std::uint64_t>(lines);
  const auto side = static_cast<std::uint64_t>(camera.samples), samples = side * side;
  const std::uint64_t needed =
      dataset_bytes(pixels, samples, scene.records.channels, scene.lights.all_paths());
  if (needed <= available) return;
  const auto gibibytes = [](std::uint64_t bytes) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.2f GiB", std::ldexp(static_cast<double>(bytes), -30));
    return std::string(text.data());
  };
  throw InputError(place + ": /camera/resolution", "tracing would take up to " + gibibytes(needed) +
                                                       " of memory, but only " + gibibytes(available) +
                                                       " are available; expected fewer pixels");
}

double trace_bands(const Tracer& tracer, const Scene& scene, Lines lines, int threads,
                   const Progress& progress, const std::function<void(Band&&)>& take, const StopFlag* stop) {
  const bool with_details = (scene.records.channels & kDetailChannels).bits != 0;
  return for_each_band(
      scene.camera, lines, threads, progress, stop,
      [&](int line) { return gather(trace_band(tracer, scene, with_details, line), scene); }, take);
}

std::vector<TracedBand> trace_exactly(const Tracer& tracer, const Scene& scene, int threads) {
  std::vector<TracedBand> out;
  for_each_band(
      scene.camera, {0, scene.camera.height}, threads, {}, nullptr,
      [&](int line) { return trace_band(tracer, scene, true, line); },
      [&](TracedBand&& band) { out.push_back(std::move(band)); });
  return out;
}

Dataset trace_scene(const Spacetime& spacetime, Scene scene, const std::string& place, int threads,
                    const Progress& progress, const Note& note) {
  const int all = (scene.camera.height + kBandLines - 1) / kBandLines;
  check_memory(scene, all, available_memory(), place);
  const auto tracer = prepare_scene(spacetime, scene, place);
  if (note) note_doubts(*tracer, scene, place, note);
  Dataset dataset;
  dataset.manifest = describe(spacetime, scene, *tracer);
  dataset.hits = empty_hits(dataset.manifest);
  dataset.manifest.effort.core_seconds =
      trace_bands(*tracer, scene, {0, scene.camera.height}, threads, progress,
                  [&](const Band& band) { dataset.append(band); });
  dataset.manifest.effort.light_doubts = tracer->light_doubts();
  fingerprint(dataset);
  return dataset;
}

}  // namespace nullcone
