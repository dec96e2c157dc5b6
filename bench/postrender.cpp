// How fast pictures are made of a dataset in memory, 1280 x 1024 with every pixel hit: stages, whole frames.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "postrender/develop.h"
#include "postrender/renderer.h"

namespace {

using namespace nullcone;
using namespace nullcone::postrender;

constexpr int kWidth = 1280, kHeight = 1024;
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

/// A world map over the whole picture, warped a little, 1.6 texels a pixel; `turned` by a right angle.
Dataset world(bool turned) {
  Dataset out;
  out.manifest.set_size(kWidth, kHeight);
  out.manifest.objects = {{"earth"}};
  for (int row = 0; row < kHeight; ++row)
    for (int column = 0; column < kWidth; ++column) {
      const float x = (static_cast<float>(column) + 0.5f) / kWidth;
      const float y = (static_cast<float>(row) + 0.5f) / kHeight;
      const float u = turned ? y : x, v = turned ? x : 1 - y;
      Hits& hits = out.hits;
      hits.u.push_back(u + 0.01f * std::sin(20 * v));
      hits.v.push_back(v + 0.01f * std::sin(20 * u));
      hits.shift.push_back(1 / (1 + 0.4f * std::cos(6 * x)));
      hits.Z.push_back(1);
      hits.A.push_back(1);
      hits.id.push_back(1);
      hits.order.push_back(0);
      hits.t.push_back(-1);
      hits.tau.push_back(0);
      hits.mu.push_back(1);
      hits.offset.push_back(hits.u.size());
    }
  return out;
}

/// A texture of 2048 x 1024, or another kind by its name, on a black body or as it is.
nlohmann::json look_document(const std::string& texture, bool black_body) {
  nlohmann::json earth = nlohmann::json::object();
  if (texture == "checkerboard")
    earth["texture"] = {{"type", texture}, {"counts", {36, 18}}, {"colors", {{1, 1, 1}, {0, 0, 0.5}}}};
  if (texture == "mipmap" || texture == "bilinear")
    earth["texture"] = {
        {"type", "image"}, {"file", "/usr/share/xplanet/images/earth.jpg"}, {"filter", texture}};
  if (black_body) earth["spectrum"] = {{"type", "black_body"}, {"temperature_K", 5762}};
  return {{"objects", {{"earth", earth}}},
          {"exposure", {{"white_cd_m2", 3e9}}},
          {"tone", {{"curve", "exponential"}, {"k", 1}}}};
}
Look look_of(const std::string& texture, bool black_body, const Manifest& manifest) {
  return parse_look(look_document(texture, black_body), {"bench", "", ""}, manifest);
}

void count_pixels(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kPixels));
}

/// What changes from one frame to the next.
enum class Change { everything, temperature };

/// The same lit by a lamp along two paths, the second of which reaches half of the picture.
Dataset lit_world() {
  Dataset out = world(false);
  out.manifest.lights = {{"sun"}};
  out.manifest.light_paths = 2;
  set_lamps(out.hits, {"sun"}, 2);
  for (std::size_t i = 0; i < kPixels; ++i)
    for (std::size_t path = 0; path < 2; ++path) {
      const float x = static_cast<float>(i % kWidth) / kWidth;
      LightPath& light = out.hits.light[path];
      light.E.push_back(path == 0 ? 1 + x : std::max(0.0f, x - 0.5f));
      light.shift.push_back(path == 0 ? 1.0f : 0.8f + 0.3f * x);
      light.t.push_back(-3);
      light.tau.push_back(x);
    }
  return out;
}

