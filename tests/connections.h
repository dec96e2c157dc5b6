// Lamps for tests of connections, and all connections with them.
#pragma once

#include <vector>

#include "core/trace/objects.h"
#include "metrics/goedel_kernel.h"
#include "metrics/minkowski_kernel.h"
#include "tests/random_rays.h"

namespace nullcone::test {

using namespace nullcone::host;

template <class M>
LampLine<M> lamp_at_rest(const M& metric, const Vec4<double>& place) {
  LampLine<M> line;
  line.metric = metric;
  line.place = place;
  return line;
}

template <class M>
LampLine<M> falling_lamp(const M& metric, const Vec4<double>& start, const Vec3<double>& velocity,
                         double ball = 1e-3, bool gyroscope = false) {
  LampLine<M> line;
  line.metric = metric;
  line.rests = false;
  Placing placing;
  placing.worldline.velocity = velocity.c;
  placing.gyroscope_axes = gyroscope;
  line.body = local_body(metric, start, placing, ball);
  return line;
}

/// Those of all branches, in their order.
template <class S, class M>
std::vector<Connection<S>> all_connections(const M& metric, const Vec4<S>& event, const LampLine<M>& line,
                                           int windings) {
  std::vector<Connection<S>> out;
  for (int branch = 0; branch < branches(metric, line, windings); ++branch) {
    const Connection<S> one = connect(metric, event, line, branch);
    if (one.found) out.push_back(one);
  }
  return out;
}

/// det D of equation (5.1).
inline double area(const Goedel& metric, double lambda, double n_z) {
  const double n2 = n_z * n_z, psi = std::sqrt(1 + n2) * lambda / (2 * metric.a);
  return 4 * metric.a * metric.a * std::sin(psi) * ((1 - n2) * psi * std::cos(psi) + 2 * n2 * std::sin(psi)) /
         ((1 + n2) * (1 + n2));
}

/// How far the ray ends from where the connection says, in space, time and direction: at most this, a scale.
template <class M>
double miss(const M& metric, const Vec4<double>& event, const Connection<double>& c) {
  const PathPoint<double> end = metric.path(event, c.past).at(c.lambda);
  double worst = 0;
  const double scale = c.lambda + norm(event) + norm(c.emitted);
  for (std::size_t i = 0; i < 4; ++i) {
    worst = std::fmax(worst, std::fabs(end.event[i] - c.emitted[i]) / scale);
    worst = std::fmax(worst, std::fabs(end.tangent[i] - c.tangent[i]) / norm(end.tangent));
  }
  return worst;
}

}  // namespace nullcone::test
