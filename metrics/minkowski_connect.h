// Connections in flat spacetime: the retarded position of a lamp (docs/physics.md).
#pragma once

#include "core/trace/connection.h"
#include "metrics/minkowski_sight.h"

NULLCONE_KERNEL_BEGIN

inline int branches(const Minkowski&, int) { return 1; }
inline int branches(const Minkowski&, const LampLine<Minkowski>&, int) { return 1; }

/// Light that a lamp on a straight worldline sends to an event, without cancellation at any speed.
template <class S>
Connection<S> connect(const Minkowski&, const Vec4<S>& event, const LampLine<Minkowski>& line, int) {
  Vec4<double> first = line.place, u = {{1, 0, 0, 0}};
  if (!line.rests) first = line.body.event(0.0, line.X), u = line.body.frame.u;
  // P: from the lamp to the event when it receives the light. lambda^2 = |P + V lambda|^2, V = w/gamma.
  const Vec4<S> since = event - convert<S>(first);
  const S gamma(u[0]), over_gamma(1 / u[0]), elapsed = over_gamma * since[0];
  const Vec3<S> w = convert<S>(spatial(u)), P = spatial(since) - elapsed * w;
  const S P2 = dot(P, P), along = dot(w, P), root = sqrt(along * along + P2);
  Connection<S> out;
  out.lambda = gamma * select(along > S(0.0), root + along, P2 / (root - along));
  out.found = P2 > S(0.0);
  const Vec3<S> ray = P + (over_gamma * out.lambda) * w;
  const Vec3<S> m = (S(-1.0) / norm(ray)) * ray;
  out.past = {{S(-1.0), m[0], m[1], m[2]}};
  out.tangent = out.past;
  out.det = out.lambda * out.lambda;
  out.tau = over_gamma * (since[0] - out.lambda);
  out.emitted = convert<S>(first) + out.tau * convert<S>(u);
  return out;
}

NULLCONE_KERNEL_END
