// Shading: from records and appearances to radiance.
#pragma once

#include <array>
#include <cstddef>
#include <variant>
#include <vector>

#include "core/record/dataset.h"
#include "postrender/kernel.h"
#include "postrender/spectrum.h"
#include "postrender/texture.h"

namespace nullcone::postrender {

using Texture = std::variant<ColorTexture, CheckerboardTexture, ImageTexture>;
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

/// Shades scan lines; holds the working memory of one thread. Crossings are composited front to back,
/// L += transmittance * A * colour, until nothing shines through: one rank after the other, and in it one run
/// of pixels of the same appearance after the other.
class LineShader {
 public:
  LineShader(const Dataset& dataset, const Shading& shading, const Kernel& kernel);

  /// Writes the line's pixels; `physical` may be null where nothing is.
  void shade(std::size_t row, Rgbx* display, Rgbx* physical);

 private:
  /// A scan line of crossings that do not stand side by side in the dataset, or of none.
  struct Expanded {
    std::size_t row, rank;
    std::vector<std::uint32_t> id, order;
    std::vector<float> u, v, shift, opacity;
    Layer layer() const;
  };
  /// Whether every pixel of a line has one crossing.
  struct Counts {
    std::size_t row;
    bool one_each;
  };
  Layer layer(std::ptrdiff_t row, std::size_t rank);
  bool one_each(std::size_t row);
  bool anything_seen(std::size_t row, std::size_t rank);
  void find_appearances(std::size_t row, std::size_t rank, const Layer& here);
  void estimate_footprints(std::size_t row, std::size_t rank);
  void shade_run(const Appearance& appearance, const Run& run, Rgbx* display, Rgbx* physical);

  const Dataset& dataset_;
  const Shading& shading_;
  const Kernel& kernel_;
  std::size_t width_, height_;
  std::array<Expanded, 3> expanded_;  ///< by row modulo 3
  std::array<Counts, 3> counts_;      ///< likewise
  Expanded nothing_;                  ///< above the first and below the last line
  std::vector<std::uint32_t> appearance_;
  std::vector<float> transmittance_, weight_, steps_;
  std::array<std::vector<float>, 4> footprints_;
  std::vector<Rgbx> colors_;
};

}  // namespace nullcone::postrender
