// Spheres and boxes in their own frame: how far a ray may go before it can meet the surface.
#pragma once

#include <numbers>

#include "core/trace/sight.h"

NULLCONE_KERNEL_BEGIN

/// A sphere about the origin. Seen from inside (a dome) or from outside, as the ray starts.
struct Sphere {
  double radius;
  bool from_inside = false;
  static constexpr bool isotropic = true;

  double bounding_radius() const { return radius; }
  bool starts_inside() const { return from_inside; }
  bool is_sheet() const { return false; }

  /// Zero on the surface, positive on the side from which rays come; quadratic along straight lines.
  template <class S>
  S value(const Vec3<S>& X) const {
    const S f = dot(X, X) - S(radius * radius);
    return from_inside ? -f : f;
  }

  /// Whether X is within it.
  template <class S>
  Mask<S> holds(const Vec3<S>& X) const {
    return dot(X, X) < S(radius * radius);
  }

  /// Whether an observer at X could not see out (or, for a dome, not in).
  bool hides(const Vec3<double>& X) const { return value(X) <= 0; }

  /// A step that cannot pass the surface: F = |X|^2 - R^2 has F'' = 2|X'|^2 + 2 X.X'', bounded below by 2 c.
  template <class S>
  S safe_step(const Sight<S>& ray, const S&) const {
    const S along = dot(ray.X, ray.slope), distance = norm(ray.X), speed2 = dot(ray.slope, ray.slope);
    const S farthest = distance + ray.slope_max * ray.valid;
    if (from_inside) {
      const S c = S(-2.0) * (ray.slope_max * ray.slope_max + farthest * ray.bend_max);
      return first_root(value(ray.X), S(-2.0) * along, c, ray.valid);
    }
    // From afar the impact parameter |X x X'|/|X'| is known to rounding of |X|: aim at a sphere larger by
    // that.
    const S R = S(radius) + S(4e-15) * distance, F = (distance - R) * (distance + R);
    const S c = ray.slope_min * ray.slope_min - farthest * ray.bend_max;
    // (X.X')^2 - c F without cancellation; the last term is zero along straight lines.
    const Vec3<S> moment = cross(ray.X, ray.slope);
    const S bending = max(speed2 * S(1 - 1e-14) - c, S(0.0)) * F;
    const S discriminant = speed2 * R * R - dot(moment, moment) + bending;
    const S denominator = sqrt(max(discriminant, S(0.0))) - along;
    const auto meets = (discriminant >= S(0.0)) & (denominator > S(0.0));
    return max(select(meets, F / denominator, ray.valid), (distance - R) / ray.slope_max);
  }

  /// The unit normal on the side where `value` is positive.
  template <class S>
  Vec3<S> normal(const Vec3<S>& X) const {
    return S(from_inside ? -1.0 : 1.0) * normalised(X);
  }

  template <class S>
  Vec3<S> outward(const Vec3<S>& X) const {
    return normalised(X);
  }

  /// A step that cannot pass the next surface, for rays that may have met the sphere before and go on inside
  /// or outside of it. Whoever has just come through the surface moves away from it, whatever rounding says
  /// of the side.
  template <class S>
  S onward_step(const Sight<S>& ray, const S& rounding, const Mask<S>& inside) const {
    const S along = dot(ray.X, ray.slope), distance = norm(ray.X);
    const S R(radius), F = (distance - R) * (distance + R);  // as for safe_step, F'' >= 2 c
    const S farthest = distance + ray.slope_max * ray.valid;
    const auto outward = along > S(0.0);

    const S c = min(ray.slope_min * ray.slope_min - farthest * ray.bend_max, S(-1e-300));
    const S turned_back = (along + sqrt(along * along - c * max(F, S(0.0)))) / -c;
    const S outer = select(outward, turned_back, Sphere{radius, false}.safe_step(ray, rounding));

    const S bent = ray.slope_max * ray.slope_max + farthest * ray.bend_max, G = max(-F, S(0.0));
    const S root = sqrt(along * along + bent * G);
    return select(inside, select(outward, G / (along + root), (root - along) / bent), outer);
  }

  /// How far a ray that meets the surface here has to go on to be past it.
  template <class S>
  S skip(const Sight<S>& ray, const S& rounding) const {
    return max(S(8.0) * rounding, S(1e-12 * radius) / ray.slope_max);
  }

  /// u: longitude, 0.5 at +x, growing towards +y; v: 0 at -z, 1 at +z (equirectangular).
  template <class S>
  static Vec<S, 2> uv(const Vec3<S>& X) {
    constexpr double kPi = std::numbers::pi;
    const S longitude = atan2(X[1], X[0]), latitude = atan2(X[2], sqrt(X[0] * X[0] + X[1] * X[1]));
    return {{S(0.5) + S(0.5 / kPi) * longitude, S(0.5) + S(1 / kPi) * latitude}};
  }
};

