// Cameras: from a pixel to a look direction in the camera's tetrad, and back.
#pragma once

#include <algorithm>
#include <numbers>

#include "core/base/vector.h"

namespace nullcone {

/// Scan lines a band: the unit of tracing, of writing, of fingerprints and of memory.
inline constexpr int kBandLines = 16;

enum class CameraType { perspective, panorama };

/// Plain data; angles in radians. A full sphere is a panorama of 2 pi x pi.
struct Camera {
  CameraType type = CameraType::panorama;
  int width = 0, height = 0;
  int samples = 1;  ///< rays a pixel, along each side
  double fov_horizontal = 0, fov_vertical = 0;
  /// Look direction of the centre, direction to the left edge, and up; orthonormal, in the camera's tetrad.
  std::array<double, 3> forward = {1, 0, 0}, left = {0, 1, 0}, up = {0, 0, 1};
};

/// The camera whose pixels are the samples of `camera`.
inline Camera sample_camera(Camera camera) {
  camera.width *= camera.samples;
  camera.height *= camera.samples;
  camera.samples = 1;
  return camera;
}

}  // namespace nullcone

NULLCONE_KERNEL_BEGIN

/// The unit look direction m at picture coordinates (x, y), in pixels from the top left corner; the centre of
/// pixel (i, j) is (i + 0.5, j + 0.5). The photon that arrives there moves along -m. Azimuth grows to the
/// left.
template <class S>
Vec3<S> look_direction(const Camera& camera, const S& x, const S& y) {
  const auto forward = convert<S>(camera.forward), left = convert<S>(camera.left), up = convert<S>(camera.up);
  const S across = S(0.5) - x * S(1.0 / camera.width), along = S(0.5) - y * S(1.0 / camera.height);
  if (camera.type == CameraType::perspective) {
    const auto horizontal = sincos(0.5 * camera.fov_horizontal), vertical = sincos(0.5 * camera.fov_vertical);
    const S to_left = across * S(2 * horizontal.sin / horizontal.cos);
    const S to_top = along * S(2 * vertical.sin / vertical.cos);
    return normalised(forward + to_left * left + to_top * up);
  }
  const auto azimuth = sincos(across * S(camera.fov_horizontal));
  const auto elevation = sincos(along * S(camera.fov_vertical));
  return elevation.cos * (azimuth.cos * forward + azimuth.sin * left) + elevation.sin * up;
}

/// Picture coordinates of a look direction (any length). Outside the picture, or behind a perspective camera,
/// the result lies outside [0, width] x [0, height].
inline Vec<double, 2> picture_position(const Camera& camera, const Vec3<double>& look) {
  const double f = dot(convert<double>(camera.forward), look), l = dot(convert<double>(camera.left), look),
               u = dot(convert<double>(camera.up), look);
  double across = 0, along = 0;
  if (camera.type == CameraType::perspective) {
    if (f <= 0) return {{-1.0, -1.0}};
    across = 0.5 * l / (f * std::tan(0.5 * camera.fov_horizontal));
    along = 0.5 * u / (f * std::tan(0.5 * camera.fov_vertical));
  } else {
    across = std::atan2(l, f) / camera.fov_horizontal;
    along = std::atan2(u, std::hypot(f, l)) / camera.fov_vertical;
  }
  return {{(0.5 - across) * camera.width, (0.5 - along) * camera.height}};
}

NULLCONE_KERNEL_END
