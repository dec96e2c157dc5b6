// All connections between a lamp at rest and one event by shooting, for reports.
#pragma once

#include <vector>

#include "core/trace/lamp_scan.h"

NULLCONE_KERNEL_BEGIN

/// By affine length; light that sweeps less than windings 2 pi about the chart's origin. Nothing, and not
/// complete, where the lamp or the observer cannot be at rest.
template <Metric M>
ConnectionsReport shoot_connections(const M& metric, const Accuracy& accuracy, const Vec4<double>& event,
                                    const Vec3<double>& source, int windings) {
  const Vec4<double> place = {{event[0], source[0], source[1], source[2]}};
  ConnectionsReport out;
  out.complete = metric.g(place)[0][0] > 0 && metric.g(event)[0][0] > 0;
  if (!out.complete) return out;
  constexpr double kTarget = 1e-3;  // of the length scale
  const Ball target{spatial(event), kTarget * length_scale(metric, event)};
  const LampScan<M> scan(metric, accuracy, place, windings, default_lookback(metric), &target, 1);
  std::array<Connection<double>, LampScan<M>::kMostConnections> found{};
  std::array<int, LampScan<M>::kMostConnections> winding{};
  const std::size_t count = scan.connect(event, found.data(), winding.data(), found.size(), out.complete);
  out.connections = std::vector<ConnectionReport>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Connection<double>& c = found[i];
    out.connections[i] = {c.lambda,           event[0] - c.emitted[0],
                          spatial(c.past).c,  std::sqrt(std::fabs(c.det)),
                          c.det < 0 ? -1 : 1, winding[i]};
  }
  return out;
}

NULLCONE_KERNEL_END
