// What a lamp's scan finds at an event.
#pragma once

#include <vector>

#include "core/trace/shoot_connections.h"

namespace nullcone::test {
namespace {

using namespace host;

constexpr Accuracy kSharp{1e-12, 0, Integrator::prince_dormand87};
constexpr double kPi = std::numbers::pi;

struct Found {
  std::vector<Connection<double>> connections;
  std::vector<int> windings;
  bool complete = true;
};
template <class M>
Found connect(const LampScan<M>& scan, const Vec4<double>& event) {
  Found out;
  out.connections.resize(LampScan<M>::kMostConnections);
  out.windings.resize(LampScan<M>::kMostConnections);
  const std::size_t n =
      scan.connect(event, out.connections.data(), out.windings.data(), out.connections.size(), out.complete);
  out.connections.resize(n), out.windings.resize(n);
  return out;
}
/// Of a target that is hardly more than the event.
template <class M>
Found connect(const M& metric, const Vec4<double>& event, const Vec3<double>& lamp, int windings,
              double lookback = 1e12) {
  const Ball target{spatial(event), 1e-3};
  return connect(
      LampScan<M>(metric, kSharp, {{0, lamp[0], lamp[1], lamp[2]}}, windings, lookback, &target, 1), event);
}

}  // namespace
}  // namespace nullcone::test
