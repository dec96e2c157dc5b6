// What a search for crossings knows of a ray near an object, and what it may conclude from it.
#pragma once

#include "core/base/vector.h"

NULLCONE_KERNEL_BEGIN

/// Stands for "as far as you like": a step this long ends the search.
inline constexpr double kFar = 1e300;
/// Stands for a place that nothing reaches; its square is finite.
inline constexpr double kOutOfReach = 1e100;

/// The ray at one affine parameter, seen from an object: position X and slope dX/dlambda in the object's
/// frame, and bounds that hold for the next `valid` of lambda. Where the object is far away, only `clearance`
/// is set.
template <class S>
struct Sight {
  Vec3<S> X, slope;
  S clearance{};  ///< the object's bounding ball is not met before this; 0 where X and slope are to be used
  S valid{};      ///< > 0
  S slope_min{}, slope_max{};  ///< of |dX/dlambda|
  S bend_max{};                ///< of |d2X/dlambda2|
};

/// The smallest delta >= 0 at which f + f' delta + c delta^2/2 = 0 for f > 0, or `none`. If c is a lower
/// bound of f'', then f has no root before delta.
template <class S>
S first_root(const S& f, const S& slope, const S& c, const S& none) {
  const S discriminant = slope * slope - S(2.0) * c * f;
  const S denominator = sqrt(max(discriminant, S(0.0))) - slope;
  const auto meets = (discriminant >= S(0.0)) & (denominator > S(0.0));
  return select(meets, S(2.0) * f / denominator, none);
}

/// A step that cannot reach a plane at the distance f >= 0, which changes at the rate `slope`, and its rate
/// by at most `bend` >= 0: the root of f + f' delta - bend delta^2/2, without cancellation. Who moves away
/// has first to turn round.
template <class S>
S plane_step(const S& f, const S& slope, const S& bend) {
  const S root = sqrt(slope * slope + S(2.0) * bend * f);
  const auto away = slope > S(0.0);
  return select(away, slope + root, S(2.0) * f) / max(select(away, bend, root - slope), S(1e-307));
}

NULLCONE_KERNEL_END
