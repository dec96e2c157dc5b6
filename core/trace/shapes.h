// Shapes in their own frame: how far a ray may go before it can meet the surface, and texture coordinates.
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

  /// Zero on the surface, positive on the side from which rays come; quadratic along straight lines.
  template <class S>
  S value(const Vec3<S>& X) const {
    const S f = dot(X, X) - S(radius * radius);
    return from_inside ? -f : f;
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

/// A rectangle in the xy plane, centred, with edges along x and y; its normal is +z. Seen from both sides.
struct Quad {
  double half_x, half_y;
  static constexpr bool isotropic = false;

  double bounding_radius() const { return sqrt(half_x * half_x + half_y * half_y); }
  bool starts_inside() const { return false; }

  template <class S>
  S value(const Vec3<S>& X) const {
    return X[2];
  }

  /// Whether an observer at X stands in the rectangle itself.
  bool hides(const Vec3<double>& X) const {
    return std::fabs(X[0]) <= half_x && std::fabs(X[1]) <= half_y &&
           std::fabs(X[2]) <= 1e-12 * (half_x + half_y);
  }

  /// The plane cannot be met before first_root, nor the rectangle before its distance over the greatest
  /// speed. Within `resolution` (a length of lambda) the rectangle counts as met: rounding may have carried
  /// the ray across.
  template <class S>
  S safe_step(const Sight<S>& ray, const S& resolution) const {
    const S out_x = max(abs(ray.X[0]) - S(half_x), S(0.0)), out_y = max(abs(ray.X[1]) - S(half_y), S(0.0));
    const S distance = sqrt(out_x * out_x + out_y * out_y + ray.X[2] * ray.X[2]);
    const S slope = select(ray.X[2] < S(0.0), -ray.slope[2], ray.slope[2]);
    const S by_plane = first_root(abs(ray.X[2]), slope, -ray.bend_max, ray.valid);
    const S by_distance = distance / ray.slope_max;
    return select(by_distance <= resolution, S(0.0), max(by_plane, by_distance));
  }

  template <class S>
  Vec3<S> normal(const Vec3<S>&) const {
    return {{S(0.0), S(0.0), S(1.0)}};
  }

  /// The same for rays that may have met the quad before: those that move away from its plane have first to
  /// turn round.
  template <class S>
  S onward_step(const Sight<S>& ray, const S& resolution, const Mask<S>&) const {
    const S slope = select(ray.X[2] < S(0.0), -ray.slope[2], ray.slope[2]);
    const S bend = max(ray.bend_max, S(1e-300)), step = safe_step(ray, resolution);
    const S turned_back = (slope + sqrt(slope * slope + S(2.0) * bend * abs(ray.X[2]))) / bend;
    return select((step > S(0.0)) & (slope > S(0.0)), turned_back, step);
  }

  /// Within `rounding` the plane counts as met; the flatter a ray meets it, the longer it stays so near. The
  /// factor leaves room for steps whose rounding is larger.
  template <class S>
  S skip(const Sight<S>& ray, const S& rounding) const {
    const S steep = max(abs(ray.slope[2]), S(1e-300));
    return min(S(64.0) * rounding * ray.slope_max / steep, S(2 * bounding_radius()) / ray.slope_max);
  }

  template <class S>
  Vec<S, 2> uv(const Vec3<S>& X) const {
    return {{S(0.5) + S(0.5 / half_x) * X[0], S(0.5) + S(0.5 / half_y) * X[1]}};
  }
};

NULLCONE_KERNEL_END
