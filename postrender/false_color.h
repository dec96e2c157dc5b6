// False colours: from the numbers of a channel to colours, and where they stand along a scale.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/record/dataset.h"
#include "postrender/image.h"

namespace nullcone::postrender {

/// How numbers of a channel turn into colours.
enum class ScaleKind {
  linear,
  logarithmic,  ///< 0 has a colour of its own
  shift,        ///< logarithmic too; white at 1, blue above, red below
  categories,   ///< whole numbers, each with its own colour
};

using Range = std::pair<double, double>;

struct ColorScale {
  ScaleKind kind = ScaleKind::linear;
  Range range = {0, 1};  ///< what lies beyond has the colour of the end
  std::string channel;

  /// The colour of a number; infinite ones, missing ones and 0 on a logarithmic scale have kInfinite,
  /// kMissing and kZero.
  Rgb color(float value) const;
  /// Where a number stands, from 0 at the start of the range to 1 at its end.
  double place(double value) const;
};

inline constexpr Rgb kMissing = {0.02f, 0.02f, 0.02f}, kZero = {0.2f, 0.2f, 0.2f},
                     kInfinite = {0.55f, 0.55f, 0.55f};

ScaleKind scale_kind(const ChannelInfo& channel);

/// The scale for these numbers: with the given range, or else from the least to the greatest finite one; on
/// logarithmic scales, and for duv, from the 1st to the 99th percentile, 1 included for the shift. Throws
/// InputError for a range that the channel cannot have.
ColorScale choose_scale(const ChannelInfo& channel, std::span<const float> values,
                        const std::optional<Range>& range);

/// "a,b" as a range. Throws InputError.
Range parse_range(const std::string& text);

/// Dark violet to yellow, the lightness rising evenly; x from 0 to 1.
Rgb sequential_color(double x);
/// Red (-1), white (0), blue (1).
Rgb diverging_color(double x);

}  // namespace nullcone::postrender
