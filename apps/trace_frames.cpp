#include "apps/trace_frames.h"

#include <filesystem>

#include "apps/scene_text.h"
#include "core/base/error.h"
#include "core/base/frame_numbers.h"
#include "core/base/json.h"
#include "metrics/registry.h"

namespace nullcone {

namespace {

/// The least that holds the scene.
int format_of(const Scene& scene) {
  Manifest out;
  out.set_lights(std::vector<ObjectEntry>(scene.lights.lamps.size()), scene.lights.paths);
  return out.format;
}

/// The name without the ending that shard_path() would give it, so that both names may be told.
std::string without_shard(std::string output, const std::string& shard) {
  if (shard.empty()) return output;
  const std::string ending = shard_path(".exr", read_shard(shard));
  if (output.size() > ending.size() && output.ends_with(ending))
    output.replace(output.size() - ending.size(), ending.size(), ".exr");
  return output;
}

}  // namespace

std::string unfinished(const std::string& path, const Scene& scene, const std::optional<Shard>& shard) {
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
    const std::vector<std::string> faults = verify_file(path);
    return faults.empty() ? "" : faults.front();
  } catch (const InputError&) {
    return "cannot be read as a dataset";
  }
}

TraceFrames::TraceFrames(const TraceOptions& options)
    : source_(options.scene),
      output_(without_shard(options.output, options.shard)),
      metrics_(metric_descriptions()) {
  if (options.scene.empty() || !options.from.empty())
    throw InputError("command line", "expected a SCENE beside --frames");
  if (output_.size() <= 4 || !output_.ends_with(".exr"))
    throw InputError(options.output, "expected a name that ends in .exr");
  document_ = parse_json(scene_text(source_), source_);
  if (!is_sequence(document_)) throw InputError(source_, "is no sequence; expected \"frames\" in the scene");
  frames_ = read_frames(document_, source_);
  numbers_ = parse_frames(options.frames);
  for (const int frame : numbers_)
    if (frame >= frames_.count)
      throw InputError("--frames", "there is no frame " + std::to_string(frame) + "; expected 0 to " +
                                       std::to_string(frames_.count - 1));
  if (numbers_.size() > 1 && !has_number(output_))
    throw InputError("--output", "expected #### in the name, for the frame's number");
}

Scene TraceFrames::scene(int frame) const {
  const std::string where = place(frame);
  return read_scene(canonical_json(scene_at(document_, frames_, frame, source_)), where, metrics_);
}

std::string TraceFrames::whole_file(int frame) const { return numbered(output_, frame, "--output"); }

}  // namespace nullcone
