// How fast closed forms are evaluated and scenes are traced (records in memory), for every instruction set.
#include <benchmark/benchmark.h>

#include <fstream>
#include <iterator>

#include "core/trace/trace_scene.h"
#include "metrics/registry.h"

namespace {

using namespace nullcone;

const std::string kThreeSpheres = R"({"metric": {"name": "goedel"}, "observer": {"event": [0, 0, 0, 0]},
  "camera": {"type": "perspective", "fov_deg": 90, "resolution": [1280, 720]}, "max_lookback": 7, "objects": [
  {"name": "a", "shape": {"type": "sphere", "radius": 0.2}, "placing": {"type": "local", "worldline":
    {"type": "static", "event": [0, 0.9, 0.1, 0]}}},
  {"name": "b", "shape": {"type": "sphere", "radius": 0.15}, "placing": {"type": "local", "worldline":
    {"type": "static", "event": [0, 0.4, 0.8, 0.2]}}},
  {"name": "c", "shape": {"type": "sphere", "radius": 0.1}, "placing": {"type": "local", "worldline":
    {"type": "static", "event": [0, 0.5, -0.6, -0.1]}}}]})";

std::string read(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// One evaluation of the closed Gödel form (event), a ray.
void evaluation(benchmark::State& state, std::string_view isa) {
  const Spacetime& spacetime = find_spacetime("goedel", isa);
  const double a = 1;
  constexpr std::size_t kCount = 8000;
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(spacetime.walk({&a, 1}, {0, 0.1, 0.2, 0}, {-1, -0.6, 0, -0.8}, 1e-3, kCount));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kCount));
}

/// A scene, traced; items are rays.
void trace(benchmark::State& state, const std::string& text, std::string_view isa, int threads) {
  const auto metrics = metric_descriptions();
  Scene scene = read_scene(text, "benchmark", metrics);
  const auto tracer = prepare_scene(find_spacetime(scene.metric, isa), scene, "benchmark");
  const auto width = static_cast<std::size_t>(scene.camera.width);
  std::vector<RayRecord> rays(width * kBandLines);
  Gathering sink;
  for ([[maybe_unused]] auto _ : state) {
    if (threads > 1) {
      benchmark::DoNotOptimize(
          trace_bands(*tracer, scene, {0, scene.camera.height}, threads, {}, [](Band&&) {}));
      continue;
    }
    for (int line = 0; line < scene.camera.height; line += kBandLines) {
      sink.hits.clear();
      tracer->trace_band(line, std::min(kBandLines, scene.camera.height - line), {sink, rays});
      benchmark::DoNotOptimize(sink.hits.data());
    }
  }
  state.SetItemsProcessed(state.iterations() * scene.camera.width * scene.camera.height);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string earth = read("scenes/goedel_earth.json");
  for (const std::string_view isa : instruction_sets()) {
    const std::string name(isa);
    benchmark::RegisterBenchmark(("evaluation/" + name).c_str(), evaluation, isa);
    benchmark::RegisterBenchmark(("three_spheres/" + name).c_str(), trace, kThreeSpheres, isa, 1)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("earth/" + name).c_str(), trace, earth, isa, 1)
        ->Unit(benchmark::kMillisecond);
  }
  benchmark::RegisterBenchmark("earth/2_threads", trace, earth, "", 2)
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
