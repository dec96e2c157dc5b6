// Projections of a picture that is one piece: from a place in the picture to a look direction, and back.
// `across` and `along` are the place, from the centre to the left and upwards.
#pragma once

#include "core/base/vector.h"

NULLCONE_KERNEL_BEGIN

/// Orthonormal.
template <class S>
struct CameraAxes {
  Vec3<S> forward, left, up;
};

/// Places as parts of the picture. Square pixels are the reader's affair.
template <class S>
Vec3<S> look_in_perspective(const CameraAxes<S>& axes, double fov_horizontal, double fov_vertical,
                            const S& across, const S& along) {
  const auto horizontal = sincos(0.5 * fov_horizontal), vertical = sincos(0.5 * fov_vertical);
  const S to_left = across * S(2 * horizontal.sin / horizontal.cos);
  const S to_top = along * S(2 * vertical.sin / vertical.cos);
  return normalised(axes.forward + to_left * axes.left + to_top * axes.up);
}

/// Azimuth and elevation are linear in the place, a part of the picture.
template <class S>
Vec3<S> look_in_panorama(const CameraAxes<S>& axes, double fov_horizontal, double fov_vertical,
                         const S& across, const S& along) {
  const auto azimuth = sincos(across * S(fov_horizontal));
  const auto elevation = sincos(along * S(fov_vertical));
  return elevation.cos * (azimuth.cos * axes.forward + azimuth.sin * axes.left) + elevation.sin * axes.up;
}

/// Equidistant: the angle from the forward direction is the distance from the centre times `at_rim`. Places
/// in radii of the circle.
template <class S>
Vec3<S> look_in_fisheye(const CameraAxes<S>& axes, double at_rim, const S& across, const S& along) {
  const S distance = sqrt(across * across + along * along);
  const auto angle = sincos(distance * S(at_rim));
  const S aside = angle.sin / max(distance, S(1e-300));  // at the centre itself 0, and so are the places
  return angle.cos * axes.forward + aside * (across * axes.left + along * axes.up);
}

// The inverse: the place of a look direction whose components are those along forward, left and up.

inline Vec<double, 2> place_in_perspective(double fov_horizontal, double fov_vertical,
                                           const Vec3<double>& look) {
  return {{0.5 * look[1] / (look[0] * std::tan(0.5 * fov_horizontal)),
           0.5 * look[2] / (look[0] * std::tan(0.5 * fov_vertical))}};
}

inline Vec<double, 2> place_in_panorama(double fov_horizontal, double fov_vertical,
                                        const Vec3<double>& look) {
  return {{std::atan2(look[1], look[0]) / fov_horizontal,
           std::atan2(look[2], std::hypot(look[0], look[1])) / fov_vertical}};
}

/// Straight backwards is a whole circle; its place is the one at the left.
inline Vec<double, 2> place_in_fisheye(double at_rim, const Vec3<double>& look) {
  const double aside = std::hypot(look[1], look[2]), distance = std::atan2(aside, look[0]) / at_rim;
  if (aside == 0) return {{distance, 0.0}};
  return {{distance * look[1] / aside, distance * look[2] / aside}};
}

NULLCONE_KERNEL_END
