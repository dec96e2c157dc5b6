// The ray of one pixel of a scene, as the tracer follows it: backwards from the camera.
#include <charconv>
#include <cmath>
#include <fstream>

#include "apps/geodesic_inquiry.h"
#include "core/base/boost.h"
#include "core/base/error.h"
#include "core/record/dataset_file.h"
#include "core/trace/hamilton.h"
#include "core/trace/trace_scene.h"
#include "metrics/registry.h"

namespace nullcone {

namespace {

/// The text of a scene: a JSON file, or the scene that a dataset carries in its header.
std::string scene_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);  // read once, from the front: it may be a pipe
  if (!in) throw InputError(path, "cannot open the file; expected a scene (.json) or a dataset (.exr)");
  std::string text;
  std::vector<char> block(4);
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())), in.gcount() > 0) {
    text.append(block.data(), static_cast<std::size_t>(in.gcount()));
    if (text == "\x76\x2f\x31\x01") return read_manifest(path).scene;
    if (text.size() > std::size_t{64} << 20)
      throw InputError(path, "is larger than 64 MiB; expected a scene");
    block.resize(1 << 16);
  }
  if (in.bad() || text.empty())
    throw InputError(path, "is empty or cannot be read; expected a scene (.json)");
  return text;
}

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

/// The one metric tensor of an event, dressed as a metric, for what needs nothing else.
struct MetricAt {
  static constexpr std::string_view name = "g at an event";
  static constexpr std::tuple<> parameters{};
  host::Matrix4<double> components;

  host::Matrix4<double> g(const host::Vec4<double>&) const { return components; }
};

/// g from an orthonormal frame: g^mn = sum_a eta^aa e_a^m e_a^n.
MetricAt metric_at(const Spacetime& spacetime, std::span<const double> parameters, const Event& event) {
  const auto axes = spacetime.static_tetrad(parameters, event);
  host::Matrix4<double> inverse{};
  for (std::size_t m = 0; m < 4; ++m)
    for (std::size_t n = 0; n < 4; ++n)
      for (std::size_t a = 0; a < 4; ++a) inverse[m][n] += (a == 0 ? 1 : -1) * axes[a][m] * axes[a][n];
  return {host::inverse(inverse)};
}

/// The photon that arrives at the centre of the pixel, followed into the past; frequency 1 for the camera.
Event past_tangent(const Inquiry& inquiry, const Scene& scene, const std::vector<int>& pixel) {
  const Observer& observer = scene.observer;
  const auto look = host::look_direction(scene.camera, pixel[0] + 0.5, pixel[1] + 0.5);
  const auto u = host::four_velocity(host::Vec3<double>{observer.velocity});
  const host::Vec4<double> k = -host::seen_photon(u, look);
  if (observer.frame == ObserverFrame::at_rest) return k.c;
  const MetricAt metric = metric_at(*inquiry.spacetime, inquiry.parameters, observer.event);
  const auto frame = host::observer_tetrad(metric, host::Vec4<double>{observer.event}, observer.frame);
  return in_static_tetrad(*inquiry.spacetime, inquiry.parameters, observer.event, frame.to_chart(k).c);
}

void trace(const Tracer& tracer, TracedPixel& traced) {
  const auto width = static_cast<std::size_t>(traced.scene.camera.width),
             x = static_cast<std::size_t>(traced.pixel[0]);
  std::vector<HitRecord> hits(width);
  std::vector<RayRecord> rays(width);
  hits.resize(tracer.trace_band(traced.pixel[1], 1, {hits, rays}));
  traced.record = rays[x];
  for (const HitRecord& hit : hits)
    if (hit.pixel == x) traced.hits.push_back(hit);
  for (std::size_t i = 0; i < traced.scene.objects.size(); ++i)
    traced.tau_origins.push_back(tracer.tau_origin(i));
}

double length(double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); }

/// Three times as far as anything in the scene.
double well_outside(const Scene& scene) {
  const Event& o = scene.observer.event;
  double farthest = length(o[1], o[2], o[3]);
  for (const Object& object : scene.objects) {
    if (object.shape.type == ShapeType::sky) continue;
    const Event& p = object.placing.worldline.event;
    const double size = object.shape.type == ShapeType::sphere
                            ? object.shape.radius
                            : length(object.shape.edges[0], object.shape.edges[1], 0);
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
    return well_outside(traced.scene) / std::fabs(ray.k[0]);
  if (!traced.hits.empty()) return traced.hits.back().Z;
  if (std::isfinite(traced.scene.max_lookback) && !ray.accuracy) return traced.scene.max_lookback;
  const double end = ray.at(std::min(traced.scene.max_lookback, 1e300)).lambda;
  return std::isfinite(end) && end > 0 ? end : well_outside(traced.scene);
}

}  // namespace

Inquiry inquire_pixel(const GeodesicOptions& options) {
  TracedPixel traced{};
  Scene& scene = traced.scene;
  scene = read_scene(scene_text(options.scene), options.scene, metric_descriptions());
  Inquiry out{};
  out.spacetime = &find_spacetime(scene.metric);
  const MetricDescription metric = out.spacetime->description();
  for (const MetricParameter& p : metric.parameters)
    out.parameters.push_back(scene.metric_parameters.at(std::string(p.name)));
  scene.integrated = integrates(options, metric, scene.integrated);
  scene.accuracy = accuracy_of(options, scene.accuracy);
  if (!scene.integrated && scene.observer.frame != ObserverFrame::at_rest)
    throw InputError("--paths", "the observer's frame \"normal\" needs integrated paths");
  traced.pixel = pixel_of(options.pixel, scene.camera);
  const auto tracer = prepare_scene(*out.spacetime, scene, options.scene);
  check_tetrad(*out.spacetime, out.parameters, scene.observer.event, options.scene + ": /observer/event");
  trace(*tracer, traced);

  Ray ray{out.spacetime, out.parameters, scene.observer.event, past_tangent(out, scene, traced.pixel), {}};
  if (scene.integrated) ray.accuracy = scene.accuracy;
  out.plot_to = last_lambda(ray, traced);
  out.lambda = evenly_spaced(0, out.plot_to, options.points == 0 ? 400 : options.points);
  out.members.push_back({0, ray});
  out.title = "Pixel " + options.pixel + " of " + printable(options.scene, 60);
  out.traced = std::move(traced);
  return out;
}

}  // namespace nullcone
