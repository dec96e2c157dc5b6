// A bar of colours with ticks and numbers below it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "postrender/canvas.h"
#include "postrender/false_color.h"

namespace nullcone::postrender {

/// Numbers at round places of the range, at most `most` of them (at least two), the least first.
std::vector<double> ticks(const ColorScale& scale, int most);

/// The shortest text of a number that tells it from its neighbours among ticks: "0.25", "1e-9".
std::string tick_text(double value);

/// Where a bar lies, in pixels; `scale` is the size of a dot of the font. Numbers may stand out by half their
/// width at both ends.
struct BarPlace {
  int left, top, width, scale;
};

inline constexpr int kBarDots = 10;  ///< height of the bar alone, in dots

/// Of bar, ticks and numbers, in pixels.
int bar_height(int scale);

/// The numbers in the middle of its columns.
std::vector<double> bar_values(const ColorScale& scale, int width);

/// Draws the bar, one colour a column.
void draw_bar(Canvas& canvas, const BarPlace& at, const ColorScale& scale, std::span<const Rgb> colors,
              Rgb ink);

}  // namespace nullcone::postrender