/// Whole frames on the number of threads of the argument.
void frames(benchmark::State& state, const std::string& texture, Change change, bool turned,
            ImageParts parts) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(0)));
  Renderer renderer(world(turned));
  nlohmann::json document = look_document(texture, true);
  std::vector<Look> looks;  // parsed before the clock runs: each frame another one
  for (int i = 0; i < 64; ++i) {
    if (change == Change::everything) document["objects"]["earth"]["texture"]["offset"] = {1e-3 * i, 0};
    document["objects"]["earth"]["spectrum"]["temperature_K"] = 5700 + i;
    looks.push_back(parse_look(document, {"bench", "", ""}, renderer.dataset().manifest));
  }
  Image image;
  for (int i = 0; i < 3; ++i) renderer.render(looks[static_cast<std::size_t>(i)], parts, image);
  std::size_t frame = 0;
  for ([[maybe_unused]] auto _ : state) {
    renderer.render(looks[frame++ % looks.size()], parts, image);
    benchmark::ClobberMemory();
  }
  count_pixels(state);
}
constexpr ImageParts kLinear{.exposed = false, .display = true, .encoded = false};
constexpr ImageParts kEncoded{.exposed = false, .display = false, .encoded = true};
constexpr ImageParts kAll{};
#define NULLCONE_FRAMES(name, ...)             \
  BENCHMARK_CAPTURE(frames, name, __VA_ARGS__) \
      ->Arg(1)                                 \
      ->Arg(2)                                 \
      ->MeasureProcessCPUTime()                \
      ->UseRealTime()                          \
      ->Unit(benchmark::kMillisecond)
NULLCONE_FRAMES(black_body_mipmap, "mipmap", Change::everything, false, kLinear);
NULLCONE_FRAMES(black_body_mipmap_turned, "mipmap", Change::everything, true, kLinear);
NULLCONE_FRAMES(black_body_mipmap_encoded, "mipmap", Change::everything, false, kEncoded);
NULLCONE_FRAMES(black_body_mipmap_all_parts, "mipmap", Change::everything, false, kAll);
NULLCONE_FRAMES(black_body_bilinear, "bilinear", Change::everything, false, kLinear);
NULLCONE_FRAMES(temperature, "mipmap", Change::temperature, false, kLinear);
NULLCONE_FRAMES(temperature_encoded, "mipmap", Change::temperature, false, kEncoded);

/// Frames of a lit surface whose texture is looked up anew each time, or is not, as the intensity of the lamp
/// alone changes. `of_lamp` and `of_surface` are further entries.
void lit_frames(benchmark::State& state, Change change, const nlohmann::json& of_lamp,
                const nlohmann::json& of_surface) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(0)));
  Renderer renderer(lit_world());
  nlohmann::json document = look_document("mipmap", false);
  document["objects"]["earth"]["surface"] = {{"type", "lambertian"}};
  document["objects"]["earth"].update(of_surface);
  document["lights"]["sun"] = {{"spectrum", {{"type", "black_body"}, {"temperature_K", 5762}}}};
  document["lights"]["sun"].update(of_lamp);
  std::vector<Look> looks;
  for (int i = 0; i < 64; ++i) {
    if (change == Change::everything) document["objects"]["earth"]["texture"]["offset"] = {1e-3 * i, 0};
    if (of_lamp.empty()) document["lights"]["sun"]["intensity"] = 1 + 0.01 * i;
    looks.push_back(parse_look(document, {"bench", "", ""}, renderer.manifest()));
  }
  Image image;
  for (int i = 0; i < 3; ++i) renderer.render(looks[static_cast<std::size_t>(i)], kLinear, image);
  std::size_t frame = 0;
  for ([[maybe_unused]] auto _ : state) {
    renderer.render(looks[frame++ % looks.size()], kLinear, image);
    benchmark::ClobberMemory();
  }
  count_pixels(state);
}
#define NULLCONE_LIT(name, ...)                    \
  BENCHMARK_CAPTURE(lit_frames, name, __VA_ARGS__) \
      ->Arg(1)                                     \
      ->Arg(2)                                     \
      ->MeasureProcessCPUTime()                    \
      ->UseRealTime()                              \
      ->Unit(benchmark::kMillisecond)
const nlohmann::json kNothing = nlohmann::json::object(),
                     kBlinks = {{"blink", {{"channel", "tau"}, {"period", 0.3}}}},
                     kPaint = {{"spectrum", {{"type", "gaussian"}, {"centre_nm", 540}, {"fwhm_nm", 120}}}};
