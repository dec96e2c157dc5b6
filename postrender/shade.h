// Shading: from records and appearances to radiance.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/record/dataset.h"
#include "postrender/kernel.h"
#include "postrender/layers.h"
#include "postrender/spectrum.h"
#include "postrender/texture.h"

namespace nullcone::postrender {

using Texture = std::variant<ColorTexture, CheckerboardTexture, ImageTexture>;

/// How a surface looks, ready for pixels.
struct Appearance {
  Texture texture;
  Light light;
  float opacity = 1;  ///< times that of the crossing; 0: not seen at all
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
  std::vector<std::string> notes;      ///< what the user should know of it
  bool operator==(const Shading&) const = default;
};

/// Whether any appearance radiates in cd/m^2.
bool has_physical(const Shading& shading);

/// Shades scan lines; holds the working memory of one thread. Crossings are composited front to back,
/// L += transmittance * A * colour, until nothing shines through: one rank after the other, and in it one run
/// of pixels of the same appearance after the other.
class LineShader {
 public:
  /// `one_each` as lines_with_one_each() finds it.
  LineShader(const Dataset& dataset, std::span<const std::uint8_t> one_each, const Shading& shading,
             const Kernel& kernel);

  /// Writes the line's pixels; `physical` may be null where nothing is.
  void shade(std::size_t row, Rgbx* display, Rgbx* physical);

 private:
  bool anything_seen(std::size_t row, std::size_t rank);
  bool find_appearances(std::size_t row, std::size_t rank, const Layer& here);
  void find_opacities(std::size_t row, std::size_t rank, const Layer& here);
  void look_up(const std::array<Layer, 3>& lines, const Appearance& appearance, std::size_t first,
               std::size_t count, Rgbx* out);
  void shade_segment(const std::array<Layer, 3>& lines, const Appearance& appearance, std::size_t first,
                     std::size_t count, Rgbx* display, Rgbx* physical);
  void shade_rank(std::size_t row, std::size_t rank, const Layer& here, Rgbx* display, Rgbx* physical);

  const Dataset& dataset_;
  std::span<const std::uint8_t> one_each_;
  const Shading& shading_;
  const Kernel& kernel_;
  Layers layers_;
  bool see_through_;  ///< some appearance lets light through by itself
  std::size_t width_;
  std::vector<std::uint32_t> appearance_;
  std::vector<float> transmittance_, weight_;
  std::vector<float> opacity_;      ///< of a rank; only where see_through_
  std::vector<Rgbx> clear_colors_;  ///< of a rank, what has alpha; only where see_through_
  std::array<std::array<float, kSegment>, 4> footprints_;
  std::array<Rgbx, kSegment> colors_;
};

}  // namespace nullcone::postrender
