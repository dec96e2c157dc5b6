// Primitives of solids in their own frames: on which side of them a ray is, and how far it may go before that
// can change.
#pragma once

#include "core/scene/solid.h"
#include "core/trace/sight.h"

NULLCONE_KERNEL_BEGIN

/// Whether a ray is inside of something closed, and a step that cannot change that.
template <class S>
struct Side {
  Mask<S> in;
  S until;
};
template <class S>
Side<S> both(const Side<S>& a, const Side<S>& b) {
  const S none(0.0);
  const Mask<S> in = a.in & b.in;
  const S enters = max(select(a.in, none, a.until), select(b.in, none, b.until));
  return {in, select(in, min(a.until, b.until), enters)};
}
template <class S>
Side<S> outside_of(const Side<S>& a) {
  return {!a.in, a.until};
}
template <class S>
Side<S> either(const Side<S>& a, const Side<S>& b) {
  return outside_of(both(outside_of(a), outside_of(b)));
}

/// A ray as a primitive sees it: in its frame, with lengths in its half extents.
template <class S>
struct Approach {
  Vec3<S> Y, W;  ///< position and slope
  S change;      ///< of W at most, as long as the bounds hold
  S bend;        ///< of |dW/dlambda| at most

  Approach(const Primitive& primitive, const Sight<S>& ray) {
    double stretch = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double scale = 1 / primitive.half[i];
      const auto axis = convert<S>(primitive.axes[i]);
      Y[i] = S(scale) * dot(axis, ray.X - convert<S>(primitive.centre));
      W[i] = S(scale) * dot(axis, ray.slope);
      stretch = std::max(stretch, scale);
    }
    bend = S(stretch) * ray.bend_max;
    change = select(ray.bend_max > S(0.0), bend * ray.valid, S(0.0));
  }
  /// Without what happens along the axis.
  Approach across() const {
    Approach out = *this;
    out.Y[2] = out.W[2] = S(0.0);
    return out;
  }
};

/// The ball of radius R: F = |Y|^2 - R^2 has F'' / 2 = |W|^2 + Y.W', between `least` and `most`.
template <class S>
Side<S> side_of_ball(const Approach<S>& ray, const S& valid, const S& radius) {
  const S along = dot(ray.Y, ray.W), distance = norm(ray.Y), speed2 = dot(ray.W, ray.W), speed = sqrt(speed2);
  const S fastest = speed + ray.change, slowest = max(speed - ray.change, S(0.0));
  const S bowed = ray.bend * distance + fastest * ray.change;
  const S least = slowest * slowest - bowed, most = max(fastest * fastest + bowed, S(1e-300));
  const auto outward = along > S(0.0), in = distance < radius;

  // From afar the impact parameter is known to rounding of |Y|: aim at a ball larger by that. The
  // discriminant (Y.W)^2 - least F without cancellation; its last term is zero along straight lines.
  const S R = radius + S(4e-15) * distance, F = (distance - R) * (distance + R);
  const Vec3<S> moment = cross(ray.Y, ray.W);
  const S bending = max(speed2 * S(1 - 1e-14) - least, S(0.0)) * F;
  const S discriminant = speed2 * R * R - dot(moment, moment) + bending;
  const S denominator = sqrt(max(discriminant, S(0.0))) - along;
  const auto meets = (discriminant >= S(0.0)) & (denominator > S(0.0));
  const S towards = max(select(meets, F / denominator, valid), (distance - R) / max(fastest, S(1e-300)));
  // Who moves away has first to turn round.
  const S back = min(least, S(-1e-300));
  const S away = (along + sqrt(along * along - back * max(F, S(0.0)))) / -back;

  const S G = max((radius - distance) * (radius + distance), S(0.0)), root = sqrt(along * along + most * G);
  const S leaves = select(outward, G / max(along + root, S(1e-300)), (root - along) / most);
  return {in, select(in, leaves, select(outward, away, towards))};
}

