// Connections in the Gödel universe: light from a lamp to an event, branch by branch (docs/physics.md).
#pragma once

#include "core/trace/connection.h"
#include "metrics/goedel_fast_lamp.h"

NULLCONE_KERNEL_BEGIN

/// How many kinds of connections there are with a lamp at rest: two in each lobe, of which the first are
/// those before the fold.
inline int branches(const Goedel&, int windings) { return 2 * windings; }

/// The same for a lamp that may move: a fast one can be seen twice in one branch.
inline int branches(const Goedel& metric, const LampLine<Goedel>& line, int windings) {
  return branches_of_lobe(metric, line) * windings;
}

/// The connection for the lamp's event `emitted`, which stands at `place` in the chart about `event`.
template <class S>
Connection<S> connection_along(const Goedel& metric, const Vec4<S>& event, const GoedelPlace<S>& place,
                               const GoedelLight<S>& light, const Vec4<S>& emitted) {
  const S s = light.speed, up = place.at[3] / light.lambda, one(1.0);
  const Complex<S> seen = s * (place.direction * light.theta);
  // The static tetrad at the lamp is turned against that of the chart about the event.
  const Complex<S> left = s * (place.direction * conj(light.theta) * conj(metric.turn(event, emitted)));
  Vec4<S> tangent = metric.in_plane(emitted, left);
  tangent[0] = tangent[0] - one;
  tangent[3] = up;
  Connection<S> out;
  out.past = {{-one, seen.re, seen.im, up}};
  out.lambda = light.lambda;
  out.det = light.det;
  out.emitted = emitted;
  out.tangent = tangent;
  return out;
}

template <class S>
Connection<S> connect_at_rest(const Goedel& metric, const Vec4<S>& event, const LampLine<Goedel>& line,
                              const GoedelBranch& branch) {
  const Vec4<S> lamp = convert<S>(line.place);
  const GoedelPlace<S> place(metric, metric.to_origin(event, lamp));
  const GoedelLight<S> light = light_to(metric, branch, place.u0, place.zeta);
  const S tau = -(light.time + place.at[0]);
  Vec4<S> emitted = lamp;
  emitted[0] = emitted[0] + tau;
  Connection<S> out = connection_along(metric, event, place, light, emitted);
  out.tau = tau;
  out.found = light.exists;
  return out;
}

template <class S>
GoedelEmission<S> emission_of(const Goedel& metric, const Vec4<S>& event, const LampLine<Goedel>& line,
                              const GoedelBranch& branch, int which) {
  const GoedelEmissionSearch<S> search{metric, event, line, branch};
  return branches_of_lobe(metric, line) == 2 ? search.only() : FastLampSearch<S>{search}.emission(which);
}

/// Light that a lamp sends to an event, of branch `branch` < branches(metric, line, windings). On caustics
/// (the axis through a lamp at rest) det is 0, and one direction stands for a ring of them.
template <class S>
Connection<S> connect(const Goedel& metric, const Vec4<S>& event, const LampLine<Goedel>& line, int branch) {
  const int in_lobe = branches_of_lobe(metric, line), which = branch % in_lobe;
  const GoedelBranch light{branch / in_lobe, which % 2 == 1};
  if (line.rests) return connect_at_rest(metric, event, line, light);
  const GoedelEmission<S> emission = emission_of(metric, event, line, light, which / 2);
  Connection<S> out = connection_along(metric, event, emission.place, emission.light, emission.event);
  out.tau = emission.tau;
  out.found = emission.found;
  return out;
}

NULLCONE_KERNEL_END
