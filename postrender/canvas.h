// A picture to draw on: rectangles and text.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "postrender/image.h"

namespace nullcone::postrender {

/// Linear colours. What lies outside is not drawn.
struct Canvas {
  int width, height;
  std::vector<Rgb> pixels;

  Canvas(int w, int h, Rgb color)
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), color) {}
  Canvas(int w, int h, std::vector<Rgb> picture) : width(w), height(h), pixels(std::move(picture)) {}
  void set(int x, int y, Rgb color);
  void fill(int left, int top, int w, int h, Rgb color);
  /// Darkens what is there, so that light text can be read on it: a tenth is left of it.
  void darken(int left, int top, int w, int h);
  /// In dots of `scale` by `scale` pixels.
  void write(int left, int top, std::string_view text, Rgb color, int scale);
};

/// The width of a text in pixels, and the height of a line of it, gaps included.
int text_width(std::string_view text, int scale);
int text_height(int scale);

}  // namespace nullcone::postrender