/// What lies between the planes Y_i = -L and Y_i = L.
template <class S>
Side<S> side_of_slab(const Approach<S>& ray, std::size_t i, const S& L) {
  const S Y = ray.Y[i], W = ray.W[i], outside = abs(Y) - L;
  const auto in = outside < S(0.0);
  const S enters = plane_step(max(outside, S(0.0)), select(Y < S(0.0), -W, W), ray.bend);
  const S leaves =
      min(plane_step(max(L - Y, S(0.0)), -W, ray.bend), plane_step(max(L + Y, S(0.0)), W, ray.bend));
  return {in, select(in, leaves, enters)};
}

/// A closed primitive, larger by the length `grown`.
template <class S>
Side<S> side_of(const Primitive& primitive, const Sight<S>& ray, const S& grown) {
  const Approach<S> near(primitive, ray);
  const auto limit = [&](std::size_t i) { return S(1.0) + S(1 / primitive.half[i]) * grown; };
  switch (primitive.type) {
    case PrimitiveType::box:
      return both(side_of_slab(near, 2, limit(2)),
                  both(side_of_slab(near, 0, limit(0)), side_of_slab(near, 1, limit(1))));
    case PrimitiveType::cylinder:
      return both(side_of_slab(near, 2, limit(2)), side_of_ball(near.across(), ray.valid, limit(0)));
    default: {
      const double least = std::min(primitive.half[0], std::min(primitive.half[1], primitive.half[2]));
      return side_of_ball(near, ray.valid, S(1.0) + S(1 / least) * grown);
    }
  }
}

/// A step that cannot reach a tube or a disk. Within `resolution` (a length of lambda) it counts as met.
template <class S>
S step_to_sheet(const Primitive& primitive, const Sight<S>& ray, const S& resolution) {
  const Approach<S> near(primitive, ray);
  const S one(1.0), none(0.0), rho = sqrt(near.Y[0] * near.Y[0] + near.Y[1] * near.Y[1]);
  const auto within = [&](const Side<S>& region, const S& surface) {
    return max(surface, select(region.in, none, region.until));
  };
  S until, off, beside;  // the surface's own distance, and how far the point is from where it is
  const Side<S> round = side_of_ball(near.across(), ray.valid, one);
  if (primitive.type == PrimitiveType::tube) {
    until = within(side_of_slab(near, 2, one), round.until);
    off = S(primitive.half[0]) * (rho - one);
    beside = S(primitive.half[2]) * max(abs(near.Y[2]) - one, none);
  } else {
    const Side<S> hole = side_of_ball(near.across(), ray.valid, S(primitive.hole));
    const S away = select(near.Y[2] < none, -near.W[2], near.W[2]);
    until = within(primitive.hole > 0 ? both(round, outside_of(hole)) : round,
                   plane_step(abs(near.Y[2]), away, near.bend));
    off = near.Y[2];
    beside = S(primitive.half[0]) * max(max(rho - one, S(primitive.hole) - rho), none);
  }
  const S by_distance = sqrt(off * off + beside * beside) / ray.slope_max;
  return select(by_distance <= resolution, none, max(until, by_distance));
}

/// How far a ray that meets the sheet here has to go on to be past it: within `rounding` it counts as met,
/// and the flatter a ray meets it, the longer it stays so near.
template <class S>
S skip_sheet(const Primitive& primitive, const Sight<S>& ray, const S& rounding, double ball) {
  const Approach<S> near(primitive, ray);
  const S deep = S(64.0) * rounding * ray.slope_max;
  if (primitive.type == PrimitiveType::disk)
    return min(deep / max(abs(near.W[2]), S(1e-300)), S(2 * ball) / ray.slope_max);
  const S rho = sqrt(near.Y[0] * near.Y[0] + near.Y[1] * near.Y[1]);
  const S steep =
      S(primitive.half[0]) * abs(near.Y[0] * near.W[0] + near.Y[1] * near.W[1]) / max(rho, S(1e-300));
  return min(deep / max(steep, S(1e-300)), S(2.0) * sqrt(S(2 * primitive.half[0]) * deep) / ray.slope_max);
}

NULLCONE_KERNEL_END
