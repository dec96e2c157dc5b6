// nullcone-trace: from a scene to a dataset; or from a sequence to many.
#include <cstdio>

#include "apps/scene_file.h"
#include "apps/stop_signals.h"
#include "apps/tool.h"
#include "apps/trace_run.h"
#include "apps/trace_sequence.h"
#include "apps/trace_talk.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "metrics/registry.h"

namespace {

using namespace nullcone;

int trace_one(const TraceOptions& options) {
  check_output_name(options.output);
  if (options.scene.empty() == options.from.empty())
    throw InputError("command line", "expected either a SCENE or --from DATA.exr");
  const std::string& source = options.from.empty() ? options.scene : options.from;
  if (!options.from.empty()) read_manifest(source);  // refuses what is no dataset
  const WholeJson file = read_scene_file(source);
  std::optional<Shard> shard;
  if (!options.shard.empty()) shard = read_shard(options.shard);
  const TraceRun run = file.read([&] {
    const Scene scene = read_scene(canonical_json(file.document), source, metric_descriptions());
    return trace_to(options.output, scene, source, shard, options.resume ? Resume::must_fit : Resume::no,
                    options, TraceTalk(options.common.quiet).notes());
  });
  if (run.whole) return 0;
  std::fprintf(stderr, "%snullcone-trace: interrupted; %s holds %d of %d scan lines, go on with --resume\n",
               options.common.quiet ? "" : "\n", partial_path(options.output).c_str(), run.traced_lines,
               run.lines);
  return 3;
}

int work(const TraceOptions& options) {
  if (!options.sequence) return trace_one(options);
  return options.missing ? print_missing(options) : trace_frames(options);
}

void add_sequence_options(CLI::App& app, TraceOptions& options) {
  CLI::Option* frames = app.add_option("--frames", options.frames,
                                       "0-249, 0-249:5 or 3,7,9-12: of a sequence; #### in --output is the "
                                       "number. Frames that are finished are skipped");
  app.add_option("--frame", options.frame, "One frame of a sequence")
      ->check(CLI::Range(0, 999'999))
      ->excludes(frames);
  CLI::Option* overwrite =
      app.add_flag("--overwrite", options.overwrite, "Also the frames that are finished");
  CLI::Option* missing =
      app.add_flag("--missing", options.missing,
                   "Only list the frames that are not finished, as Slurm's --array wants them")
          ->excludes(overwrite)
          ->excludes("--shard");
  app.add_option("--shards", options.shards,
                 "With --missing: n tasks a frame; the list is of frame * n + i - 1")
      ->check(CLI::Range(1, 1'000'000))
      ->needs(missing);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Traces light backwards through a scene and records what every ray meets.", "nullcone-trace");
  TraceOptions options;
  app.add_option("SCENE", options.scene, "Scene (.json), or a dataset (.exr) to trace again from its header");
  app.add_option("--from", options.from, "Dataset (.exr) to trace again from its header");
  app.add_option("-o,--output", options.output, "Dataset to write (.exr)")->required();
  app.add_option("--isa", options.isa, "Instruction set of the kernel");
  app.add_option("--shard", options.shard, "i/n: only the i-th of n runs of scan lines (see nullcone-merge)");
  app.add_flag("--resume", options.resume, "Go on where an interrupted run of the same scene stopped");
  add_sequence_options(app, options);
  add_common_options(app, options.common);

  catch_stop_signals();
  return run_tool(app, argc, argv, [&] {
    options.sequence = app.count("--frames") + app.count("--frame") > 0;
    if (app.count("--frame") > 0) options.frames = std::to_string(options.frame);
    if (!options.sequence && (options.overwrite || options.missing))
      throw InputError(options.missing ? "--missing" : "--overwrite", "expected --frames");
    return work(options);
  });
}
