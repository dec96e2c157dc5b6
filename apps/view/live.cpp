#include "apps/view/live.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "apps/trace_job.h"
#include "apps/view/scene_changes.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/record/memory.h"
#include "core/trace/trace_scene.h"
#include "metrics/registry.h"

namespace nullcone::view {

namespace {

using nlohmann::json;

class Clock {
 public:
  explicit Clock(double most_seconds) : most_seconds_(most_seconds) {}
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  /// Ends tracing that takes too long. A band of scan lines is so little work that this is soon noticed.
  Progress limit() const {
    return [this](std::size_t done, std::size_t all) {
      if (done < all && seconds() > most_seconds_)
        throw InputError("scene", "takes more than " + std::to_string(std::lround(most_seconds_)) +
                                      " s to trace; expected fewer pixels or objects (or nullcone-trace)");
    };
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double most_seconds_;
};

void check_work(const Scene& scene, double most) {
  const Camera rays = sample_camera(scene.camera);
  const double paths =
      static_cast<double>(rays.width) * rays.height * (1 + static_cast<double>(scene.lights.all_paths()));
  if (paths > most)
    throw InputError("scene: /camera/resolution", "asks for " + std::to_string(std::llround(paths)) +
                                                      " rays and paths of light; expected at most " +
                                                      std::to_string(std::llround(most)) +
                                                      " in a viewer (nullcone-trace takes any number)");
}

/// Reads a scene as if its file stood beside the dataset. Complaints do not name that folder.
Scene read_beside(const std::string& dataset, const std::string& text,
                  std::span<const MetricDescription> metrics, MeshShelf* meshes) {
  const std::string place = (std::filesystem::path(dataset).parent_path() / "scene").string(),
                    folder = place.substr(0, place.size() - std::string_view("scene").size());
  try {
    return read_scene(text, place, metrics, meshes);
  } catch (const InputError& error) {
    const std::string what = error.what(), shown = printable(folder, folder.size());
    const std::string line = what.starts_with(shown) ? what.substr(shown.size()) : what;
    const std::size_t colon = std::min(line.find(": "), line.size());
    throw InputError(line.substr(0, colon), colon == line.size() ? "" : line.substr(colon + 2));
  }
}

}  // namespace

std::string LiveScene::hindrance(const Manifest& manifest, const std::string& dataset, MeshShelf* meshes) {
  if (manifest.scene.empty()) return "the dataset does not say of which scene it is";
  if (manifest.first_line != 0 || manifest.lines != manifest.height)
    return "the dataset is a part of a picture; expected a whole one (nullcone-merge)";
  try {
    const Scene scene = read_beside(dataset, manifest.scene, metric_descriptions(), meshes);
    if (!scene.integrated) return {};
    const auto metrics = metric_descriptions();
    const auto metric = std::ranges::find(metrics, scene.metric, &MetricDescription::name);
    return metric->closed_paths ? "the scene asks for integrated paths"
                                : "the spacetime '" + scene.metric + "' has no closed-form paths";
  } catch (const InputError& error) {
    return error.what();
  }
}

LiveScene::LiveScene(const Manifest& manifest, const std::string& dataset, MeshShelf* meshes,
                     const LiveLimits& limits)
    : dataset_(dataset), meshes_(meshes), limits_(limits) {
  if (const std::string reason = hindrance(manifest, dataset, meshes_); !reason.empty())
    throw InputError("scene", reason);
  scene_ = parse_json(manifest.scene, "scene");
  for (const MetricDescription& metric : metric_descriptions())
    if (scene_.at("metric").at("name") == metric.name) metric_ = metric;
}

Scene LiveScene::changed(const json& changes, const json& look, int scale) const {
  if (scale < 1 || scale > 8) throw InputError("scale", "expected a whole number from 1 to 8");
  json scene = scene_;
  apply_changes(changes, metric_, scene);
  make_coarser(scene, scale);
  if (!look.is_null()) scene["look"] = look;
  return read_beside(dataset_, canonical_json(scene), {&metric_, 1}, meshes_);
}

Dataset LiveScene::trace(const json& changes, int scale) const {
  const Clock clock(limits_.seconds);
  Scene scene = changed(changes, nullptr, scale);
  check_work(scene, limits_.paths);
  const int height = scene.camera.height;
  check_memory(scene, (height + kBandLines - 1) / kBandLines, available_memory(), "scene");
  const Spacetime& spacetime = find_spacetime(scene.metric);
  const auto tracer = prepare_scene(spacetime, scene, "scene");
  Dataset out;
  out.manifest = describe(spacetime, scene, *tracer);
  out.hits = empty_hits(out.manifest);
  Effort& effort = out.manifest.effort;
  effort.core_seconds =
      trace_bands(*tracer, scene, {0, height}, 0, clock.limit(), [&](const Band& band) { out.append(band); });
  effort.light_doubts = tracer->light_doubts();
  effort.seconds = clock.seconds();
  return out;
}

void LiveScene::save(const json& changes, const json& look, const std::string& path) const {
  const Clock clock(limits_.saved_seconds);
  check_output_name(path);
  Scene scene = changed(changes, look, 1);
  check_work(scene, limits_.saved_paths);
  check_memory(scene, bands_in_flight(0), available_memory(), "scene");
  const Spacetime& spacetime = find_spacetime(scene.metric);
  const auto tracer = prepare_scene(spacetime, scene, "scene");
  DatasetWriter writer(path, describe(spacetime, scene, *tracer));
  Effort effort = trace_into(writer, *tracer, scene, 0, clock.limit()).effort;
  effort.seconds = clock.seconds();
  writer.finish(effort);
}

}  // namespace nullcone::view
