// Spectra for colours that have none: smooth ones whose sums show every colour of a picture as it is.
#pragma once

#include <array>

#include "postrender/spectral_distribution.h"

namespace nullcone::postrender {

/// Three spectral radiances for red, green and blue of linear sRGB (in units of the display's white): not
/// negative, of the least possible sum of squared differences between samples 10 nm apart, linear between
/// them, which the standard observer sees exactly as the three primaries. Beyond 360 and 830 nm, where no
/// colour tells anything, their last values are held. (The least-squares idea is that of Mallett and Yuksel
/// 2019, here for emission.)
const std::array<AnySpectrum, 3>& rgb_basis();

}  // namespace nullcone::postrender
