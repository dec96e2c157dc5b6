#include "metrics/registry.h"

#include <array>

#include "core/base/error.h"

namespace nullcone {

// Adding a spacetime: its header, a line here and one in CMakeLists.txt.
#define NULLCONE_DECLARE(metric) const Spacetime& metric##_sse2();
NULLCONE_DECLARE(minkowski)
NULLCONE_DECLARE(goedel)
#undef NULLCONE_DECLARE

namespace {

struct Entry {
  std::string_view metric, isa;
  const Spacetime& (*get)();
};
constexpr std::array kEntries = {Entry{"minkowski", "sse2", minkowski_sse2},
                                 Entry{"goedel", "sse2", goedel_sse2}};

}  // namespace

std::vector<MetricDescription> metric_descriptions() {
  std::vector<MetricDescription> out;
  for (const Entry& entry : kEntries) out.push_back(entry.get().description());
  return out;
}

const Spacetime& find_spacetime(std::string_view metric, std::string_view isa) {
  std::string names;
  for (const Entry& entry : kEntries) {
    if (entry.metric == metric && (isa.empty() || entry.isa == isa)) return entry.get();
    names += (names.empty() ? "" : ", ") + std::string(entry.metric) + "/" + std::string(entry.isa);
  }
  throw InputError("metric " + printable(metric, 40) + (isa.empty() ? "" : "/" + printable(isa, 40)),
                   "unknown; expected one of " + names);
}

}  // namespace nullcone
