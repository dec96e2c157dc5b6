#include "postrender/canvas.h"

#include <algorithm>

#include "postrender/bitmap_font.h"

namespace nullcone::postrender {

void Canvas::set(int x, int y, Rgb color) {
  if (x < 0 || y < 0 || x >= width || y >= height) return;
  pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] = color;
}

void Canvas::fill(int left, int top, int w, int h, Rgb color) {
  for (int y = top; y < top + h; ++y)
    for (int x = left; x < left + w; ++x) set(x, y, color);
}

void Canvas::darken(int left, int top, int w, int h) {
  const auto darker = [](float x) { return x > 0 ? 0.1f * std::min(x, 1.0f) : 0.0f; };
  for (int y = std::max(top, 0); y < std::min(top + h, height); ++y)
    for (int x = std::max(left, 0); x < std::min(left + w, width); ++x) {
      Rgb& c =
          pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
      c = {darker(c.r), darker(c.g), darker(c.b)};
    }
}

void Canvas::write(int left, int top, std::string_view text, Rgb color, int scale) {
  for (const char letter : text) {
    for (int y = 0; y < kGlyphHeight; ++y)
      for (int x = 0; x < kGlyphWidth; ++x)
        if (glyph_dot(letter, x, y)) fill(left + x * scale, top + y * scale, scale, scale, color);
    left += (kGlyphWidth + 1) * scale;
  }
}

int text_width(std::string_view text, int scale) {
  return static_cast<int>(text.size()) * (kGlyphWidth + 1) * scale;
}
int text_height(int scale) { return (kGlyphHeight + 2) * scale; }

}  // namespace nullcone::postrender
