// The legend on a picture: time, temperature and a scale of colours, in a corner.
#pragma once

#include "postrender/image.h"
#include "postrender/look.h"

namespace nullcone::postrender {

/// Draws the legend of `look` on its picture, both into `exposed` and `display`: light letters on a dark
/// plate. The scale shows what its object would look like at each frequency ratio: its spectrum, the effects
/// and the development of the look, without image, slices and opacity, at the white of the picture.
void draw_inset(const Look& look, const Manifest& manifest, Image& image);

}  // namespace nullcone::postrender