/// A box about the origin with its edges along the axes, seen from outside. Without height it is a rectangle
/// (a quad) in the xy plane, with the normal +z, and seen from both sides.
struct Box {
  double half_x, half_y, half_z = 0;
  static constexpr bool isotropic = false;

  bool flat() const { return half_z == 0; }
  double bounding_radius() const { return sqrt(half_x * half_x + half_y * half_y + half_z * half_z); }
  bool starts_inside() const { return false; }

  /// The face of whose plane a point is farthest outside: on the surface, the face that it lies on.
  template <class S>
  struct Face {
    Mask<S> on_x, on_z;  ///< neither: a face across y
    S side;              ///< -1 or 1

    template <class T>
    T pick(const T& x, const T& y, const T& z) const {
      return select(on_x, x, select(on_z, z, y));
    }
  };
  template <class S>
  Face<S> face(const Vec3<S>& X) const {
    const S x = abs(X[0]) - S(half_x), y = abs(X[1]) - S(half_y), z = abs(X[2]) - S(half_z);
    Face<S> out;
    out.on_z = (z >= max(x, y)) | (S(half_z) == S(0.0));
    out.on_x = (x >= y) & !out.on_z;
    const auto below = out.pick(X[0], X[1], X[2]) < S(0.0);
    out.side = select(below & (S(half_z) > S(0.0)), S(-1.0), S(1.0));
    return out;
  }

  /// The greatest of the distances from the planes of the faces: convex, so that Newton's method ends at the
  /// face through which a ray comes in, or leaves.
  template <class S>
  S value(const Vec3<S>& X) const {
    const auto at = face(plain(X));
    return S(at.side) * at.pick(X[0], X[1], X[2]) - at.pick(S(half_x), S(half_y), S(half_z));
  }

  /// Whether X is within it; nothing is within a rectangle.
  template <class S>
  Mask<S> holds(const Vec3<S>& X) const {
    return (S(half_z) > S(0.0)) & (value(X) < S(0.0));
  }

  /// Whether an observer at X stands in the box, or in the rectangle itself.
  bool hides(const Vec3<double>& X) const {
    return std::fabs(X[0]) <= half_x && std::fabs(X[1]) <= half_y &&
           std::fabs(X[2]) <= half_z + 1e-12 * (half_x + half_y);
  }

  /// The box cannot be met before the ray has come to the planes of all faces that it is outside of, nor
  /// before its distance over the greatest speed. Within `resolution` (a length of lambda) it counts as met:
  /// rounding may have carried the ray across.
  template <class S>
  S safe_step(const Sight<S>& ray, const S& resolution) const {
    const Vec3<S> out = {{outside(ray.X[0], half_x), outside(ray.X[1], half_y), outside(ray.X[2], half_z)}};
    const auto until = [&](std::size_t i) {
      const S away = select(ray.X[i] < S(0.0), -ray.slope[i], ray.slope[i]);
      return select(out[i] > S(0.0), plane_step(out[i], away, ray.bend_max), S(0.0));
    };
    S step = until(2);
    if (!flat()) step = max(step, max(until(0), until(1)));
    const S by_distance = norm(out) / ray.slope_max;
    return select(by_distance <= resolution, S(0.0), max(step, by_distance));
  }

  /// The same for rays that may have met it before. Whoever is inside leaves only where the ray is outside of
  /// a face by more than rounding: who then looks for the box from outside does not find the same face again.
  template <class S>
  S onward_step(const Sight<S>& ray, const S& resolution, const Mask<S>& inside) const {
    const S outer = safe_step(ray, resolution);
    if (flat() || !any(inside)) return outer;
    const std::array<double, 3> half = {half_x, half_y, half_z};
    S inner = ray.valid;
    for (std::size_t i = 0; i < 3; ++i) {
      const S speed = abs(ray.slope[i]), X = select(ray.slope[i] < S(0.0), -ray.X[i], ray.X[i]);
      const S room = S(half[i]) + S(4.0) * resolution * ray.slope_max;
      const S ahead = plane_step(max(room - X, S(0.0)), -speed, ray.bend_max);
      const S behind = plane_step(max(room + X, S(0.0)), speed, ray.bend_max);
      inner = min(inner, min(ahead, behind));
    }
    return select(inside, inner, outer);
  }

  /// Within `rounding` a rectangle counts as met; the flatter a ray meets it, the longer it stays so near.
  /// The factor leaves room for steps whose rounding is larger.
  template <class S>
  S skip(const Sight<S>& ray, const S& rounding) const {
    if (!flat()) return S(0.0);
    const S steep = max(abs(ray.slope[2]), S(1e-300));
    return min(S(64.0) * rounding * ray.slope_max / steep, S(2 * bounding_radius()) / ray.slope_max);
  }

 private:
  template <class S>
  static S outside(const S& x, double half) {
    return max(abs(x) - S(half), S(0.0));
  }
};

NULLCONE_KERNEL_END
