// A sky as cameras see it, by closed forms: for the tests of what lies in the sky.
#pragma once

#include <numbers>

#include "core/base/camera.h"
#include "tests/postrender_fixture.h"

namespace nullcone::postrender {

using Vector = host::Vec3<double>;

constexpr double kDegree = std::numbers::pi / 180;

inline Camera perspective(int width, int height, double fov_deg) {
  Camera out;
  out.type = CameraType::perspective;
  out.width = width;
  out.height = height;
  out.fov_horizontal = fov_deg * kDegree;
  out.fov_vertical = 2 * std::atan(std::tan(out.fov_horizontal / 2) * height / width);
  return out;
}
inline Camera of_all_directions(CameraType type, int width, int height) {
  Camera out;
  out.type = type;
  out.width = width;
  out.height = height;
  out.fov_horizontal = 2 * std::numbers::pi;
  out.fov_vertical = std::numbers::pi;
  return out;
}

/// What is seen in a look direction: a direction on the sky, and the frequency ratio.
struct Seen {
  std::array<double, 3> direction;
  double shift = 1;
};
inline std::array<double, 3> components(const Vector& d) { return {d[0], d[1], d[2]}; }
inline Seen at_rest(const Vector& look) { return {components(look)}; }

inline std::array<float, 2> uv_of(const std::array<double, 3>& d) {
  const double turn = 2 * std::numbers::pi;
  return {static_cast<float>(0.5 + std::atan2(d[1], d[0]) / turn),
          static_cast<float>(0.5 + std::atan2(d[2], std::hypot(d[0], d[1])) / std::numbers::pi)};
}

/// The records of an object "sky" (number 1), with n x n samples a pixel; `before` gives what stands in
/// front.
inline Dataset sky_dataset(const Camera& camera, int samples = 1,
                           const std::function<Seen(const Vector&)>& map = at_rest,
                           const std::function<std::vector<TestHit>(double, double)>& before = {}) {
  Dataset out;
  Manifest& manifest = out.manifest;
  manifest.set_size(camera.width, camera.height);
  manifest.samples = samples;
  manifest.objects = {{"sky"}, {"glass"}};
  manifest.setting = nlohmann::json{{"camera",
                                     {{"type", kCameraNames[static_cast<std::size_t>(camera.type)]},
                                      {"fov_rad", {camera.fov_horizontal, camera.fov_vertical}}}}}
                         .dump();
  Hits& hits = out.hits;
  if (samples > 1) hits.channels = hits.channels | ChannelSet::of("sample");
  const Camera fine = [&] {
    Camera c = camera;
    c.samples = samples;
    return sample_camera(c);
  }();
  for (int row = 0; row < camera.height; ++row)
    for (int column = 0; column < camera.width; ++column) {
      for (int k = 0; k < samples * samples; ++k) {
        const double x = column * samples + k % samples + 0.5, y = row * samples + k / samples + 0.5;
        const Seen seen = map(host::look_direction<double>(fine, x, y));
        std::vector<TestHit> all;
        if (before) all = before(x / samples, y / samples);
        const auto [u, v] = uv_of(seen.direction);
        all.push_back({1, u, v, static_cast<float>(seen.shift)});
        for (const TestHit& hit : all) {
          hits.Z.push_back(static_cast<float>(hits.Z.size()));
          hits.A.push_back(hit.opacity);
          hits.id.push_back(hit.id);
          hits.order.push_back(0);
          if (samples > 1) hits.sample.push_back(static_cast<std::uint32_t>(k));
          hits.u.push_back(hit.u);
          hits.v.push_back(hit.v);
          hits.shift.push_back(hit.shift);
          hits.t.push_back(-INFINITY);
          hits.tau.push_back(-INFINITY);
          hits.mu.push_back(1);
        }
      }
      hits.offset.push_back(hits.Z.size());
    }
  for (auto* column : {&out.rays.status, &out.rays.steps}) column->resize(manifest.rays());
  for (auto* column : {&out.rays.error, &out.rays.drift}) column->resize(manifest.rays());
  return out;
}

/// Solid angle of a pixel of a camera, by its corners' directions.
inline double pixel_solid_angle(const Camera& camera, int column, int row) {
  const double x = column + 0.5, y = row + 0.5;
  const auto look = [&](double dx, double dy) { return host::look_direction<double>(camera, x, y, dx, dy); };
  const Vector across = look(0.5, 0) - look(-0.5, 0), along = look(0, 0.5) - look(0, -0.5);
  const Vector area = cross(across, along);
  return std::sqrt(dot(area, area));
}

/// What light in a part of a picture amounts to.
struct Spot {
  double flux = 0, x = 0, y = 0;  ///< luminance times solid angle; its centre, in pixels
};
inline Spot spot_of(const Image& image, const Camera& camera,
                    const std::function<bool(double, double)>& where = {}) {
  Spot out;
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column) {
      const double x = column + 0.5, y = row + 0.5;
      if (where && !where(x, y)) continue;
      const Rgb c = image.exposed[static_cast<std::size_t>(row * image.width + column)];
      const double part =
          static_cast<double>(luminance(c)) * image.white_cd_m2 * pixel_solid_angle(camera, column, row);
      out.flux += part;
      out.x += part * x;
      out.y += part * y;
    }
  out.x /= out.flux;
  out.y /= out.flux;
  return out;
}

}  // namespace nullcone::postrender
