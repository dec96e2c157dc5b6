#include "apps/trace_sequence.h"

#include <cstdio>
#include <filesystem>
#include <set>

#include "apps/stop_signals.h"
#include "apps/trace_frames.h"
#include "apps/trace_run.h"
#include "core/base/error.h"
#include "core/base/frame_numbers.h"

namespace nullcone {

namespace {

/// The name without the ending that shard_path() would give it, so that both names may be told.
std::string without_shard(std::string output, const std::string& shard) {
  if (shard.empty()) return output;
  const std::string ending = shard_path(".exr", read_shard(shard));
  if (output.size() > ending.size() && output.ends_with(ending))
    output.replace(output.size() - ending.size(), ending.size(), ".exr");
  return output;
}

TraceFrames frames_of(const TraceOptions& options) {
  if (options.scene.empty() || !options.from.empty())
    throw InputError("command line", "expected a SCENE beside --frames");
  if (options.frames.empty()) parse_frames(options.frames);  // refuses it; all frames are not meant
  return {options.scene, without_shard(options.output, options.shard), options.frames};
}

/// Tells each line once, however many frames it is true of.
class NotesOnce {
 public:
  explicit NotesOnce(bool quiet) : quiet_(quiet) {}
  /// `place`: where a line begins with that, what follows counts.
  void operator()(const std::string& line, const std::string& place = {}) {
    if (quiet_ || !told_.insert(line.starts_with(place) ? line.substr(place.size()) : line).second) return;
    std::fprintf(stderr, "%s\n", line.c_str());
  }

 private:
  bool quiet_;
  std::set<std::string> told_;
};

/// The frames that are asked for, one after the other.
class FrameTracing {
 public:
  explicit FrameTracing(const TraceOptions& options)
      : options_(options), frames_(frames_of(options)), notes_(options.common.quiet) {
    if (!options.shard.empty()) shard_ = read_shard(options.shard);
    check_before_work();
  }

  /// False when it was stopped.
  bool run() {
    for (const int frame : frames_.numbers()) {
      if (stop_wanted || !trace(frame)) return false;
    }
    return true;
  }

  void finish(bool whole) const {
    const std::size_t all = frames_.numbers().size();
    if (!whole)
      std::fprintf(stderr,
                   "%snullcone-trace: interrupted after %zu of %zu frames; the same command goes on\n",
                   options_.common.quiet ? "" : "\n", traced_ + skipped_, all);
    else if (!options_.common.quiet)
      std::fprintf(stderr, "%zu frames: %zu traced, %zu skipped, %.2f s, %.2f core-seconds\n", all, traced_,
                   skipped_, effort_.seconds, effort_.core_seconds);
  }

 private:
  std::string file(int frame) const {
    const std::string whole = frames_.whole_file(frame);
    return shard_ ? shard_path(whole, *shard_) : whole;
  }

  /// Every frame's scene and name: a mistake in the last shall not show after hours.
  void check_before_work() const {
    std::set<std::filesystem::path> folders;
    for (const int frame : frames_.numbers()) {
      const Scene scene = frames_.scene(frame);
      if (shard_) lines_of(*shard_, scene.camera.height);
      const std::string path = file(frame);
      if (folders.insert(std::filesystem::path(path).parent_path()).second ||
          std::filesystem::is_directory(path))
        check_output_name(path);
    }
  }

  /// Whether it is there already, the whole picture or the shard.
  bool finished(int frame, const Scene& scene) {
    if (options_.overwrite) return false;
    const std::string path = file(frame);
    if (shard_ && unfinished(frames_.whole_file(frame), scene, {}).empty()) return true;
    const std::string fault = unfinished(path, scene, shard_);
    if (!fault.empty() && std::filesystem::exists(path)) notes_(path + ": " + fault + "; it is traced again");
    return fault.empty();
  }

  /// False when it was stopped.
  bool trace(int frame) {
    const Scene scene = frames_.scene(frame);
    const std::string path = file(frame);
    if (finished(frame, scene)) {
      ++skipped_;
      notes_(path + ": is finished, skipped");
      return true;
    }
    const std::string place = frames_.place(frame);
    const TraceRun run = frames_.file().read([&] {
      return trace_to(path, scene, place, shard_, options_.overwrite ? Resume::no : Resume::if_it_fits,
                      options_, [&](const std::string& line) { notes_(line, place); });
    });
    effort_ += run.effort;
    if (run.whole) ++traced_;
    return run.whole;
  }

  const TraceOptions& options_;
  TraceFrames frames_;
  std::optional<Shard> shard_;
  NotesOnce notes_;
  Effort effort_;
  std::size_t traced_ = 0, skipped_ = 0;
};

}  // namespace

int trace_frames(const TraceOptions& options) {
  FrameTracing tracing(options);
  const bool whole = tracing.run();
  tracing.finish(whole);
  return whole ? 0 : 3;
}

int print_missing(const TraceOptions& options) {
  auto missing = missing_pieces(frames_of(options), options.shards, options.common.threads);
  if (!missing) return 3;
  std::printf("%s\n", runs_of(std::move(*missing)).c_str());
  return 0;
}

}  // namespace nullcone
