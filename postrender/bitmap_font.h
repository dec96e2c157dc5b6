// A font of 5 x 7 dots for legends: OpenImageIO draws text only with a font file, and a bare machine has
// none.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace nullcone::postrender {

inline constexpr int kGlyphWidth = 5, kGlyphHeight = 9;  ///< two rows of them below the line

/// Whether the dot in column x and row y from the top left is set. Letters beyond ASCII are question marks.
bool glyph_dot(char letter, int x, int y);

}  // namespace nullcone::postrender
