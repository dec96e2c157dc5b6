// The ray of one pixel of a scene, as the tracer follows it: backwards from the camera.
#include <charconv>
#include <cmath>

#include "apps/geodesic_inquiry.h"
#include "apps/geodesic_outline.h"
#include "apps/scene_file.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/trace/trace_scene.h"
#include "metrics/registry.h"

namespace nullcone {

namespace {

/// "X,Y": whole numbers within the picture.
std::vector<int> pixel_of(const std::string& text, const Camera& camera) {
  std::vector<int> out(2);
  const char* const end = text.data() + text.size();
  const auto x = std::from_chars(text.data(), end, out[0]);
  const bool comma = x.ec == std::errc() && x.ptr != end && *x.ptr == ',';
  const auto y = comma ? std::from_chars(x.ptr + 1, end, out[1]) : x;
  if (!comma || y.ec != std::errc() || y.ptr != end)
    throw InputError("--pixel", "expected two whole numbers X,Y, found '" + printable(text, 40) + "'");
  if (out[0] < 0 || out[0] >= camera.width || out[1] < 0 || out[1] >= camera.height)
    throw InputError("--pixel", "lies outside the picture of " + std::to_string(camera.width) + " x " +
                                    std::to_string(camera.height) + " pixels");
  return out;
}

void trace(const Tracer& tracer, TracedPixel& traced) {
  const auto width = static_cast<std::size_t>(traced.scene.camera.width),
             x = static_cast<std::size_t>(traced.pixel[0]);
  Gathering sink;
  std::vector<RayRecord> rays(width);
  tracer.trace_band(traced.pixel[1], 1, {sink, rays});
  traced.record = rays[x];
  for (const HitRecord& hit : sink.hits)
    if (hit.pixel == x) traced.hits.push_back(hit);
  for (std::size_t i = 0; i < traced.scene.objects.size(); ++i)
    traced.tau_origins.push_back(tracer.tau_origin(i));
}

double length(double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); }

/// Three times as far as anything in the scene, and as the start of a ray.
double well_outside(const Scene& scene, const Event& o) {
  double farthest = length(o[1], o[2], o[3]);
  for (const Object& object : scene.objects) {
    if (object.shape.type == ShapeType::sky) continue;
    const Event& p = object.placing.worldline.event;
    const double size = ball_of(object.shape);
    farthest = std::max(
        {farthest, length(p[1], p[2], p[3]) + size, length(p[1] - o[1], p[2] - o[2], p[3] - o[3]) + size});
  }
  return farthest > 0 ? 3 * farthest : 10;
}

/// Where the report of a ray ends: at the crossing, or where the ray does, or well outside for one that
/// escapes.
double last_lambda(const Ray& ray, const TracedPixel& traced) {
  const auto status = static_cast<Status>(traced.record.status);
  const bool on_sky =
      status == Status::sky ||
      (!traced.hits.empty() && traced.scene.objects[traced.hits.front().id - 1].shape.type == ShapeType::sky);
  if (on_sky || (status == Status::lookback_reached && !std::isfinite(traced.scene.max_lookback)))
    return well_outside(traced.scene, ray.event) / std::fabs(ray.k[0]);
  if (!traced.hits.empty()) return traced.hits.back().Z;
  if (std::isfinite(traced.scene.max_lookback) && !ray.accuracy) return traced.scene.max_lookback;
  const double end = ray.at(std::min(traced.scene.max_lookback, 1e300)).lambda;
  return std::isfinite(end) && end > 0 ? end : well_outside(traced.scene, ray.event);
}

}  // namespace

Inquiry inquire_pixel(const GeodesicOptions& options) {
  TracedPixel traced{};
  Scene& scene = traced.scene;
  const WholeJson file = read_scene_file(options.scene);
  scene = file.read(
      [&] { return read_scene(canonical_json(file.document), options.scene, metric_descriptions()); });
  Inquiry out{};
  out.spacetime = &find_spacetime(scene.metric);
  const MetricDescription metric = out.spacetime->description();
  for (const MetricParameter& p : metric.parameters)
    out.parameters.push_back(scene.metric_parameters.at(std::string(p.name)));
  scene.integrated = integrates(options, metric, scene.integrated);
  scene.accuracy = accuracy_of(options, scene.accuracy);
  if (!scene.integrated && scene.observer.frame != ObserverFrame::at_rest)
    throw InputError("--paths", "the observer's frame \"normal\" needs integrated paths");
  scene.camera.samples = 1;  // the ray through the centre
  traced.pixel = pixel_of(options.pixel, scene.camera);
  if (!host::has_ray(scene.camera, traced.pixel[0] + 0.5, traced.pixel[1] + 0.5))
    throw InputError("--pixel", "lies outside the camera's field of view; expected one within the circle");
  const auto tracer = file.read([&] { return prepare_scene(*out.spacetime, scene, options.scene); });
  trace(*tracer, traced);

  // The photon that arrives at the centre of the pixel, followed into the past.
  const CameraRayReport start = out.spacetime->camera_ray(out.parameters, scene.camera, scene.observer,
                                                          traced.pixel[0] + 0.5, traced.pixel[1] + 0.5);
  Ray ray{out.spacetime, out.parameters, start.event, start.past, {}, start.frame};
  if (scene.integrated) ray.accuracy = scene.accuracy;
  if (static_cast<Status>(traced.record.status) == Status::outside)
    throw InputError("--pixel", "lies where there is no observer of the camera's frame; expected another");
  out.plot_to = last_lambda(ray, traced);
  out.lambda = evenly_spaced(0, out.plot_to, options.points == 0 ? 400 : options.points);
  out.members.push_back({0, ray});
  out.title = "Pixel " + options.pixel + " of " + printable(options.scene, 60);
  out.traced = std::move(traced);
  return out;
}

}  // namespace nullcone
