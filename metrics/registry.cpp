#include "metrics/registry.h"

#include <metric_list.h>  // made by CMake

#include "core/base/error.h"

namespace nullcone {

#define NULLCONE_DECLARE(metric, isa) const Spacetime& metric##_##isa();
NULLCONE_KERNEL_LIST(NULLCONE_DECLARE)
#undef NULLCONE_DECLARE

namespace {

struct Entry {
  std::string_view metric, isa;
  const Spacetime& (*get)();
};
/// The widest instruction set of each spacetime first.
constexpr Entry kEntries[] = {
#define NULLCONE_ENTRY(metric, isa) {#metric, #isa, metric##_##isa},
    NULLCONE_KERNEL_LIST(NULLCONE_ENTRY)
#undef NULLCONE_ENTRY
};

/// Whether this machine can run the code (levels x86-64, -v3 and -v4).
bool runs_here(std::string_view isa) {
  if (isa == "avx512")
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl") && runs_here("avx2");
  if (isa == "avx2")
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
  return true;
}

}  // namespace

std::vector<MetricDescription> metric_descriptions() {
  std::vector<MetricDescription> out;
  for (const Entry& entry : kEntries)
    if (entry.isa == "sse2") out.push_back(entry.get().description());  // the description is the same for all
  return out;
}

std::vector<std::string_view> instruction_sets() {
  std::vector<std::string_view> out;
  for (const Entry& entry : kEntries)
    if (entry.metric == kEntries[0].metric && runs_here(entry.isa)) out.push_back(entry.isa);
  return out;
}

const Spacetime& find_spacetime(std::string_view metric, std::string_view isa) {
  std::string names;
  bool known = false;
  for (const Entry& entry : kEntries) {
    if (entry.metric == metric && (isa.empty() || entry.isa == isa)) {
      known = true;
      if (runs_here(entry.isa)) return entry.get();
    }
    names += (names.empty() ? "" : ", ") + std::string(entry.metric) + "/" + std::string(entry.isa);
  }
  const std::string place = "metric " + printable(metric, 40) + (isa.empty() ? "" : "/" + printable(isa, 40));
  if (known) throw InputError(place, "this machine does not have that instruction set");
  throw InputError(place, "unknown; expected one of " + names);
}

}  // namespace nullcone
