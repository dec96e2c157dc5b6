// The order of integrated rays in centrally symmetric spacetimes.
//
// All rays from one event that lie in the planes through it and the centre meet again behind the centre, and
// in front of it after a whole turn: these are the caustics of the observer's light cone, at every multiple
// of pi of the angle phi that a ray has swept about the centre. So order = floor(phi/pi), which is how often
// the ray has changed sides of the axis through observer and centre, in its plane. Exact in spherical
// symmetry; with spin the caustics are small tubes about that axis, and rays that pass near them are counted
// by their sides of the first plane alone.
#pragma once

#include "core/trace/flights.h"

NULLCONE_KERNEL_BEGIN

template <class S>
struct Turning {
  Vec3<S> axis;  ///< in the ray's first plane, at right angles to the way to the centre; 0 for radial rays
  S turns;

  /// How many turns there are when the ray has come on to X.
  S at(const Vec3<S>& X) const {
    const S odd = turns - S(2.0) * floor(S(0.5) * turns), side = S(1.0) - S(2.0) * odd;
    return select(dot(X, axis) * side < S(0.0), turns + S(1.0), turns);
  }
};

/// The part of a ray's first direction that leads round the centre. Taken twice, lest rounding of the first
/// time, for nearly radial rays, hide the axis that it stands on.
template <class S>
Vec3<S> turning_axis(const Vec3<S>& X, const Vec3<S>& direction) {
  const S over = S(1.0) / dot(X, X);
  Vec3<S> axis = direction;
  for (int i = 0; i < 2; ++i) axis = axis - (dot(axis, X) * over) * X;
  const auto radial = dot(axis, axis) <= S(1e-24) * dot(direction, direction);
  return select(radial | !(over < S(std::numeric_limits<double>::infinity())), Vec3<S>{}, axis);
}

template <class S>
Turning<S> load_turning(const Group<S>& group, const Flights& flights) {
  return {Vec3<S>::map([&](std::size_t i) { return group.load(flights.axis[i]); }),
          group.load(flights.turns)};
}

NULLCONE_KERNEL_END
