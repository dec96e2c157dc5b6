// Shading: from records and appearances to radiance.
#pragma once

#include <cstddef>
#include <variant>
#include <vector>

#include "core/record/dataset.h"
#include "postrender/spectrum.h"
#include "postrender/texture.h"

namespace nullcone::postrender {

using Texture = std::variant<ColorTexture, CheckerboardTexture, BilinearTexture, MipmapTexture>;
using Spectrum = std::variant<DisplaySpectrum, BlackBodySpectrum>;

/// How a surface looks, ready for pixels.
struct Appearance {
  Texture texture;
  Spectrum spectrum;
  bool operator==(const Appearance&) const = default;
};

/// From `from` (included) to `to` (excluded) an object has another appearance.
struct Slice {
  bool own_clock;  ///< false: channel t; true: tau + tau_origin
  double from, to;
  std::size_t appearance;
  bool operator==(const Slice&) const = default;
};

struct ObjectShading {
  double tau_origin;
  std::size_t appearance;
  std::vector<Slice> slices;  ///< the first that holds wins
  bool operator==(const ObjectShading&) const = default;
};

/// A look with everything that a pixel needs at hand: textures read, spectra tabulated, names turned into
/// numbers.
struct Shading {
  std::vector<Appearance> appearances;
  std::vector<ObjectShading> objects;  ///< by id - 1
  Rgb background;                      ///< display colour behind everything
  bool operator==(const Shading&) const = default;
};

/// Whether any appearance radiates in cd/m^2.
bool has_physical(const Shading& shading);

/// Shades the rows [first_row, last_row) into `radiance`, whose vectors have the size of the picture.
/// Crossings are composited front to back, L += transmittance * A * colour, until nothing shines through.
void shade_rows(const Dataset& dataset, const Shading& shading, int first_row, int last_row,
                Radiance& radiance);

}  // namespace nullcone::postrender
