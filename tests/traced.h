// Tracing a scene given as JSON text, in memory and in full precision.
#pragma once

#include <string>

#include "core/trace/trace_scene.h"
#include "metrics/registry.h"

namespace nullcone::test {

struct Traced {
  Scene scene;
  std::vector<TracedBand> bands;
  std::vector<double> tau_origins = {};  ///< of the objects

  /// f(hit, x, y) for every hit, with its pixel.
  template <class F>
  void for_each_hit(F&& f) const {
    for (std::size_t band = 0; band < bands.size(); ++band)
      for (const HitRecord& hit : bands[band].hits) {
        const auto width = static_cast<std::size_t>(scene.camera.width);
        f(hit, hit.pixel % width, static_cast<std::size_t>(kBandLines) * band + hit.pixel / width);
      }
  }
  /// Look direction of the centre of a pixel.
  host::Vec3<double> look(std::size_t x, std::size_t y) const {
    return host::look_direction(scene.camera, static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5);
  }
  std::size_t hits() const {
    std::size_t out = 0;
    for (const TracedBand& band : bands) out += band.hits.size();
    return out;
  }
  std::size_t rays_with(Status status) const {
    std::size_t out = 0;
    for (const TracedBand& band : bands)
      for (const RayRecord& ray : band.rays) out += ray.status == static_cast<std::uint32_t>(status);
    return out;
  }
};

inline Traced trace_text(const std::string& text, int threads = 0) {
  const auto metrics = metric_descriptions();
  Traced out{read_scene(text, "test", metrics), {}};
  const auto tracer = prepare_scene(find_spacetime(out.scene.metric), out.scene, "test");
  out.bands = trace_exactly(*tracer, out.scene, threads);
  for (std::size_t i = 0; i < out.scene.objects.size(); ++i) out.tau_origins.push_back(tracer->tau_origin(i));
  return out;
}

}  // namespace nullcone::test
