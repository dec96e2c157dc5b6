// What a connection costs: cases, and the timed loop of each instruction set.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace nullcone::study {

struct ConnectCase {
  const char* name;
  bool goedel;  ///< or Minkowski
  bool moves;
  std::array<double, 3> velocity;
};

struct ConnectTiming {
  double seconds;
  std::size_t asked, found;
};
/// Connects the events, pack by pack, by each of the first two branches (in flat spacetime there is one).
using ConnectLoop = ConnectTiming (*)(const ConnectCase&, const std::vector<std::array<double, 4>>& events);

ConnectTiming connect_sse2(const ConnectCase&, const std::vector<std::array<double, 4>>& events);
ConnectTiming connect_avx2(const ConnectCase&, const std::vector<std::array<double, 4>>& events);
ConnectTiming connect_avx512(const ConnectCase&, const std::vector<std::array<double, 4>>& events);

}  // namespace nullcone::study
