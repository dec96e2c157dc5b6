// Automatic exposure: which luminance is shown as 1.
#pragma once

#include "postrender/image.h"
#include "postrender/look_develop.h"

namespace nullcone::postrender {

/// The white that `exposure` finds in the luminances of all pixels that physical light reaches (positive and
/// finite ones): their percentile, exactly (of n sorted ones that at position floor(p (n - 1) / 100)), or
/// their geometric mean over the key. 1 if there are none. The same number for any number of threads.
double auto_white_cd_m2(const Radiance& radiance, const AutoWhite& exposure = {});

}  // namespace nullcone::postrender
