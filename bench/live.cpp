// How fast a scene is traced, made ready and drawn again while something is dragged in it.
#include "apps/view/live.h"

#include <benchmark/benchmark.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <numeric>
#include <tuple>

#include "apps/view/thin.h"
#include "core/base/json.h"
#include "postrender/look.h"
#include "postrender/renderer.h"

namespace {

using namespace nullcone;
using nlohmann::json;

/// The three spheres of trace.cpp, glowing.
const std::string kThreeSpheres = R"({"metric": {"name": "goedel"}, "observer": {"event": [0, 0, 0, 0]},
  "camera": {"type": "perspective", "fov_deg": 90, "resolution": [640, 360]}, "max_lookback": 7, "objects": [
  {"name": "a", "shape": {"type": "sphere", "radius": 0.2}, "placing": {"type": "local", "worldline":
    {"type": "static", "event": [0, 0.9, 0.1, 0]}}},
  {"name": "b", "shape": {"type": "sphere", "radius": 0.15}, "placing": {"type": "local", "worldline":
    {"type": "static", "event": [0, 0.4, 0.8, 0.2]}}},
  {"name": "c", "shape": {"type": "sphere", "radius": 0.1}, "placing": {"type": "local", "worldline":
    {"type": "static", "event": [0, 0.5, -0.6, -0.1]}}}],
  "look": {"objects": {
    "a": {"spectrum": {"type": "black_body", "temperature_K": 5762}},
    "b": {"spectrum": {"type": "black_body", "temperature_K": 4000}},
    "c": {"spectrum": {"type": "black_body", "temperature_K": 9000}}},
    "tone": {"curve": "exponential", "k": 2}}})";

std::string read(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

view::LiveScene live_scene(const std::string& text, json& look) {
  const json scene = json::parse(text);
  look = scene.at("look");
  Manifest manifest;
  manifest.set_size(1, 1);
  manifest.scene = canonical_json(scene);
  return view::LiveScene(manifest, "");
}

/// What is dragged: nothing stays as it was. `from`: where the observer is to begin with.
json drag(int step, const json& from, const json& resolution) {
  json event = from;
  event[0] = 0.01 * step;
  event[1] = from[1].get<double>() + 0.002 * (step % 10);
  return {{"observer", {{"event", event}}},
          {"camera", {{"azimuth_deg", 0.3 * (step % 20)}, {"resolution", resolution}}}};
}

double milliseconds(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - since).count();
}

/// Whole frames, and what each step of them takes.
void frames(benchmark::State& state, const std::string& text, const json& resolution) {
  const json from = json::parse(text).at("observer").at("event");
  json look_json;
  const view::LiveScene scene = live_scene(text, look_json);
  const int scale = static_cast<int>(state.range(0));
  const auto textures = std::make_shared<postrender::TextureCache>();
  postrender::Image image;
  double trace = 0, ready = 0, render = 0;
  int step = 0;
  for ([[maybe_unused]] auto _ : state) {
    auto start = std::chrono::steady_clock::now();
    Dataset dataset = scene.trace(drag(step++, from, resolution), scale);
    trace += milliseconds(start), start = std::chrono::steady_clock::now();
    const postrender::Look look = postrender::parse_look(look_json, {"bench", "", ""}, dataset.manifest);
    postrender::Renderer renderer(std::move(dataset), *postrender::kernels().front(), textures);
    ready += milliseconds(start), start = std::chrono::steady_clock::now();
    renderer.render(look, {.exposed = false, .display = false, .encoded = true}, image);
    render += milliseconds(start);
  }
  const auto mean = [](double sum) { return benchmark::Counter(sum, benchmark::Counter::kAvgIterations); };
  state.counters["trace_ms"] = mean(trace);
  state.counters["ready_ms"] = mean(ready);
  state.counters["render_ms"] = mean(render);
  state.SetItemsProcessed(state.iterations());
}

/// A picture of 1280 x 1024, every pixel hit once, made coarser.
void coarser(benchmark::State& state) {
  Dataset dataset;
  dataset.manifest.set_size(1280, 1024);
  dataset.manifest.objects = {{"earth"}};
  const std::size_t pixels = dataset.pixels();
  dataset.hits.offset.resize(pixels + 1);
  std::iota(dataset.hits.offset.begin(), dataset.hits.offset.end(), 0);
  const auto fill = [&](const ChannelInfo&, auto& column) { column.assign(pixels, 1); };
  for_each_channel(fill, dataset.hits);
  for_each_channel(fill, dataset.rays);
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(view::thin(dataset, static_cast<int>(state.range(0))));
}
BENCHMARK(coarser)->Arg(1)->Arg(2)->Arg(4)->UseRealTime()->MeasureProcessCPUTime()->Unit(
    benchmark::kMillisecond);

}  // namespace

int main(int argc, char** argv) {
  const std::string street = read("scenes/street.json");
  for (const auto& [name, text, resolution] :
       {std::tuple{"goedel_three_spheres", kThreeSpheres, json{640, 360}},
        std::tuple{"minkowski_street", street, json{640, 400}}})
    benchmark::RegisterBenchmark(name, frames, text, resolution)
        ->Arg(1)
        ->Arg(2)
        ->UseRealTime()
        ->MeasureProcessCPUTime()
        ->Unit(benchmark::kMillisecond);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
