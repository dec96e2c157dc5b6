// The checks of every spacetime, by name.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/trace/check_result.h"

namespace nullcone {

/// Checks the spacetime `name` with the given values of its parameters, in their order. Throws InputError
/// where there is none of that name.
std::vector<CheckResult> check_spacetime(std::string_view name, std::span<const double> parameters,
                                         const CheckOptions& options);

}  // namespace nullcone