NULLCONE_LIT(texture, Change::everything, kNothing, kNothing);
NULLCONE_LIT(intensity, Change::temperature, kNothing, kNothing);
NULLCONE_LIT(blinking, Change::everything, kBlinks, kNothing);
NULLCONE_LIT(reflectance, Change::everything, kNothing, kPaint);

/// Frames of which only the exposure changes.
void development(benchmark::State& state) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(0)));
  Renderer renderer(world(false));
  Look look = look_of("mipmap", true, renderer.dataset().manifest);
  Image image;
  for (int i = 0; i < 2; ++i) renderer.render(look, kLinear, image);
  for ([[maybe_unused]] auto _ : state) {
    look.develop.ev += 1e-6;
    renderer.render(look, kLinear, image);
  }
  count_pixels(state);
}
BENCHMARK(development)->Arg(1)->Arg(2)->MeasureProcessCPUTime()->UseRealTime()->Unit(benchmark::kMillisecond);

/// One stage on one thread, with one of the kernels: stage(line of the picture).
template <class Stage>
void time_lines(benchmark::State& state, Stage&& stage) {
  for ([[maybe_unused]] auto _ : state) {
    for (std::size_t row = 0; row < kHeight; ++row) stage(row);
    benchmark::ClobberMemory();
  }
  count_pixels(state);
}

void shade(benchmark::State& state, const Kernel* kernel, const std::string& texture, bool black_body) {
  const Dataset dataset = world(false);
  const Look look = look_of(texture, black_body, dataset.manifest);
  const Shading shading = Renderer(dataset).prepare(look);
  const std::vector<std::uint8_t> one_each = lines_with_one_each(dataset);
  LineShader shader(dataset, one_each, shading, *kernel);
  std::vector<Rgbx> display(kWidth), physical(kWidth);
  time_lines(state, [&](std::size_t row) { shader.shade(row, display.data(), physical.data()); });
}

void develop(benchmark::State& state, const Kernel* kernel, const ImageParts& parts) {
  const DevelopLook look = look_of("mipmap", true, world(false).manifest).develop;
  std::vector<Rgbx> display(kWidth), physical(kWidth);
  for (std::size_t i = 0; i < kWidth; ++i) physical[i] = {1e6f * static_cast<float>(i % 97), 1e9f, 2e8f};
  Image image;
  set_size(image, kWidth, kHeight, parts);
  image.white_cd_m2 = 3e9;
  LineDeveloper developer(look, *kernel);
  time_lines(state, [&](std::size_t row) {
    developer.develop(display.data(), physical.data(), row * kWidth, kWidth, image);
  });
}

/// The yardstick: the bytes of the records (eleven channels of four bytes a crossing) and of a linear
/// picture, from one place of the memory to another.
void copy(benchmark::State& state) {
  const std::vector<float> from(kPixels * (11 + 3), 1.0f);
  std::vector<float> to(from.size());
  for ([[maybe_unused]] auto _ : state) {
    std::memcpy(to.data(), from.data(), from.size() * sizeof(float));
    benchmark::ClobberMemory();
  }
  count_pixels(state);
}
BENCHMARK(copy)->Unit(benchmark::kMillisecond);

[[maybe_unused]] const bool registered = [] {
  for (const Kernel* kernel : kernels()) {
    const auto add = [&](const std::string& name, auto&&... arguments) {
      benchmark::RegisterBenchmark((name + "/" + std::string(kernel->isa)).c_str(), arguments...)
          ->Unit(benchmark::kMillisecond);
    };
    add("shade/color", shade, kernel, "color", false);
    add("shade/checkerboard", shade, kernel, "checkerboard", false);
    add("shade/bilinear", shade, kernel, "bilinear", false);
    add("shade/mipmap", shade, kernel, "mipmap", false);
    add("shade/black_body", shade, kernel, "color", true);
    add("shade/black_body_mipmap", shade, kernel, "mipmap", true);
    add("develop/linear", develop, kernel, kLinear);
    add("develop/encoded", develop, kernel, kEncoded);
  }
  return true;
}();

}  // namespace
