// The checks of one spacetime: compiled once a metric, for one lane.
#include "metrics/check.h"

#include NULLCONE_METRIC_HEADER

#include "core/trace/check_metric.h"
#include "metrics/make_metric.h"

namespace nullcone {

std::vector<CheckResult> NULLCONE_CHECK(std::span<const double> parameters, const CheckOptions& options) {
  return host::check_metric(host::make_metric<host::NULLCONE_METRIC>(parameters), options);
}

}  // namespace nullcone
