// The list of spacetimes, by name and instruction set.
#pragma once

#include <string_view>
#include <vector>

#include "core/trace/spacetime.h"

namespace nullcone {

/// What the scene reader must know of every spacetime.
std::vector<MetricDescription> metric_descriptions();

/// The instruction sets that this machine has and kernels exist for, widest first.
std::vector<std::string_view> instruction_sets();

/// The kernel of a spacetime for the best instruction set of this machine, or for the one named by `isa`.
/// Throws InputError where there is none.
const Spacetime& find_spacetime(std::string_view metric, std::string_view isa = "");

}  // namespace nullcone
