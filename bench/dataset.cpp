// How fast datasets are written and read, beside a bare OpenEXR program that moves the same bytes in the same
// run. Files lie in the folder NULLCONE_BENCH_FOLDER (default /dev/shm, so that no disk is measured); what
// fsync costs is measured apart, in NULLCONE_BENCH_DISK (default /var/tmp).
#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineInputPart.h>
#include <ImfDeepScanLineOutputPart.h>
#include <ImfFrameBuffer.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "core/record/dataset_file.h"
#include "core/trace/trace_scene.h"
#include "metrics/registry.h"

namespace {

using namespace nullcone;

std::string place(const char* variable, const char* fallback, const char* name) {
  const char* folder = std::getenv(variable);
  return std::string(folder ? folder : fallback) + "/nullcone_bench_" + std::to_string(::getpid()) + name;
}

/// A file name that vanishes with its file.
struct Name {
  std::string path;
  explicit Name(const char* variable = "NULLCONE_BENCH_FOLDER", const char* fallback = "/dev/shm")
      : path(place(variable, fallback, ".exr")) {}
  ~Name() { std::filesystem::remove(path); }
  Name(const Name&) = delete;
  Name& operator=(const Name&) = delete;
};

/// 1280 x 1024 pixels with `layers` crossings each. What is compressed (rays, preview) is as smooth as traced
/// pictures are: noise there would slow both sides down and flatter the ratio.
Dataset full_picture(std::uint64_t layers) {
  Dataset out;
  out.manifest.set_size(1280, 1024);
  out.manifest.scene = "{}", out.manifest.objects = {{"wall", 0}};
  std::mt19937 random(1);
  for_each_channel(
      [&](const ChannelInfo&, auto& column) {
        using T = typename std::remove_cvref_t<decltype(column)>::value_type;
        column.resize(out.pixels() * layers);
        for (T& value : column) value = static_cast<T>(1) + static_cast<T>(random() % 2);
      },
      out.hits);
  out.hits.offset.resize(out.pixels() + 1);
  for (std::size_t i = 0; i < out.hits.offset.size(); ++i) out.hits.offset[i] = i * layers;
  out.rays.status.assign(out.pixels(), 0);
  out.rays.error.assign(out.pixels(), 0);
  out.rays.drift.assign(out.pixels(), 0);
  for (std::uint32_t i = 0; i < out.pixels(); ++i)
    out.rays.steps.push_back(12 + (i / 1280 / 64 + i % 1280 / 64) % 7);
  return out;
}

Dataset demo() {
  std::ifstream in("scenes/goedel_earth.json");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto metrics = metric_descriptions();
  const Scene scene = read_scene(text, "scenes/goedel_earth.json", metrics);
  return trace_scene(find_spacetime(scene.metric), scene, "scenes/goedel_earth.json");
}

/// The pictures, by the argument of a case.
const Dataset& picture(std::int64_t number) {
  static const Dataset pictures[] = {full_picture(1), full_picture(4), demo()};
  return pictures[number];
}
void each_picture(benchmark::internal::Benchmark* of) {
  of->ArgName("picture")->DenseRange(0, 2)->UseRealTime()->Unit(benchmark::kMillisecond);
}

std::int64_t bytes_of(const Dataset& dataset) {
  const auto hits = dataset.hits.count() * channel_names(dataset.hits).size();
  const auto rays = dataset.pixels() * (kRayChannelInfo.size() + 2 + 1);  // preview, counts
  return static_cast<std::int64_t>(4 * (hits + rays));
}
void rate(benchmark::State& state, const Dataset& dataset) {
  state.SetBytesProcessed(state.iterations() * bytes_of(dataset));
}

// The bare program: everything that OpenEXR wants to be told stands ready before the clock starts.

template <class T>
constexpr Imf::PixelType pixel_type() {
  return std::is_same_v<T, float> ? Imf::FLOAT : Imf::UINT;
}

struct Bare {
  Dataset data;
  int width = 0, height = 0;
  std::vector<half> colors;
  std::vector<unsigned> counts;
  std::vector<std::vector<char*>> pointers;
  std::vector<Imf::Header> headers;
  Imf::FrameBuffer preview, rays;
  Imf::DeepFrameBuffer hits;

  explicit Bare(const Dataset& dataset)
      : data(dataset), width(data.manifest.width), height(data.manifest.height), colors(4 * data.pixels()) {
    header("preview", Imf::SCANLINEIMAGE, Imf::ZIP_COMPRESSION);
    header("hits", Imf::DEEPSCANLINE, Imf::NO_COMPRESSION);
    header("rays", Imf::SCANLINEIMAGE, Imf::ZIP_COMPRESSION);
    for (std::size_t c = 0; c < 4; ++c) {
      const std::string name(1, "RGBA"[c]);
      headers[0].channels().insert(name, Imf::Channel(Imf::HALF));
      preview.insert(name, slice<Imf::Slice>(Imf::HALF, colors.data() + c, 4 * sizeof(half)));
    }
    for_each_channel(
        [&](const ChannelInfo& channel, auto& column) {
          constexpr auto type = pixel_type<typename std::remove_cvref_t<decltype(column)>::value_type>();
          headers[2].channels().insert(std::string(channel.name), Imf::Channel(type));
          rays.insert(std::string(channel.name), slice<Imf::Slice>(type, column.data(), 4));
        },
        data.rays);
    deep();
  }

