// Cameras: from a pixel to a look direction in the camera's tetrad, and back.
#pragma once

#include <algorithm>
#include <numbers>
#include <string_view>

#include "core/base/faces.h"
#include "core/base/projections.h"

namespace nullcone {

/// Scan lines a band: the unit of tracing, of writing, of fingerprints and of memory.
inline constexpr int kBandLines = 16;

enum class CameraType { perspective, panorama, fisheye, cube_map, tetrahedron_map, orthographic };
inline constexpr std::array<std::string_view, 6> kCameraNames = {
    "perspective", "panorama", "fisheye", "cube_map", "tetrahedron_map", "orthographic"};

/// Plain data; angles in radians. A full sphere is a panorama of 2 pi x pi; maps of all directions have these
/// angles too. A fisheye's are those of its circle.
struct Camera {
  CameraType type = CameraType::panorama;
  int width = 0, height = 0;
  int samples = 1;  ///< rays a pixel, along each side
  double fov_horizontal = 0, fov_vertical = 0;
  double extent_horizontal = 0, extent_vertical = 0;  ///< of an orthographic camera's film, in scene units
  /// Look direction of the centre (of maps: of their front), direction to the left edge, and up; orthonormal,
  /// in the camera's tetrad.
  std::array<double, 3> forward = {1, 0, 0}, left = {0, 1, 0}, up = {0, 0, 1};
};

/// The camera whose pixels are the samples of `camera`.
inline Camera sample_camera(Camera camera) {
  camera.width *= camera.samples;
  camera.height *= camera.samples;
  camera.samples = 1;
  return camera;
}

/// Whether rays start at a film, all in one direction: at different events.
inline bool has_film(const Camera& camera) { return camera.type == CameraType::orthographic; }

/// The radius of a fisheye's circle, in pixels.
inline double circle_radius(const Camera& camera) { return 0.5 * std::min(camera.width, camera.height); }

}  // namespace nullcone

NULLCONE_KERNEL_BEGIN

/// The unit look direction m at picture coordinates (x + dx, y + dy), in pixels from the top left corner; the
/// centre of pixel (i, j) is (i + 0.5, j + 0.5). The photon that arrives there moves along -m. Azimuth grows
/// to the left. A map that consists of faces is continued beyond the edges of the face to which (x, y)
/// belongs.
template <class S>
Vec3<S> look_direction(const Camera& camera, const S& x, const S& y, const S& dx = S(0.0),
                       const S& dy = S(0.0)) {
  const CameraAxes<S> axes{convert<S>(camera.forward), convert<S>(camera.left), convert<S>(camera.up)};
  const S over_width(1.0 / camera.width), over_height(1.0 / camera.height), at_x = x + dx, at_y = y + dy;
  if (camera.type == CameraType::cube_map)
    return look_on_faces(kCube, axes, x * over_width, y * over_height, dx * over_width, dy * over_height);
  if (camera.type == CameraType::tetrahedron_map)
    return look_on_faces(kTetrahedron, axes, x * over_width, y * over_height, dx * over_width,
                         dy * over_height);
  if (camera.type == CameraType::fisheye) {
    const S over_radius(1 / circle_radius(camera));
    return look_in_fisheye(axes, 0.5 * camera.fov_horizontal, (S(0.5 * camera.width) - at_x) * over_radius,
                           (S(0.5 * camera.height) - at_y) * over_radius);
  }
  if (has_film(camera)) return axes.forward;
  const S across = S(0.5) - at_x * over_width, along = S(0.5) - at_y * over_height;
  if (camera.type == CameraType::perspective)
    return look_in_perspective(axes, camera.fov_horizontal, camera.fov_vertical, across, along);
  return look_in_panorama(axes, camera.fov_horizontal, camera.fov_vertical, across, along);
}

/// Where the ray at picture coordinates (x + dx, y + dy) starts, from the observer's place in his rest frame:
/// on the film of an orthographic camera.
template <class S>
Vec3<S> place_on_film(const Camera& camera, const S& x, const S& y, const S& dx = S(0.0),
                      const S& dy = S(0.0)) {
  const S to_left = (S(0.5 * camera.width) - (x + dx)) * S(camera.extent_horizontal / camera.width),
          to_top = (S(0.5 * camera.height) - (y + dy)) * S(camera.extent_vertical / camera.height);
  return to_left * convert<S>(camera.left) + to_top * convert<S>(camera.up);
}

/// Whether there is a direction to look in: not beyond the circle of a fisheye.
template <class S>
Mask<S> has_ray(const Camera& camera, const S& x, const S& y) {
  if (camera.type != CameraType::fisheye) return x == x;
  const S across = S(0.5 * camera.width) - x, along = S(0.5 * camera.height) - y;
  const double radius = circle_radius(camera);
  return across * across + along * along <= S(radius * radius);
}

/// Picture coordinates of a look direction (any length). Outside the picture, behind a perspective camera,
/// beyond a fisheye's field of view, and for an orthographic camera, which sees one direction everywhere, the
/// result lies outside [0, width] x [0, height].
inline Vec<double, 2> picture_position(const Camera& camera, const Vec3<double>& look) {
  constexpr Vec<double, 2> kNowhere = {{-1.0, -1.0}};
  const Vec3<double> seen = {{dot(convert<double>(camera.forward), look),
                              dot(convert<double>(camera.left), look),
                              dot(convert<double>(camera.up), look)}};
  if (has_film(camera)) return kNowhere;
  Vec<double, 2> part{};  // of the picture, from its centre to the left and upwards
  if (camera.type == CameraType::cube_map) {
    part = place_on_faces(kCube, seen);
  } else if (camera.type == CameraType::tetrahedron_map) {
    part = place_on_faces(kTetrahedron, seen);
  } else if (camera.type == CameraType::fisheye) {
    const Vec<double, 2> at = place_in_fisheye(0.5 * camera.fov_horizontal, seen);
    if (std::hypot(at[0], at[1]) > 1 + 1e-12) return kNowhere;
    const double radius = circle_radius(camera);
    part = {{at[0] * radius / camera.width, at[1] * radius / camera.height}};
  } else if (camera.type == CameraType::perspective) {
    if (seen[0] <= 0) return kNowhere;
    part = place_in_perspective(camera.fov_horizontal, camera.fov_vertical, seen);
  } else {
    part = place_in_panorama(camera.fov_horizontal, camera.fov_vertical, seen);
  }
  return {{(0.5 - part[0]) * camera.width, (0.5 - part[1]) * camera.height}};
}

NULLCONE_KERNEL_END
