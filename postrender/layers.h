// Scan lines of crossings side by side, as the kernels want them.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/record/dataset.h"
#include "postrender/kernel.h"

namespace nullcone::postrender {

/// For each scan line whether every pixel has exactly one crossing, 1: then columns are read as they lie; or
/// one that is opaque, kOneOpaqueEach: then nothing is seen through it. Else 0.
std::vector<std::uint8_t> lines_with_one_each(const Dataset& dataset);
inline constexpr std::uint8_t kOneOpaqueEach = 2;

/// Hands out scan lines of a dataset; holds the working memory of one thread. Where a channel is missing, the
/// order is 0, the frequency ratio 1, and (u, v) = (0, 0).
class Layers {
 public:
  /// `one_each` as lines_with_one_each() finds it. Both must outlive this.
  Layers(const Dataset& dataset, std::span<const std::uint8_t> one_each);

  /// The crossings of a rank along a line; none above and below the picture. Holds until a line three further
  /// on, or another rank of this one, is asked for.
  Layer at(std::ptrdiff_t row, std::size_t rank);
  /// The lines that footprints are found in: with those above and below `here`, unless steps are recorded.
  std::array<Layer, 3> around(std::size_t row, std::size_t rank, const Layer& here);
  /// Whether footprints come from `duv`.
  bool recorded_steps() const { return columns_.duv[0] != nullptr; }

 private:
  /// A scan line of crossings that do not stand side by side in the dataset, or of none.
  struct Expanded {
    std::size_t row, rank;
    std::vector<std::uint32_t> id, order;
    std::vector<float> u, v, shift, opacity;
    std::array<std::vector<float>, 4> duv;
    Layer layer() const;
  };
  void expand(const std::uint64_t* offset, std::size_t rank, Expanded& copy) const;

  std::span<const std::uint64_t> offset_;
  Layer columns_;  ///< of the whole dataset; null where a channel is missing
  std::span<const std::uint8_t> one_each_;
  std::size_t width_, height_;
  std::array<Expanded, 3> expanded_;  ///< by row modulo 3
  Expanded nothing_;                  ///< above the first and below the last line
};

}  // namespace nullcone::postrender
