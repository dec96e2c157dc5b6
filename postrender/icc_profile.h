// ICC profiles of output spaces, by Little CMS.
#pragma once

#include <cstdint>
#include <vector>

#include "postrender/image.h"

namespace nullcone::postrender {

/// A matrix profile (ICC.1, version 4) of an RGB space, with the sRGB transfer curve or linear; empty for
/// XYZ, which has no such profile. The same bytes whenever it is made.
std::vector<std::uint8_t> icc_profile(OutputSpace space, bool linear);

}  // namespace nullcone::postrender
