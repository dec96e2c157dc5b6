// The two-point problem of the Gödel universe (docs/physics.md): all light between the origin event of a
// chart and a place at rest, one branch after the other.
//
// With u0 = r/2a and zeta = |z|/(sqrt2 a) of the place, light that comes there after the phase Psi has
//   F(p) = p |sin Psi| / Psi = u0,   p = sqrt(Psi^2 - zeta^2).
// F rises and falls once in each lobe k pi < Psi < (k+1) pi: a near and a far root, which meet on a caustic,
// the fold. In terms of p nothing cancels for zeta -> 0, u0 -> 0 or a -> infinity.
#pragma once

#include <numbers>

#include "core/trace/bracketed_zero.h"
#include "metrics/goedel.h"

NULLCONE_KERNEL_BEGIN

/// One kind of light: of lobe k, and before or behind its fold.
struct GoedelBranch {
  int lobe;
  bool far;

  double sign() const { return lobe % 2 == 0 ? 1 : -1; }  ///< of sin Psi in the lobe
  double start() const { return lobe * std::numbers::pi; }
  double end() const { return (lobe + 1) * std::numbers::pi; }
};

/// What p and zeta tell: sin Psi and the like, with the lobe's sign taken off.
template <class S>
struct GoedelPhase {
  S psi, sine, cosine, sinc;
  S F, slope;  ///< of F, along p

  GoedelPhase(const GoedelBranch& branch, const S& p, const S& zeta) {
    psi = max(sqrt(p * p + zeta * zeta), S(1e-300));
    const auto [s, c] = sincos(psi);
    const S sign(branch.sign()), along = p / psi, across = zeta / psi;
    sine = sign * s;
    cosine = sign * c;
    sinc = sine / psi;
    F = p * sinc;
    slope = across * across * sinc + along * along * cosine;
  }
};

/// Where F is greatest in a lobe. `exists` is false where zeta lies beyond the lobe.
template <class S>
struct GoedelFold {
  Mask<S> exists;
  S zeta;  ///< 0 where the lobe does not exist
  S p, F;
  S decline;  ///< dF/dzeta

  GoedelFold(const GoedelBranch& branch, const S& zeta_of_place) {
    constexpr double kQuarter = 0.5 * std::numbers::pi;
    const S end(branch.end());
    exists = zeta_of_place < end;
    zeta = select(exists, zeta_of_place, S(0.0));
    // zeta^2 sin Psi + Psi p^2 cos Psi = 0, as a function of eta = end - Psi: it rises from eta = 0 on.
    const S room = end - zeta, most = min(room, S(kQuarter));
    const S guess = min(S(kQuarter), room * (S(0.5) + zeta * S(1 / (6 * branch.end()))));
    const auto condition = [&](const S& eta) -> Slope<S> {
      const S psi = end - eta, across = zeta / psi, p2 = (room - eta) * (psi + zeta);
      const auto [s, c] = sincos(eta);
      const S lever = p2 / psi;
      return {across * across * s - lever * c, S(3.0) * c + lever * s};
    };
    const S eta = bracketed_zero(condition, S(0.0), most, guess, exists, 1e-7);
    p = sqrt(max((room - eta) * (end - eta + zeta), S(0.0)));
    const GoedelPhase<S> phase(branch, p, zeta);
    F = phase.F;
    decline = p * zeta * (phase.cosine - phase.sinc) / (phase.psi * phase.psi);
  }
};

/// Light of one branch between the origin of the chart and the place (u0, zeta).
template <class S>
struct GoedelLight {
  Mask<S> exists;
  S lambda;          ///< affine length for frequency 1
  S time;            ///< that it is on its way, by the chart
  S speed;           ///< s: the part of its local velocity in the plane
  Complex<S> theta;  ///< e^{i Theta}, with the lobe's sign
  S det;             ///< det D
};

/// p of the branch's root of F(p) = u0; `exists` says where there is one.
template <class S>
S root_of(const GoedelBranch& branch, const GoedelFold<S>& fold, const S& u0, const Mask<S>& exists) {
  const S zeta = fold.zeta, start(branch.start()), end(branch.end());
  const S bound =
      branch.far ? sqrt((end - zeta) * (end + zeta)) : sqrt(max((start - zeta) * (start + zeta), S(0.0)));
  // Exact for zeta = 0, where F = |sin p|.
  const S part = min(u0 / fold.F, S(1.0));
  const S angle = S(2 / std::numbers::pi) * atan2(part, sqrt((S(1.0) - part) * (S(1.0) + part)));
  const S side(branch.far ? -1.0 : 1.0);
  const auto lack = [&](const S& p) -> Slope<S> {
    const GoedelPhase<S> phase(branch, p, zeta);
    return {side * (phase.F - u0), side * phase.slope};
  };
  return bracketed_zero(lack, min(bound, fold.p), max(bound, fold.p), bound + (fold.p - bound) * angle,
                        exists, 1e-10);
}

/// From p and zeta to all that light is.
template <class S>
GoedelLight<S> light_at(const Goedel& metric, const GoedelBranch& branch, const S& p, const S& zeta,
                        const S& u0) {
  const GoedelPhase<S> phase(branch, p, zeta);
  const S psi = phase.psi, s = phase.sine, c = phase.cosine;
  const S length = sqrt(psi * psi + p * p), along = p / length, kappa = psi / length;
  GoedelLight<S> out;
  out.speed = S(Goedel::kSqrt2) * along;
  out.lambda = S(Goedel::kSqrt2 * metric.a) * length;
  const S lag = along * along / (S(1.0) + kappa);  // 1 - kappa
  const S Theta = psi + atan2(lag * s * c, kappa * c * c + s * s);
  out.time = S(2 * Goedel::kSqrt2 * metric.a) * Theta - out.lambda;
  const S over_norm = S(1.0) / sqrt(kappa * kappa * c * c + s * s);
  out.theta = {over_norm * kappa * c, over_norm * s};
  // Equation (5.1) in these terms. Where the light comes round near the axis, sin Psi / Psi = u0 / p exactly.
  const Mask<S> round = (psi > S(1.0)) & (p > S(0.5));
  out.det = out.lambda * out.lambda * select(round, u0 / p, phase.sinc) * phase.slope;
  return out;
}

/// On the axis the far light of one lobe and the near light of the next are one ring: it counts as far.
template <class S>
GoedelLight<S> light_to(const Goedel& metric, const GoedelBranch& branch, const S& u0, const S& zeta) {
  const GoedelFold<S> fold(branch, zeta);
  Mask<S> exists = fold.exists & (u0 <= fold.F);
  if (!branch.far) exists = exists & ((u0 > S(0.0)) | (zeta >= S(max(branch.start(), 1e-300))));
  const S p = any(exists) ? root_of(branch, fold, u0, exists) : fold.p;
  GoedelLight<S> out = light_at(metric, branch, p, fold.zeta, u0);
  out.exists = exists & (out.lambda > S(0.0));
  return out;
}

NULLCONE_KERNEL_END
