// nullcone-trace: from a scene to a dataset.
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>

#include "apps/preview.h"
#include "apps/scene_text.h"
#include "apps/tool.h"
#include "core/base/error.h"
#include "core/trace/trace_scene.h"
#include "metrics/registry.h"

namespace {

using namespace nullcone;

/// Set by SIGINT and SIGTERM: tracing then ends after the bands in flight, and nothing is left behind. What
/// is already being written is finished. A second signal ends the program at once.
std::atomic<bool> stop_wanted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

void stop_when_asked() {
  struct sigaction action {};
  action.sa_handler = [](int) { stop_wanted = true; };
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  for (const int number : {SIGINT, SIGTERM}) {
    struct sigaction before {};
    sigaction(number, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);  // ignored under nohup, say
  }
}

/// Rate and time left on standard error, about five times a second.
class Talk {
 public:
  explicit Talk(bool quiet) : quiet_(quiet) {}

  Progress progress() {
    return [this](std::size_t done, std::size_t all) {
      if (stop_wanted) throw Interrupted();
      if (quiet_) return;
      const double now = seconds();
      double last = last_.load();
      if (now - last < 0.2 || !last_.compare_exchange_strong(last, now)) return;
      const double rate = static_cast<double>(done) / now, left = static_cast<double>(all - done) / rate;
      std::fprintf(stderr, "\r%3.0f %%, %.2f M rays/s, %.0f s left   ",
                   100.0 * static_cast<double>(done) / static_cast<double>(all), 1e-6 * rate, left);
    };
  }
  Note notes() const {
    if (quiet_) return {};
    return [](const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); };
  }
  void summary(const Dataset& dataset, const std::string& path) const {
    if (quiet_) return;
    std::fprintf(stderr, "\r%s: %zu rays, %zu hits, %.2f s, %.2f core-seconds (%s)   \n", path.c_str(),
                 dataset.pixels(), dataset.hits.count(), seconds(), dataset.manifest.core_seconds,
                 dataset.manifest.isa.c_str());
  }

 private:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  bool quiet_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::atomic<double> last_ = 0;
};

/// Fails before the work, not after it, where nothing can be written; removes what killed runs left there.
void check_writable(const std::string& path) {
  const bool fits = path.size() > 4 && path.ends_with(".exr");
  if (!fits) throw InputError(path, "expected a name that ends in .exr");
  if (std::filesystem::is_directory(path)) throw InputError(path, "is a folder; expected the name of a file");
  check_place(path);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Traces light backwards through a scene and records what every ray meets.", "nullcone-trace");
  std::string scene_path, output, isa;
  ToolOptions options;
  app.add_option("SCENE", scene_path, "Scene (.json), or a dataset (.exr) to trace again from its header")
      ->required();
  app.add_option("-o,--output", output, "Dataset to write (.exr)")->required();
  app.add_option("--isa", isa, "Instruction set of the kernel");
  add_common_options(app, options);

  stop_when_asked();
  return run_tool(app, argc, argv, [&] {
    check_writable(output);
    const auto metrics = metric_descriptions();
    const Scene scene = read_scene(scene_text(scene_path), scene_path, metrics);
    const Spacetime& spacetime = find_spacetime(scene.metric, isa);
    Talk talk(options.quiet);
    try {
      const Dataset dataset =
          trace_scene(spacetime, scene, scene_path, options.threads, talk.progress(), talk.notes());
      write_dataset(output, dataset, make_preview(dataset));
      talk.summary(dataset, output);
    } catch (const Interrupted&) {
      std::fprintf(stderr, "%snullcone-trace: interrupted, nothing is written\n", options.quiet ? "" : "\n");
      return 3;
    }
    return 0;
  });
}
