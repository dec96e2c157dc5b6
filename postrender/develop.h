// Developing: exposure, tone curve, gamut mapping.
#pragma once

#include "postrender/image.h"
#include "postrender/look.h"

namespace nullcone::postrender {

/// The white of "auto": the 99th percentile of the luminances of all pixels that physical light reaches; 1 if
/// none.
double auto_white_cd_m2(const Radiance& radiance);

/// Exposes, tones and maps into the gamut. The tone curve acts on the luminance and scales the three
/// components alike, so that it keeps hue and saturation; `linear` leaves the clipping to the gamut mapping.
Image develop(const Radiance& radiance, int width, int height, const DevelopLook& look);

/// Mixes a colour with the grey of its own luminance, as little as is needed, until every component lies
/// within [0, 1]: hue and luminance stay. Luminances from 1 on give white, those up to 0 and NaN give black.
Rgb desaturated_into_gamut(Rgb color);

/// Clamps every component to [0, 1]; NaN is 0.
Rgb clipped_into_gamut(Rgb color);

}  // namespace nullcone::postrender
