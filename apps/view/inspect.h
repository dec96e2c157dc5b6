// All that is known of one pixel.
#pragma once

#include <nlohmann/json.hpp>

#include "core/record/dataset.h"
#include "postrender/look.h"

namespace nullcone::view {

/// The records of the pixel x, y of the picture as nullcone-info --pixel has them, and the spectra emitted
/// and observed of all crossings that have some in this look, as spectra.h tells. Throws InputError outside
/// the window.
nlohmann::ordered_json inspect_pixel(const Dataset& dataset, const postrender::Look& look, int x, int y);

}  // namespace nullcone::view
