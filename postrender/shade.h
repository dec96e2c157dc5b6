// Shading: from records and appearances to radiance.
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <span>
#include <vector>

#include "core/record/dataset.h"
#include "postrender/illumination.h"
#include "postrender/kernel.h"
#include "postrender/layers.h"
#include "postrender/shading.h"

namespace nullcone::postrender {

/// Colours of textures along a line, of its first crossings.
struct KeptColors {
  Rgbx* line = nullptr;  ///< null: they are not kept
  bool known = false;    ///< false: they are yet to be looked up
};

/// Shades scan lines; holds the working memory of one thread. Crossings are composited front to back,
/// L += transmittance * A * colour, until nothing shines through: one rank after the other, in it one coat
/// after the other (coats.h; mostly there is one), and in it one run of pixels of the same appearance after
/// the other.
class LineShader {
 public:
  /// `one_each` as lines_with_one_each() finds it.
  LineShader(const Dataset& dataset, std::span<const std::uint8_t> one_each, const Shading& shading,
             const Kernel& kernel);

  /// Writes the line's pixels; `physical` and `display` may be null where nothing is. Colours are kept only
  /// of lines of one crossing a pixel, and where keeps_colors().
  /// `visible`, unless null, gets what share of the light of skies with stars comes through.
  void shade(std::size_t row, Rgbx* display, Rgbx* physical, KeptColors kept = {}, float* visible = nullptr);

 private:
  /// One of the appearances that each pixel of a rank shows.
  struct Pass {
    std::vector<std::uint32_t> appearance;
    std::vector<float> weight;
    std::vector<float> part;  ///< its share times its opacity; only where layered_
    std::vector<Rgbx> clear;  ///< colours of what has alpha; only where layered_
  };

  bool anything_seen(std::size_t row, std::size_t rank);
  void find_times(std::size_t row, std::size_t rank, const Layer& here);
  void find_coats_of(const ObjectShading& object, std::size_t first, std::size_t last);
  bool find_appearances(std::size_t row, std::size_t rank, const Layer& here);
  void find_opacities(std::size_t row, std::size_t rank, const Layer& here);
  void find_parts(Pass& pass, std::size_t row, std::size_t rank, const Layer& here);
  void find_alpha(Pass& pass, const std::array<Layer, 3>& lines, std::size_t first, std::size_t last);
  void note_visible(const Layer& here);
  void share_weights();
  Pass& pass_at(std::size_t number);
  void look_up(const std::array<Layer, 3>& lines, const Texture& texture, std::size_t first,
               std::size_t count, Rgbx* out);
  Lit dimmed(Lit lit, float factor);
  void shade_segment(const std::array<Layer, 3>& lines, const Pass& pass, const RunPlace& place,
                     std::size_t count, Rgbx* display, Rgbx* physical);
  void shade_pass(const Pass& pass, std::size_t row, std::size_t rank, const Layer& here, Rgbx* display,
                  Rgbx* physical);
  std::span<const Times> times_of(std::size_t first, std::size_t count) const;
  Times time_at(std::size_t i) const { return clocks_.any() ? times_[i] : Times{}; }

  const Dataset& dataset_;
  std::span<const std::uint8_t> one_each_;
  const Shading& shading_;
  const Kernel& kernel_;
  Layers layers_;
  Illumination illumination_;
  KeptColors kept_;
  float* visible_ = nullptr;
  bool whole_weights_ = false;  ///< the first pass has weights of 1
  bool layered_;                ///< weights are more than transmittance times recorded opacity
  Clocks clocks_;
  std::size_t width_;
  std::vector<float> transmittance_;
  std::vector<float> opacity_;  ///< of a rank; only where layered_
  std::vector<float> parts_;    ///< sums of Pass::part; only where layered_
  std::vector<Times> times_;    ///< of a rank; only where clocks_ has any
  std::deque<Pass> passes_;     ///< the first for every pixel that is seen, the others where they are needed
  std::size_t used_ = 1;        ///< passes of this rank
  std::array<std::array<float, kSegment>, 4> footprints_;
  std::array<float, kSegment> shift_,
      light_;  ///< where the temperature changes; light_ also where weights have a factor
  std::array<Rgbx, kSegment> colors_;
};

}  // namespace nullcone::postrender
