// Options of tools that name a spacetime: --set key=value.
#pragma once

#include <string>
#include <vector>

#include "core/scene/read_scene.h"

namespace nullcone {

/// Values of a metric's parameters in their order: defaults, overridden by settings "key=value" with a
/// number, or with one of the parameter's words. Throws InputError for anything else.
std::vector<double> parameter_values(const MetricDescription& metric,
                                     const std::vector<std::string>& settings);

}  // namespace nullcone
