// When an object emitted the light that is seen.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/record/dataset.h"

namespace nullcone::view {

/// How many crossings with `object` have which time, `channel` "t" or "tau" (the object's own clock, its
/// tau_origin added), in `bins` equal bins. Throws InputError for names and numbers that there are not.
nlohmann::ordered_json emission_histogram(const Dataset& dataset, const std::string& object,
                                          const std::string& channel, int bins);

}  // namespace nullcone::view
