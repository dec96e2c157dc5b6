// What it costs to find where rays meet a mesh, to trace a scene of one with the kernels that trace pictures,
// and to read one. `mesh_camera` and `mesh_random` are the search alone, one lane at a time; `mesh_scene` is
// a whole scene in one thread, from pixels to records in memory. If Embree is there, its rays stand beside.
#include <benchmark/benchmark.h>

#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <random>

#include "core/scene/load_mesh.h"
#include "core/trace/any_shape.h"
#include "core/trace/crossing.h"
#include "core/trace/placing.h"
#include "core/trace/trace_scene.h"
#include "metrics/minkowski_kernel.h"
#include "metrics/registry.h"
#ifdef NULLCONE_EMBREE
#include <embree3/rtcore.h>
#endif

namespace nullcone {
namespace {

using namespace host;

/// Circles of latitude: 10^3 to 10^6 triangles.
constexpr int kParts[] = {16, 50, 159, 500};

std::int64_t triangles_of(int parts) { return std::int64_t{4} * parts * (parts - 1); }

/// A bumpy sphere, by longitude and latitude; every position once.
TriangleSoup bumpy_sphere(int parts) {
  TriangleSoup out;
  const auto rows = static_cast<std::uint32_t>(parts), columns = 2 * rows;
  const auto add = [&](double longitude, double z) {
    const double rho = std::sqrt(1 - z * z), x = rho * std::cos(longitude), y = rho * std::sin(longitude);
    const double radius = 1 + 0.1 * std::sin(9 * x) * std::sin(7 * y + 1) * std::sin(8 * z);
    out.positions.push_back({radius * x, radius * y, radius * z});
  };
  add(0, -1), add(0, 1);
  for (std::uint32_t j = 1; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i)
      add(2 * std::numbers::pi * i / columns, -std::cos(std::numbers::pi * j / rows));
  for (std::uint32_t j = 1; j <= rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t row = 2 + (j - 1) * columns, next = (i + 1) % columns;
      const std::uint32_t a = row - columns + i, b = row - columns + next, c = row + i, d = row + next;
      if (j == 1)
        out.triangles.push_back({0, d, c});
      else if (j == rows)
        out.triangles.push_back({a, b, 1});
      else
        out.triangles.push_back({a, b, d}), out.triangles.push_back({a, d, c});
    }
  return out;
}
const TriangleSoup& soup_of(int parts) {
  static std::map<int, TriangleSoup> made;
  const auto found = made.find(parts);
  return found != made.end() ? found->second : made.emplace(parts, bumpy_sphere(parts)).first->second;
}
const Mesh& mesh_of(int parts) {
  static std::map<int, Mesh> made;
  const auto found = made.find(parts);
  return found != made.end() ? found->second : made.emplace(parts, make_mesh(soup_of(parts))).first->second;
}

struct Start {
  Vec3<double> from, along;
};

/// From a camera whose picture the mesh fills, line by line; or from anywhere to anywhere.
std::vector<Start> starts(bool camera) {
  std::vector<Start> out;
  std::mt19937_64 engine(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> part;
  const auto direction = [&] {
    return normalised(Vec3<double>{{normal(engine), normal(engine), normal(engine)}});
  };
  constexpr int kWide = 300;
  for (int i = 0; i < kWide * kWide; ++i) {
    const double x = 0.16 * (2.0 * (i % kWide) / kWide - 1), y = 0.16 * (2.0 * (i / kWide) / kWide - 1);
    const Vec3<double> from = camera ? Vec3<double>{{0, 0, -4}} : 4.0 * direction();
    const Vec3<double> to = camera ? from + Vec3<double>{{x, y, 1}} : 1.1 * part(engine) * direction();
    out.push_back({from, normalised(to - from)});
  }
  return out;
}

void count_rays(benchmark::State& state, std::size_t rays, std::size_t hits) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(rays));
  state.counters["met"] = static_cast<double>(hits) / static_cast<double>(rays);
}

void mesh_rays(benchmark::State& state, int parts, bool camera) {
  const Mesh& mesh = mesh_of(parts);
  const AnyShape shape(MeshShape{view_of(mesh)});
  const RestPlacing<Minkowski> placing{
      {}, {{0, 0, 0, 0}}, true, {Vec3<double>{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}, mesh.ball};
  const std::vector<Start> rays = starts(camera);
  std::size_t hits = 0;
  for ([[maybe_unused]] auto _ : state) {
    hits = 0;
    for (const Start& s : rays) {
      const auto launch = placing.launch(Vec4<double>{{0, s.from[0], s.from[1], s.from[2]}});
      const auto ray = placing.ray(launch, Vec4<double>{{-1, s.along[0], s.along[1], s.along[2]}});
      hits += first_crossing(ray, shape, 100.0, 1.6e-14).met;
    }
  }
  count_rays(state, rays.size(), hits);
}

void mesh_tree(benchmark::State& state, int parts) {
  for ([[maybe_unused]] auto _ : state) {
    state.PauseTiming();
    TriangleSoup soup = soup_of(parts);
    state.ResumeTiming();
    benchmark::DoNotOptimize(make_mesh(std::move(soup)));
  }
  state.SetItemsProcessed(state.iterations() * triangles_of(parts));
}

/// An OBJ file in a folder of its own, with the scene that it goes with beside it.
class ObjFile {
 public:
  explicit ObjFile(int parts)
      : folder_(std::filesystem::temp_directory_path() / ("nullcone_bench_" + std::to_string(getpid()))) {
    std::filesystem::create_directory(folder_);
    std::ofstream out(path());
    char line[128];
    const TriangleSoup& soup = soup_of(parts);
    for (const auto& p : soup.positions)
      out.write(line, std::snprintf(line, sizeof line, "v %.9f %.9f %.9f\n", p[0], p[1], p[2]));
    for (const auto& t : soup.triangles)
      out.write(line, std::snprintf(line, sizeof line, "f %u %u %u\n", t[0] + 1, t[1] + 1, t[2] + 1));
  }
  ObjFile(const ObjFile&) = delete;
  ObjFile& operator=(const ObjFile&) = delete;
  ~ObjFile() { std::filesystem::remove_all(folder_); }
  std::string path() const { return folder_ / "mesh.obj"; }
  std::string scene() const { return folder_ / "scene.json"; }

 private:
  std::filesystem::path folder_;
};

/// Text and tree.
void mesh_obj(benchmark::State& state, int parts) {
  const ObjFile file(parts);
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(make_mesh(load_obj(file.path(), 1).soup));
  state.SetItemsProcessed(state.iterations() * triangles_of(parts));
}

/// The view of `mesh_camera` as a scene: the search, the records, and all that is around them, with the
/// kernel of the best instruction set in one thread. Processor time, for machines with other work. Items are
/// rays.
void mesh_scene(benchmark::State& state, int parts) {
  const ObjFile file(parts);
  Scene scene = read_scene(
      R"({"metric": {"name": "minkowski"}, "observer": {"event": [0, 0, 0, -4]}, "camera": {"type": "perspective",
      "forward": [0, 0, 1], "up": [0, 1, 0], "fov_deg": 18.18, "resolution": [800, 800]}, "objects": [{"name": "mesh",
      "shape": {"type": "mesh", "file": "mesh.obj"}, "placing": {"type": "coordinate", "centre": [0, 0, 0]}}]})",
      file.scene(), metric_descriptions());
  const auto tracer = prepare_scene(find_spacetime(scene.metric), scene, "benchmark");
  std::size_t hits = 0;
  for ([[maybe_unused]] auto _ : state) {
    hits = 0;
    const auto count = [&](Band&& band) { hits += band.hits.count(); };
    state.SetIterationTime(trace_bands(*tracer, scene, {0, scene.camera.height}, 1, {}, count));
  }
  count_rays(state, static_cast<std::size_t>(scene.camera.width * scene.camera.height), hits);
}

