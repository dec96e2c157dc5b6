// Null geodesics from a lamp to an event: what lights a surface.
//
// A metric with closed-form paths offers (metrics/<name>_connect.h, found by overloading)
//   branches(metric, windings) -> int     how many kinds of connections there are with lamps at rest, each
//   with one solution at most
//   branches(metric, line, windings) -> int    with this lamp: it may have more if it moves
//   connect(metric, event, line, branch)  the solution of one kind, for Vec4<S> event and a LampLine
// Others are found by shooting (shooting.h).
#pragma once

#include "core/trace/objects.h"

NULLCONE_KERNEL_BEGIN

/// A null geodesic from a lamp to an event, followed from the event into the past.
template <class S>
struct Connection {
  Mask<S> found;  ///< else nothing here means anything
  Vec4<S> past;   ///< tangent at the event, past-directed, in the static tetrad: (-1, direction to the lamp)
  S lambda;       ///< affine length, with k.u = 1 for the observer at rest at the event
  S tau;          ///< the lamp's proper time when it emits
  S det;  ///< det D with its vertex at the event, for that k; negative after an odd number of caustics
  Vec4<S> emitted;  ///< the event of emission
  Vec4<S> tangent;  ///< chart components of the past-directed tangent there
};

/// One lane of many.
template <class S>
Connection<double> lane_of(const Connection<S>& c, std::size_t lane) {
  std::array<bool, Lanes<S>::count> found{};
  Lanes<S>::store(c.found, found.data());
  const auto of = [&](const S& x) { return Lanes<S>::get(x, lane); };
  const auto of4 = [&](const Vec4<S>& v) {
    return Vec4<double>::map([&](std::size_t i) { return of(v[i]); });
  };
  return {found[lane], of4(c.past), of(c.lambda), of(c.tau), of(c.det), of4(c.emitted), of4(c.tangent)};
}

/// The worldline of a lamp, or of one point of its shape: at rest in the static tetrad, or a point of a rigid
/// body on a geodesic.
template <Metric M>
struct LampLine {
  M metric;
  bool rests = true;
  Vec4<double> place{};  ///< at rest: its event at proper time 0
  LocalBody<M> body{};   ///< moving
  Vec3<double> X{};      ///< moving: which point of the body

  /// The event at the lamp's proper time tau; scalars may be duals, then d/dtau comes along.
  template <class S>
  Vec4<S> event(const S& tau) const {
    if (!rests) return body.event(tau, convert<S>(X));
    Vec4<S> out = convert<S>(place);
    out[0] = out[0] + S(1 / sqrt(metric.g(place)[0][0])) * tau;
    return out;
  }
  /// A proper time at which the lamp is roughly simultaneous with an event.
  template <class S>
  S guess(const Vec4<S>& at) const {
    if (!rests) return body.first_guess(at);
    return S(sqrt(metric.g(place)[0][0])) * (at[0] - S(place[0]));
  }
};

NULLCONE_KERNEL_END
