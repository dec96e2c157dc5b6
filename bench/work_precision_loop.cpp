// What a step costs: the bare stepper, the tracer's loop without objects, and the tracer with a scene of
// three objects, for each instruction set; and 100,000 captured rays.
//   stepper_loop [REPEATS]
#include <ctime>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "bench/work_precision_rays.h"
#include "core/trace/trace_scene.h"
#include "metrics/registry.h"

namespace {

using namespace nullcone;
using namespace nullcone::study;

constexpr Place kKerr20 = {"kerr_r20", MetricId::kerr_schild, 0.9, 20, 50};
constexpr Accuracy kDopri5{1e-8, 0, Integrator::dopri5};

const std::string kScene = R"({"metric": {"name": "kerr_schild", "spin": 0.9},
  "observer": {"event": [0, 19.7, 0, 3.47]}, "accuracy": {"rtol": 1e-8, "integrator": "dopri5"},
  "camera": {"type": "perspective", "azimuth_deg": 180, "elevation_deg": -10, "fov_deg": 74,
             "resolution": [256, 256]},
  "objects": [
    {"name": "behind", "shape": {"type": "sphere", "radius": 1.5},
     "placing": {"type": "coordinate", "centre": [-8, 3, 1]}},
    {"name": "beside", "shape": {"type": "sphere", "radius": 2},
     "placing": {"type": "coordinate", "centre": [4, -7, 0]}},
    {"name": "square", "shape": {"type": "quad", "edges": [4, 4]},
     "placing": {"type": "coordinate", "centre": [0, 9, -3], "z_axis": [1, -0.2, 0.3], "y_axis": [0, 0, 1]}},
    {"name": "sky", "shape": {"type": "sky"}}]})";

double cpu_seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Rays that stay clear of the hole, so that every lane goes on: on a ring of the screen.
std::vector<Start> passing_rays(std::size_t n) {
  std::vector<Start> out;
  for (std::size_t i = 0; i < n; ++i) {
    const double angle = 6.283185307179586 * static_cast<double>(i) / static_cast<double>(n);
    const double b = 8 + 7 * static_cast<double>(i % 16) / 16;
    out.push_back(screen_ray(kKerr20, b * __builtin_cos(angle), b * __builtin_sin(angle)));
  }
  return out;
}

/// ns a step and ray of the bare stepper, over the first steps of passing rays.
double bare(const Kernel& kernel, int repeats) {
  constexpr int kAttempts = 40;
  const auto start = passing_rays(1024);
  const study::Rays rays{start.data(), nullptr, start.size()};
  return 1e9 * kernel.loop(kKerr20, kDopri5, rays, kAttempts, repeats) / (kAttempts * 1024.0);
}

/// The same of whole rays in the tracer's loop, without objects.
double marching(const Kernel& kernel, int repeats) {
  const auto start = screen(kKerr20, 64, 15);
  std::vector<End> end(start.size());
  const double seconds = kernel.march(kKerr20, kDopri5, {start.data(), end.data(), end.size()}, repeats);
  double steps = 0;
  for (const End& e : end) steps += e.steps;
  return 1e9 * seconds / steps;
}

/// The same of a scene, with crossings and records.
double tracing(std::string_view isa, int repeats) {
  Scene scene = read_scene(kScene, "stepper_loop", metric_descriptions());
  const auto tracer = prepare_scene(find_spacetime(scene.metric, isa), scene, "stepper_loop");
  std::vector<RayRecord> rays(static_cast<std::size_t>(scene.camera.width) * kBandLines);
  Gathering sink;
  double best = 1e300;
  for (int i = 0; i < repeats; ++i) {
    double steps = 0, seconds = 0;
    for (int line = 0; line < scene.camera.height; line += kBandLines) {
      const double begin = cpu_seconds();
      sink.hits.clear();
      tracer->trace_band(line, kBandLines, {sink, rays});
      seconds += cpu_seconds() - begin;
      for (const RayRecord& ray : rays) steps += ray.steps;
    }
    best = std::min(best, 1e9 * seconds / steps);
  }
  return best;
}

/// Rays into the hole, up to `part` of the shadow's radius in every direction.
void captured(const Kernel& kernel, double spin, double radius, double part) {
  const Place place{"", MetricId::kerr_schild, spin, radius, 3 * radius};
  std::vector<Start> start;
  std::vector<End> end(1);
  const auto falls = [&](double X, double Y) {
    const Start one = screen_ray(place, X, Y);
    kernel.march(place, kDopri5, {&one, end.data(), 1}, 1);
    return end[0].captured;
  };
  const double middle = 2 * spin;  // about where the shadow's middle is, to the right
  for (int i = 0; i < 400; ++i) {
    const double angle = 6.283185307179586 * i / 400, c = __builtin_cos(angle), s = __builtin_sin(angle);
    double in = 0, out = 12;
    for (int k = 0; k < 40; ++k) {
      const double b = 0.5 * (in + out);
      (falls(middle + b * c, b * s) ? in : out) = b;
    }
    for (int k = 0; k < 250; ++k) {
      const double b = part * in * __builtin_sqrt((k + 0.5) / 250);
      start.push_back(screen_ray(place, middle + b * c, b * s));
    }
  }
  end.resize(start.size());
  kernel.march(place, kDopri5, {start.data(), end.data(), end.size()}, 1);
  std::vector<double> steps;
  double drift = 0;
  std::size_t others = 0;
  for (const End& e : end) {
    others += !e.captured;
    steps.push_back(e.steps);
    drift = std::max(drift, e.drift);
  }
  std::sort(steps.begin(), steps.end());
  std::printf(
      "captured: spin %.1f, r = %-4.0f up to %.3f b_c: %zu rays, %zu not captured; steps %.0f (median) %.0f "
      "(99 %%) "
      "%.0f (most), drift %.1e (most)\n",
      spin, radius, part, end.size(), others, steps[steps.size() / 2], steps[steps.size() * 99 / 100],
      steps.back(), drift);
}

}  // namespace

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 20;
  const bool wide = __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
  if (!wide) std::puts("no AVX-512 here: skipped");
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return std::puts("no AVX2 here"), 1;
  std::puts("Kerr-Schild, dopri5 at 1e-8, ns a step and ray: bare stepper, the tracer's loop, a scene");
  for (const Kernel* kernel : {&kAvx512Pack, &kAvx512Lane, &kAvx2Pack, &kAvx2Lane}) {
    if (!wide && (kernel == &kAvx512Pack || kernel == &kAvx512Lane)) continue;
    const bool pack = kernel == &kAvx512Pack || kernel == &kAvx2Pack;
    const double alone = bare(*kernel, repeats), loop = marching(*kernel, repeats);
    std::printf("%-16s %7.1f %7.1f", kernel->name.data(), alone, loop);
    if (!pack) {
      std::puts("");
      continue;
    }
    const double scene = tracing(kernel->name, repeats);
    std::printf(" %7.1f   scene / bare %.2f\n", scene, scene / alone);
  }
  const Kernel& kernel = wide ? kAvx512Pack : kAvx2Pack;
  for (const double part : {0.95, 0.999})
    for (const double spin : {0.0, 0.9})
      for (const double radius : {20.0, 1000.0}) captured(kernel, spin, radius, part);
}
