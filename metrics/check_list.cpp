#include <metric_list.h>  // made by CMake
#include "core/base/error.h"
#include "metrics/check.h"

namespace nullcone {

#define NULLCONE_DECLARE(metric) \
  std::vector<CheckResult> check_##metric(std::span<const double>, const CheckOptions&);
NULLCONE_METRIC_LIST(NULLCONE_DECLARE)
#undef NULLCONE_DECLARE

std::vector<CheckResult> check_spacetime(std::string_view name, std::span<const double> parameters,
                                         const CheckOptions& options) {
#define NULLCONE_DISPATCH(metric) \
  if (name == #metric) return check_##metric(parameters, options);
  NULLCONE_METRIC_LIST(NULLCONE_DISPATCH)
#undef NULLCONE_DISPATCH
  throw InputError("metric " + printable(name, 40), "unknown");
}

}  // namespace nullcone
