#include "apps/trace_frames.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <filesystem>

#include "apps/scene_file.h"
#include "apps/stop_signals.h"
#include "core/base/error.h"
#include "core/base/frame_numbers.h"
#include "core/base/json.h"
#include "core/trace/trace_scene.h"
#include "metrics/registry.h"

namespace nullcone {

std::string unlike(const std::string& path, const Scene& scene, const std::optional<Shard>& shard) {
  const int height = scene.camera.height;
  const Lines lines = shard ? lines_of(*shard, height) : Lines{0, height};
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return "is not there";
  try {
    const Manifest found = read_manifest(path);
    if (found.scene_sha256 != scene.sha256) return "is of another scene";
    if (found.format != format_of(scene)) return "is of another format";
    if (found.first_line != lines.first || found.lines != lines.end - lines.first || found.partial())
      return "does not hold all scan lines";
    return {};
  } catch (const InputError&) {
    return "cannot be read as a dataset";
  }
}

std::string unfinished(const std::string& path, const Scene& scene, const std::optional<Shard>& shard) {
  if (std::string fault = unlike(path, scene, shard); !fault.empty()) return fault;
  try {
    if (is_intact(path).value_or(false)) return "";  // else let it be told what is wrong
    const std::vector<std::string> faults = verify_file(path);
    return faults.empty() ? "" : faults.front();
  } catch (const InputError&) {
    return "cannot be read as a dataset";
  }
}

TraceFrames::TraceFrames(const std::string& scene, std::string output, const std::string& frames)
    : TraceFrames(scene, read_scene_file(scene), std::move(output), frames) {}

TraceFrames::TraceFrames(std::string source, WholeJson scene, std::string output, const std::string& frames)
    : source_(std::move(source)),
      output_(std::move(output)),
      file_(std::move(scene)),
      metrics_(metric_descriptions()) {
  if (output_.size() <= 4 || !output_.ends_with(".exr"))
    throw InputError(output_, "expected a name that ends in .exr");
  if (!is_sequence(file_.document))
    throw InputError(source_, "is no sequence; expected \"frames\" in the scene");
  frames_ = file_.read([&] { return read_frames(file_.document, source_); });
  numbers_ = parse_frames(frames.empty() ? "0-" + std::to_string(frames_.count - 1) : frames);
  for (const int frame : numbers_)
    if (frame >= frames_.count)
      throw InputError("--frames", "there is no frame " + std::to_string(frame) + "; expected 0 to " +
                                       std::to_string(frames_.count - 1));
  if (numbers_.size() > 1 && !has_number(output_))
    throw InputError("--output", "expected #### in the name, for the frame's number");
}

Scene TraceFrames::scene(int frame) const {
  const std::string where = place(frame);
  return file_.read([&] {
    return read_scene(canonical_json(scene_at(file_.document, frames_, frame, source_)), where, metrics_,
                      meshes_.get());
  });
}

std::string TraceFrames::whole_file(int frame) const { return numbered(output_, frame, "--output"); }

namespace {

/// work(0) to work(count - 1), each a task of its own: they take long, and some much longer than others.
template <class Work>
void in_parallel(std::size_t count, const Work& work) {
  tbb::parallel_for(std::size_t{0}, count, work, tbb::simple_partitioner());
}

/// Of each piece of a frame whether it lacks; of none where the frame is finished as a whole.
std::vector<char> lacking(const TraceFrames& frames, int frame, int shards, Check check) {
  const auto fault = check == Check::everything ? unfinished : unlike;
  const Scene scene = frames.scene(frame);
  const std::string whole = frames.whole_file(frame);
  if (fault(whole, scene, {}).empty()) return {};
  if (shards == 0) return {true};
  std::vector<char> out(static_cast<std::size_t>(shards));
  in_parallel(out.size(), [&](std::size_t i) {
    const Shard shard{static_cast<int>(i) + 1, shards};
    out[i] = !stop_wanted && !fault(shard_path(whole, shard), scene, shard).empty();
  });
  return out;
}

}  // namespace

std::optional<std::vector<std::int64_t>> missing_pieces(const TraceFrames& frames, int shards, int threads,
                                                        Check check) {
  // More threads than cores may help: they wait for disks.
  std::optional<tbb::global_control> limit;
  if (threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  const std::vector<int>& numbers = frames.numbers();
  std::vector<std::vector<char>> lacks(numbers.size());
  tbb::task_arena(threads > 0 ? threads : tbb::task_arena::automatic).execute([&] {
    in_parallel(numbers.size(), [&](std::size_t i) {
      if (!stop_wanted) lacks[i] = lacking(frames, numbers[i], shards, check);
    });
  });
  if (stop_wanted) return std::nullopt;
  std::vector<std::int64_t> out;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    for (std::size_t k = 0; k < lacks[i].size(); ++k)
      if (lacks[i][k])
        out.push_back(std::int64_t{numbers[i]} * std::max(1, shards) + static_cast<std::int64_t>(k));
  std::ranges::sort(out);
  return out;
}

}  // namespace nullcone
