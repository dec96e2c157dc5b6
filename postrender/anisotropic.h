// Images along the longer axis of the footprint: sharp on oblique surfaces.
#pragma once

#include "postrender/kernel.h"

namespace nullcone::postrender {

/// Most probes a pixel: beyond this ratio of the axes it is blurred as far as needed.
inline constexpr int kMostProbes = 16;

/// The mean of trilinear look-ups side by side along the longer axis of the ellipse that a pixel covers in
/// the texture, each as wide as the shorter axis (Feline: McCormack et al., SIGGRAPH 1999; but with equal
/// weights, because a pixel is a box). Colours as Kernel::image gives them; `image.mipmap` must be set. Of
/// run.footprints the signs count here.
void anisotropic_colors(const Kernel& kernel, const ImageView& image, const Run& run, Rgbx* out);

}  // namespace nullcone::postrender
