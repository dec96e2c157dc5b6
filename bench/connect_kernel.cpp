// The timed loop over connections, compiled once an instruction set.
#include "bench/connect.h"
#include "bench/cpu_seconds.h"
#include "core/trace/objects.h"
#include "metrics/goedel_kernel.h"
#include "metrics/minkowski_kernel.h"

NULLCONE_KERNEL_BEGIN

using namespace nullcone::study;

template <Metric M>
LampLine<M> lamp(const M& metric, const ConnectCase& given) {
  LampLine<M> line;
  line.metric = metric;
  line.rests = !given.moves;
  line.place = {{0, 0.4, -0.3, 0.2}};
  Placing placing;
  placing.worldline.velocity = given.velocity;
  if (given.moves) line.body = local_body(metric, line.place, placing, 1e-3);
  return line;
}

template <Metric M>
ConnectTiming loop(const M& metric, const ConnectCase& given,
                   const std::vector<std::array<double, 4>>& events) {
  constexpr std::size_t kLanes = Lanes<Pack>::count;
  const LampLine<M> line = lamp(metric, given);
  ConnectTiming out{0, 0, 0};
  const double begin = cpu_seconds();
  for (std::size_t i = 0; i + kLanes <= events.size(); i += kLanes) {
    const auto event = Vec4<Pack>::map([&](std::size_t c) {
      std::array<double, kLanes> lanes;
      for (std::size_t lane = 0; lane < kLanes; ++lane) lanes[lane] = events[i + lane][c];
      return Lanes<Pack>::load(lanes.data());
    });
    for (int branch = 0; branch < std::min(2, branches(metric, line, 1)); ++branch) {
      const Connection<Pack> one = connect(metric, event, line, branch);
      std::array<bool, kLanes> found;
      Lanes<Pack>::store(one.found & (one.det == one.det) & (one.tangent[1] == one.tangent[1]), found.data());
      for (const bool is : found) out.found += is;
      out.asked += kLanes;
    }
  }
  out.seconds = cpu_seconds() - begin;
  return out;
}

NULLCONE_KERNEL_END

namespace nullcone::study {

ConnectTiming NULLCONE_CONNECT_LOOP(const ConnectCase& given,
                                    const std::vector<std::array<double, 4>>& events) {
  using namespace NULLCONE_ISA;
  return given.goedel ? loop(Goedel{1}, given, events) : loop(Minkowski{}, given, events);
}

}  // namespace nullcone::study
