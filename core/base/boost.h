// Special relativity in a local tetrad: boosts, aberration, Doppler factor (docs/physics.md; Weiskopf,
// Kraus & Ruder 1999 with g = 1/D; Borchers 2005 eq. 2.5, 2.7 with the misprints of 2.6 and 2.9 corrected).
#pragma once

#include "core/base/vector.h"

NULLCONE_KERNEL_BEGIN

/// gamma (1, beta), without cancellation for |beta| -> 1.
template <class S>
Vec4<S> four_velocity(const Vec3<S>& beta) {
  const S speed = norm(beta);
  const S gamma = S(1.0) / sqrt((S(1.0) - speed) * (S(1.0) + speed));
  return {{gamma, gamma * beta[0], gamma * beta[1], gamma * beta[2]}};
}

/// Components of x in the rest frame of an observer with 4-velocity u = gamma (1, beta); both given in one
/// tetrad. The inverse is the boost with opposite(u).
template <class S>
Vec4<S> boost(const Vec4<S>& u, const Vec4<S>& x) {
  const Vec3<S> w = spatial(u), Y = spatial(x);
  const S along = dot(w, Y);
  const S shift = along / (u[0] + S(1.0)) - x[0];
  return {{u[0] * x[0] - along, Y[0] + shift * w[0], Y[1] + shift * w[1], Y[2] + shift * w[2]}};
}
template <class S>
Vec4<S> opposite(const Vec4<S>& u) {
  return {{u[0], -u[1], -u[2], -u[3]}};
}

/// The wave vector, frequency 1 for an observer of 4-velocity u, of the photon that this observer sees in the
/// look direction m (unit, in the observer's own axes); components in the tetrad in which u is given.
template <class S>
Vec4<S> seen_photon(const Vec4<S>& u, const Vec3<S>& m) {
  return boost(opposite(u), Vec4<S>{{S(1.0), -m[0], -m[1], -m[2]}});
}

NULLCONE_KERNEL_END
