// How fast closed forms are evaluated and scenes are traced (records in memory), for every instruction set.
#include <benchmark/benchmark.h>

#include <chrono>
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

/// Keeps the crossings of a band, and the light that falls on them.
class LightSink final : public HitSink {
 public:
  explicit LightSink(std::size_t paths) : paths_(paths) {}
  std::size_t count = 0;  ///< of all crossings so far

  HitRoom extend(std::size_t more) override {
    hits_.resize(more);
    lights_.assign(more * paths_, {});
    return {hits_.data(), nullptr, paths_ > 0 ? lights_.data() : nullptr, paths_};
  }
  void keep(std::size_t kept) override {
    count += kept;
    benchmark::DoNotOptimize(hits_.data());
    benchmark::DoNotOptimize(lights_.data());
  }

 private:
  std::size_t paths_;
  std::vector<HitRecord> hits_;
  std::vector<HitLight> lights_;
};

/// Traces a picture in one thread; returns seconds.
double time_of(const Tracer& tracer, const Scene& scene, LightSink& sink) {
  std::vector<RayRecord> rays(static_cast<std::size_t>(scene.camera.width) * kBandLines);
  const auto start = std::chrono::steady_clock::now();
  for (int line = 0; line < scene.camera.height; line += kBandLines)
    tracer.trace_band(line, std::min(kBandLines, scene.camera.height - line), {sink, rays});
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// What a lamp costs in the Gödel universe, shadows left out: the same picture with and without it. Items are
/// crossings times kinds of paths (two in one winding).
void lamp(benchmark::State& state, std::string_view isa, const Triple& velocity) {
  const auto metrics = metric_descriptions();
  Scene dark = read_scene(kThreeSpheres, "benchmark", metrics);
  Scene lit = dark;
  Lamp lamp;
  lamp.name = "lamp";
  lamp.placing.worldline = {{-1, 0.8, -0.5, 0.6}, velocity};
  lit.lights = {{lamp}, 1, 2, false, 1e12};
  const auto& spacetime = find_spacetime(dark.metric, isa);
  const auto without = prepare_scene(spacetime, dark, "benchmark"),
             with = prepare_scene(spacetime, lit, "benchmark");
  LightSink none(0), two(2);
  for ([[maybe_unused]] auto _ : state) {
    const double base = time_of(*without, dark, none);
    state.SetIterationTime(std::max(time_of(*with, lit, two) - base, 1e-9));
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(2 * two.count));
  state.counters["ns/path"] = benchmark::Counter(2e-9 * static_cast<double>(two.count),
                                                 benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string earth = read("scenes/goedel_earth.json");
  for (const std::string_view isa : instruction_sets()) {
    const std::string name(isa);
    benchmark::RegisterBenchmark(("evaluation/" + name).c_str(), evaluation, isa);
    benchmark::RegisterBenchmark(("three_spheres/" + name).c_str(), trace, kThreeSpheres, isa, 1)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("lamp_at_rest/" + name).c_str(), lamp, isa, Triple{0, 0, 0})
        ->UseManualTime();
    benchmark::RegisterBenchmark(("lamp_in_motion/" + name).c_str(), lamp, isa, Triple{0.5, 0.2, 0.1})
        ->UseManualTime();
    benchmark::RegisterBenchmark(("earth/" + name).c_str(), trace, earth, isa, 1)
        ->Unit(benchmark::kMillisecond);
  }
  benchmark::RegisterBenchmark("earth/2_threads", trace, earth, "", 2)
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