 private:
  void header(const char* name, const std::string& type, Imf::Compression compression) {
    Imf::Header& out = headers.emplace_back(width, height);
    out.setName(name);
    out.setType(type);
    out.compression() = compression;
  }
  template <class Slice, class... More>
  Slice slice(Imf::PixelType type, void* base, std::size_t stride, More... more) const {
    return {type, static_cast<char*>(base), stride, stride * static_cast<std::size_t>(width), more...};
  }
  void deep() {
    const auto& offset = data.hits.offset;
    for (std::size_t i = 0; i < data.pixels(); ++i)
      counts.push_back(static_cast<unsigned>(offset[i + 1] - offset[i]));
    hits.insertSampleCountSlice(slice<Imf::Slice>(Imf::UINT, counts.data(), sizeof(unsigned)));
    for_each_channel(
        [&](const ChannelInfo& channel, auto& column) {
          constexpr auto type = pixel_type<typename std::remove_cvref_t<decltype(column)>::value_type>();
          headers[1].channels().insert(std::string(channel.name), Imf::Channel(type));
          std::vector<char*>& at = pointers.emplace_back();
          for (std::size_t i = 0; i < data.pixels(); ++i)
            at.push_back(reinterpret_cast<char*>(column.data() + offset[i]));
          hits.insert(std::string(channel.name),
                      slice<Imf::DeepSlice>(type, at.data(), sizeof(char*), std::size_t{4}));
        },
        data.hits);
  }
};

void bare_write(const std::string& path, const Bare& bare) {
  Imf::MultiPartOutputFile file(path.c_str(), bare.headers.data(), 3);
  Imf::OutputPart preview(file, 0);
  preview.setFrameBuffer(bare.preview);
  preview.writePixels(bare.height);
  Imf::DeepScanLineOutputPart hits(file, 1);
  hits.setFrameBuffer(bare.hits);
  hits.writePixels(bare.height);
  Imf::OutputPart rays(file, 2);
  rays.setFrameBuffer(bare.rays);
  rays.writePixels(bare.height);
}

/// Into memory that stands ready: a reader of its own would still have to ask for it.
void bare_read(const std::string& path, const Bare& bare) {
  Imf::MultiPartInputFile file(path.c_str());
  Imf::DeepScanLineInputPart hits(file, 1);
  hits.setFrameBuffer(bare.hits);
  hits.readPixelSampleCounts(0, bare.height - 1);
  hits.readPixels(0, bare.height - 1);
  Imf::InputPart rays(file, 2);
  rays.setFrameBuffer(bare.rays);
  rays.readPixels(0, bare.height - 1);
}

void dataset_write(benchmark::State& state) {
  const Dataset& dataset = picture(state.range(0));
  const Preview preview(4 * dataset.pixels(), 0.25F);
  const Name file;
  for ([[maybe_unused]] auto _ : state) write_dataset(file.path, dataset, preview);
  rate(state, dataset);
}
BENCHMARK(dataset_write)->Apply(each_picture);

void openexr_write(benchmark::State& state) {
  const Bare bare(picture(state.range(0)));
  const Name file;
  for ([[maybe_unused]] auto _ : state) {
    bare_write(file.path + "2", bare);
    std::filesystem::rename(file.path + "2", file.path);
  }
  rate(state, bare.data);
}
BENCHMARK(openexr_write)->Apply(each_picture);

void dataset_read(benchmark::State& state) {
  const Dataset& dataset = picture(state.range(0));
  const Name file;
  write_dataset(file.path, dataset, Preview(4 * dataset.pixels(), 0.25F));
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(read_dataset(file.path));
  rate(state, dataset);
}
BENCHMARK(dataset_read)->Apply(each_picture);

void openexr_read(benchmark::State& state) {
  const Bare bare(picture(state.range(0)));
  const Name file;
  bare_write(file.path, bare);
  for ([[maybe_unused]] auto _ : state) bare_read(file.path, bare);
  rate(state, bare.data);
}
BENCHMARK(openexr_read)->Apply(each_picture);

/// Fingerprints: part of making a dataset and of verifying it, not of writing or reading it.
void dataset_sha256(benchmark::State& state) {
  const Dataset& dataset = picture(state.range(0));
  Dataset copy = dataset;
  for ([[maybe_unused]] auto _ : state) fingerprint(copy);
  rate(state, dataset);
}
BENCHMARK(dataset_sha256)->Apply(each_picture);

/// What a disk takes to make a file of the dataset's size last: fsync alone, of the file and of its folder.
void disk_fsync(benchmark::State& state) {
  const Dataset& dataset = picture(state.range(0));
  const Name file("NULLCONE_BENCH_DISK", "/var/tmp");
  const std::string bytes(static_cast<std::size_t>(bytes_of(dataset)), 'x');
  for ([[maybe_unused]] auto _ : state) {
    std::filesystem::remove(file.path);
    std::ofstream(file.path, std::ios::binary) << bytes;
    const int at = ::open(file.path.c_str(), O_RDONLY | O_CLOEXEC);
    const int folder = ::open(std::filesystem::path(file.path).parent_path().c_str(), O_RDONLY | O_CLOEXEC);
    const auto start = std::chrono::steady_clock::now();
    const bool lasts = ::fsync(at) == 0 && ::fsync(folder) == 0;
    state.SetIterationTime(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    ::close(at), ::close(folder);
    if (!lasts) state.SkipWithError("fsync fails there");
  }
  rate(state, dataset);
}
BENCHMARK(disk_fsync)->ArgName("picture")->DenseRange(0, 2)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
