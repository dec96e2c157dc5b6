// What a connection with a lamp costs, for every instruction set: lamps at rest and in free fall.
#include "bench/connect.h"

#include <benchmark/benchmark.h>

#include <random>
#include <string>

namespace {

using namespace nullcone::study;

constexpr ConnectCase kCases[] = {
    {"minkowski, at rest", false, false, {}},
    {"minkowski, 0.6 c", false, true, {0.48, 0, 0.36}},
    {"goedel, at rest", true, false, {}},
    {"goedel, 0.1 c", true, true, {0.08, 0.06, 0}},
    {"goedel, 0.5 c in the plane", true, true, {0.4, 0.3, 0}},
    {"goedel, 0.5 c with a drift", true, true, {0.3, 0, 0.4}},
    {"goedel, 0.9 c", true, true, {0.7, 0.4, 0.4}},
};

/// Events all over the region that a lamp near the axis lights.
std::vector<std::array<double, 4>> some_events() {
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> place(-1, 1);
  std::vector<std::array<double, 4>> out(16000);
  for (auto& event : out) event = {3 * place(engine), place(engine), place(engine), place(engine)};
  return out;
}

void connections(benchmark::State& state, const ConnectCase& given, ConnectLoop loop) {
  const auto events = some_events();
  ConnectTiming timing{0, 1, 0};
  std::size_t asked = 0;
  double seconds = 0;
  for ([[maybe_unused]] auto _ : state) {
    timing = loop(given, events);
    state.SetIterationTime(timing.seconds);
    asked += timing.asked;
    seconds += timing.seconds;
  }
  state.counters["ns_each"] = 1e9 * seconds / static_cast<double>(asked);
  state.counters["found"] = static_cast<double>(timing.found) / static_cast<double>(timing.asked);
}

}  // namespace

int main(int argc, char** argv) {
  struct {
    const char* name;
    ConnectLoop loop;
    bool runs;
  } const loops[] = {{"sse2", connect_sse2, true},
                     {"avx2", connect_avx2, __builtin_cpu_supports("avx2") != 0},
                     {"avx512", connect_avx512, __builtin_cpu_supports("avx512dq") != 0}};
  for (const ConnectCase& given : kCases)
    for (const auto& [name, loop, runs] : loops)
      if (runs)
        benchmark::RegisterBenchmark((std::string("connect/") + given.name + "/" + name).c_str(), connections,
                                     given, loop)
            ->UseManualTime();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
