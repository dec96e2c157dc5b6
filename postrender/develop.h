// Developing: exposure, tone curve, gamut mapping.
#pragma once

#include <array>
#include <vector>

#include "postrender/image.h"
#include "postrender/kernel.h"
#include "postrender/look.h"

namespace nullcone::postrender {

/// The white of "auto": the 99th percentile of the luminances of all pixels that physical light reaches; 1 if
/// none.
double auto_white_cd_m2(const Radiance& radiance);

/// An image that has room for its parts; memory that it has is used again.
void set_size(Image& image, int width, int height, const ImageParts& parts);

/// Exposes, tones and maps into the gamut; holds the working memory of one thread. The tone curve acts on the
/// luminance and scales the three components alike, so that it keeps hue and saturation; `linear` leaves the
/// clipping to the gamut mapping.
///
/// hue_preserving mixes a colour with the grey of its own luminance, as little as is needed, until every
/// component lies within [0, 1]: hue and luminance stay. Luminances from 1 on give white, those up to 0 and
/// NaN give black. clip clamps every component; NaN is 0.
class LineDeveloper {
 public:
  LineDeveloper(const DevelopLook& look, const Kernel& kernel) : look_(look), kernel_(kernel) {}

  /// Pixels [first, first + count) of `image`, whose white is known, from their radiance (`physical` may be
  /// null).
  void develop(const Rgbx* display, const Rgbx* physical, std::size_t first, std::size_t count, Image& image);

 private:
  void develop_segment(const Rgbx* display, const Rgbx* physical, std::size_t first, std::size_t count,
                       Image& image);

  const DevelopLook& look_;
  const Kernel& kernel_;
  std::array<std::array<float, kSegment>, 3> planes_;
};

}  // namespace nullcone::postrender
