// What nullcone-check-metric finds out, a line a check.
#pragma once

#include <cstddef>
#include <string>

namespace nullcone {

struct CheckOptions {
  unsigned seed = 1;
  int events = 400;
};

struct CheckResult {
  std::string name;
  double worst = 0, limit = 0;  ///< relative errors; it holds where worst <= limit
  std::size_t events = 0;       ///< at how many it was tried
  std::string where;            ///< of the worst: component, event and both values
  bool holds() const { return events > 0 && worst <= limit; }
};

}  // namespace nullcone
