#include "apps/trace_run.h"

#include <filesystem>

#include "apps/stop_signals.h"
#include "apps/trace_talk.h"
#include "core/base/error.h"
#include "core/record/memory.h"
#include "metrics/registry.h"

namespace nullcone {

namespace {

/// The effort of the interrupted run, whose lines are in the writer then.
Effort go_on(const std::string& partial, DatasetWriter& writer, Resume resume, const TraceTalk& talk,
             const Note& note) {
  if (resume == Resume::no || !std::filesystem::exists(partial)) return {};
  try {
    const Effort before = resume_from(partial, writer).effort;
    talk.resumed(partial, writer.lines());
    return before;
  } catch (const InputError& error) {
    if (resume == Resume::must_fit) throw;
    if (note) note(error.what());
    return {};
  }
}

/// The bands of a scene that are not there yet.
TraceRun trace_missing(DatasetWriter& writer, const std::string& output, const Scene& scene,
                       const Tracer& tracer, Resume resume, TraceTalk& talk, const TraceOptions& options,
                       const Note& note) {
  const std::string partial = partial_path(output);
  const Effort before = go_on(partial, writer, resume, talk, note);
  auto [effort, hits] =
      trace_into(writer, tracer, scene, options.common.threads, talk.progress(), &stop_wanted);
  effort.seconds = talk.seconds();
  Effort total = effort;
  total += before;
  TraceRun out{writer.lines() == writer.manifest().lines, 0, writer.manifest().lines, effort};
  if (out.whole) {
    writer.finish(total);
    std::filesystem::remove(partial);
    talk.summary(writer.manifest(), hits, output);
  } else {
    writer.finish_partial(partial, total);
  }
  out.traced_lines = writer.manifest().traced_lines;
  return out;
}

}  // namespace

TraceRun trace_to(const std::string& output, Scene scene, const std::string& place,
                  const std::optional<Shard>& shard, Resume resume, const TraceOptions& options,
                  const Note& note) {
  const Spacetime& spacetime = find_spacetime(scene.metric, options.isa);
  check_memory(scene, bands_in_flight(options.common.threads), available_memory(), place);
  TraceTalk talk(options.common.quiet);
  const auto tracer = prepare_scene(spacetime, scene, place);
  if (note) note_doubts(*tracer, scene, place, note);
  Manifest manifest = describe(spacetime, scene, *tracer);
  if (shard) {
    const Lines lines = lines_of(*shard, manifest.height);
    manifest.first_line = lines.first;
    manifest.lines = manifest.traced_lines = lines.end - lines.first;
  }
  DatasetWriter writer(output, manifest);
  return trace_missing(writer, output, scene, *tracer, resume, talk, options, note);
}

}  // namespace nullcone