#ifdef NULLCONE_EMBREE
/// Embree 3 in single precision, ray by ray, with its robust flag.
void embree_rays(benchmark::State& state, int parts, bool camera) {
  const TriangleSoup& soup = soup_of(parts);
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* const positions = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, soup.positions.size()));
  for (std::size_t i = 0; i < soup.positions.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) positions[3 * i + k] = static_cast<float>(soup.positions[i][k]);
  void* const indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12,
                                                soup.triangles.size());
  std::memcpy(indices, soup.triangles.data(), 12 * soup.triangles.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  const std::vector<Start> rays = starts(camera);
  std::size_t hits = 0;
  for ([[maybe_unused]] auto _ : state) {
    hits = 0;
    for (const Start& s : rays) {
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      RTCRayHit ray{};
      ray.ray.org_x = static_cast<float>(s.from[0]), ray.ray.dir_x = static_cast<float>(s.along[0]);
      ray.ray.org_y = static_cast<float>(s.from[1]), ray.ray.dir_y = static_cast<float>(s.along[1]);
      ray.ray.org_z = static_cast<float>(s.from[2]), ray.ray.dir_z = static_cast<float>(s.along[2]);
      ray.ray.tfar = 100, ray.ray.mask = ~0U;
      ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(scene, &context, &ray);
      hits += ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
  }
  count_rays(state, rays.size(), hits);
  rtcReleaseScene(scene);
  rtcReleaseDevice(device);
}
#endif

}  // namespace
}  // namespace nullcone

int main(int argc, char** argv) {
  using namespace nullcone;
  for (const int parts : kParts) {
    const std::string triangles = "/" + std::to_string(triangles_of(parts));
    for (const bool camera : {true, false}) {
      const std::string rays = camera ? "_camera" : "_random";
      benchmark::RegisterBenchmark(("mesh" + rays + triangles).c_str(), mesh_rays, parts, camera);
#ifdef NULLCONE_EMBREE
      benchmark::RegisterBenchmark(("embree" + rays + triangles).c_str(), embree_rays, parts, camera);
#endif
    }
    benchmark::RegisterBenchmark(("mesh_scene" + triangles).c_str(), mesh_scene, parts)->UseManualTime();
    benchmark::RegisterBenchmark(("mesh_tree" + triangles).c_str(), mesh_tree, parts);
    benchmark::RegisterBenchmark(("mesh_obj" + triangles).c_str(), mesh_obj, parts);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
