#include "postrender/canvas.h"

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
