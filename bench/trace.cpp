// How fast closed forms are evaluated and scenes are traced (records in memory).
#include <benchmark/benchmark.h>

#include <fstream>
#include <iterator>

#include "core/trace/trace_scene.h"
#include "metrics/goedel.h"
#include "metrics/registry.h"

namespace {

using namespace nullcone;

/// One evaluation of the closed Gödel form, per ray.
void goedel_evaluation(benchmark::State& state) {
  using host::Pack;
  const host::Goedel metric{1};
  const auto path = metric.path(host::convert<Pack>(host::Vec4<double>{{0, 0.1, 0.2, 0}}),
                                host::convert<Pack>(host::Vec4<double>{{-1, -0.6, 0, -0.8}}));
  Pack lambda(0.5);
  for ([[maybe_unused]] auto _ : state) {
    auto P = path.at(lambda);
    benchmark::DoNotOptimize(P);
    lambda += 0.001;
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(Pack::size));
}
BENCHMARK(goedel_evaluation);

/// A scene, traced on the number of threads of the argument.
void trace_earth(benchmark::State& state) {
  std::ifstream in("scenes/goedel_earth.json");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto metrics = metric_descriptions();
  Scene scene = read_scene(text, "scenes/goedel_earth.json", metrics);
  const auto tracer = prepare_scene(find_spacetime(scene.metric), scene, "scenes/goedel_earth.json");
  double seconds = 0;
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(
        trace_bands(*tracer, scene.camera, static_cast<int>(state.range(0)), {}, seconds));
  state.SetItemsProcessed(state.iterations() * scene.camera.width * scene.camera.height);
}
BENCHMARK(trace_earth)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
