// nullcone-trace: from a scene to a dataset.
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>

#include "apps/scene_text.h"
#include "apps/stop_signals.h"
#include "apps/tool.h"
#include "apps/trace_job.h"
#include "core/base/error.h"
#include "core/record/memory.h"
#include "metrics/registry.h"

namespace {

using namespace nullcone;

/// Rate and time left on standard error, about five times a second.
class Talk {
 public:
  explicit Talk(bool quiet) : quiet_(quiet) {}

  Progress progress() {
    if (quiet_) return {};
    return [this](std::size_t done, std::size_t all) {
      const double now = seconds();
      double last = last_.load();
      if (now - last < 0.2 || !last_.compare_exchange_strong(last, now)) return;
      const double rate = static_cast<double>(done) / now, left = static_cast<double>(all - done) / rate;
      std::fprintf(stderr, "\r%3.0f %%, %.2f M pixels/s, %.0f s left   ",
                   100.0 * static_cast<double>(done) / static_cast<double>(all), 1e-6 * rate, left);
    };
  }
  Note notes() const {
    if (quiet_) return {};
    return [](const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); };
  }
  void resumed(const std::string& path, int lines) const {
    if (!quiet_) std::fprintf(stderr, "%s: going on after %d scan lines\n", path.c_str(), lines);
  }
  void summary(const Manifest& manifest, std::size_t hits, const std::string& path) const {
    if (quiet_) return;
    std::fprintf(stderr, "\r%s: %zu rays, %zu hits, %.2f s, %.2f core-seconds (%s)   \n", path.c_str(),
                 manifest.rays(), hits, seconds(), manifest.effort.core_seconds, manifest.isa.c_str());
    if (manifest.effort.light_doubts > 0)
      std::fprintf(
          stderr,
          "%s: note: light of a lamp may have been missed %llu times, where it winds about or is focused\n",
          path.c_str(), static_cast<unsigned long long>(manifest.effort.light_doubts));
  }
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  bool quiet_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::atomic<double> last_ = 0;
};

struct Options {
  ToolOptions common;
  std::string scene, from, output, isa, shard;
  bool resume = false;
};

/// The bands of a scene that are not there yet; the exit status.
int trace(const Options& options, const Scene& scene, const Tracer& tracer, const Manifest& manifest,
          Talk& talk) {
  const std::string partial = partial_path(options.output);
  DatasetWriter writer(options.output, manifest);
  Manifest before;
  if (options.resume && std::filesystem::exists(partial)) {
    before = resume_from(partial, writer);
    talk.resumed(partial, writer.lines());
  }
  auto [effort, hits] =
      trace_into(writer, tracer, scene, options.common.threads, talk.progress(), &stop_wanted);
  effort.seconds = talk.seconds();
  effort += before.effort;
  if (writer.lines() == manifest.lines) {
    writer.finish(effort);
    std::filesystem::remove(partial);
    talk.summary(writer.manifest(), hits, options.output);
    return 0;
  }
  writer.finish_partial(partial, effort);
  std::fprintf(stderr, "%snullcone-trace: interrupted; %s holds %d of %d scan lines, go on with --resume\n",
               options.common.quiet ? "" : "\n", partial.c_str(), writer.manifest().traced_lines,
               manifest.lines);
  return 3;
}

int work(Options& options) {
  check_output_name(options.output);
  if (options.scene.empty() == options.from.empty())
    throw InputError("command line", "expected either a SCENE or --from DATA.exr");
  const std::string& source = options.from.empty() ? options.scene : options.from;
  const std::string text = options.from.empty() ? scene_text(source) : read_manifest(source).scene;
  Scene scene = read_scene(text, source, metric_descriptions());
  const Spacetime& spacetime = find_spacetime(scene.metric, options.isa);
  const int threads = options.common.threads;
  check_memory(scene, bands_in_flight(threads), available_memory(), source);
  Talk talk(options.common.quiet);
  const auto tracer = prepare_scene(spacetime, scene, source);
  if (const Note note = talk.notes()) note_doubts(*tracer, scene, source, note);
  Manifest manifest = describe(spacetime, scene, *tracer);
  if (!options.shard.empty()) {
    const Lines lines = lines_of(read_shard(options.shard), manifest.height);
    manifest.first_line = lines.first;
    manifest.lines = manifest.traced_lines = lines.end - lines.first;
  }
  return trace(options, scene, *tracer, manifest, talk);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Traces light backwards through a scene and records what every ray meets.", "nullcone-trace");
  Options options;
  app.add_option("SCENE", options.scene, "Scene (.json), or a dataset (.exr) to trace again from its header");
  app.add_option("--from", options.from, "Dataset (.exr) to trace again from its header");
  app.add_option("-o,--output", options.output, "Dataset to write (.exr)")->required();
  app.add_option("--isa", options.isa, "Instruction set of the kernel");
  app.add_option("--shard", options.shard, "i/n: only the i-th of n runs of scan lines (see nullcone-merge)");
  app.add_flag("--resume", options.resume, "Go on where an interrupted run of the same scene stopped");
  add_common_options(app, options.common);

  catch_stop_signals();
  return run_tool(app, argc, argv, [&] { return work(options); });
}
