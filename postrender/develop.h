// Developing: exposure, tone curve, gamut mapping.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "postrender/image.h"
#include "postrender/kernel.h"
#include "postrender/look.h"

namespace nullcone::postrender {

/// An image that has room for its parts; memory that it has is used again.
void set_size(Image& image, int width, int height, const ImageParts& parts);

/// Exposes, tones and maps into the gamut; holds the working memory of one thread. Exposed colours are those
/// of the output space, its white adapted; none of their components is greater than kBrightest, and radiance
/// that is not a number is black. The tone curve acts on the luminance and scales the three components alike,
/// so that it keeps hue and saturation; `linear` leaves the clipping to the gamut mapping.
///
/// hue_preserving mixes a colour with the grey of its own luminance, as little as is needed, until every
/// component lies within [0, 1]: hue and luminance stay. Luminances from 1 on give white, those up to 0 give
/// black. clip clamps every component.
class LineDeveloper {
 public:
  LineDeveloper(const DevelopLook& look, const Kernel& kernel);

  /// Pixels [first, first + count) of `image`, whose white is known, from their radiance (`physical` may be
  /// null).
  void develop(const Rgbx* display, const Rgbx* physical, std::size_t first, std::size_t count, Image& image);

 private:
  void develop_segment(const Rgbx* display, const Rgbx* physical, std::size_t first, std::size_t count,
                       Image& image);

  void apply_curve(std::size_t count, const Planes& planes) const;

  const DevelopLook& look_;
  const Kernel& kernel_;
  std::optional<std::array<Rgb, 3>> matrix_;  ///< into the output space
  Rgb weights_;                               ///< of luminance, there
  FilmicCurve filmic_;
  std::array<std::array<float, kSegment>, 3> planes_;
};

}  // namespace nullcone::postrender
