// Which frequency ratios a dataset holds: what tables of light have to cover.
#pragma once

#include <vector>

#include "core/record/dataset.h"
#include "postrender/spectrum.h"

namespace nullcone::postrender {

/// By object: the frequency ratios that its crossings have; (1, 1) where none is sensible.
std::vector<ShiftRange> shift_ranges(const Dataset& dataset);

/// Of the light that an object gets from a lamp: the ratios on the way to it (g_light), and the products with
/// those on to the observer.
struct LightShifts {
  ShiftRange light, product;
};
/// By object, and by lamp; over all paths.
std::vector<std::vector<LightShifts>> light_shift_ranges(const Dataset& dataset);

}  // namespace nullcone::postrender
