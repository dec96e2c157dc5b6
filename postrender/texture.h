// Textures in memory: colours over (u, v), u to the right and wrapping, v upwards and clamped. What is read
// from them is told in kernel_texture.h.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "postrender/huge_pages.h"
#include "postrender/image.h"

namespace nullcone::postrender {

/// One image as it is read; row 0 is the top (v = 1). Texel (i, j) has its centre at u = (i + 1/2)/width,
/// v = 1 - (j + 1/2)/height.
struct TextureLevel {
  int width = 0, height = 0;
  std::vector<Rgb> texels;        ///< multiplied by alpha, so that averages do not bleed at edges
  std::vector<float> alpha = {};  ///< empty: opaque

  std::size_t place(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i);
  }
  Rgb texel(int i, int j) const { return texels[place(i, j)]; }
};

/// An image and its halvings down to one texel, in linear light, by area averages, whatever the size (powers
/// of two are not needed).
std::vector<TextureLevel> halvings(TextureLevel full);

/// Red, green, blue and alpha (0 where it is ignored), as half floats without infinities and subnormal
/// numbers.
using Texel = std::array<std::int16_t, 4>;

/// Levels stand in tiles of 8 x 8 texels, so that a picture may run through them in any direction. Each tile
/// also holds the texels next to it on the right (wrapping) and below (clamped): the four around a look-up
/// stand in one tile, at k, k + 1, k + kTileRow and k + kTileRow + 1.
inline constexpr std::int32_t kTile = 8, kTileRow = kTile + 1, kTileTexels = kTileRow * kTileRow;

/// Where a level lies: texel (i, j) at first + (i/8 * kTileTexels + i%8) + (j/8 * row_of_tiles + j%8 *
/// kTileRow).
struct LevelView {
  std::int32_t width, height, row_of_tiles, first;
};

/// Mip-maps ready for look-ups: every halving as tiles of half floats. Relative error 2^-11 a component,
/// which is 1/20 of an 8 bit code; below 2^-29 of the largest component texels are 0.
struct Pyramid {
  std::vector<LevelView> levels;
  std::vector<Texel, HugePageAllocator<Texel>> texels;  ///< looked up in no order
  float unit = 1;                                       ///< colour = unit * half float

  std::size_t bytes() const { return texels.size() * sizeof(Texel); }
  /// For tests: a texel as look-ups see it.
  Rgb texel(std::size_t level, int i, int j) const;
};

Pyramid make_pyramid(TextureLevel full);

/// Binary exponent that brings the largest component (and an alpha of 1) to [2^14, 2^15), the top of half
/// floats.
int normalising_exponent(std::span<const TextureLevel> pictures);
/// Levels of any sizes, in the order given, times 2^exponent.
Pyramid tiled(std::span<const TextureLevel> levels, int exponent);

/// (u, v) -> (u, v) * scale + offset.
struct UvTransform {
  std::array<float, 2> offset = {0, 0}, scale = {1, 1};
  bool operator==(const UvTransform&) const = default;
};

struct ColorTexture {
  Rgb color;
  bool operator==(const ColorTexture&) const = default;
};

/// counts[0] squares along u, counts[1] along v. The square at u = v = 0 is even. Each kind's colour runs
/// from its first (at 0) to its second colour (at 1) along u (axis 0) or v (axis 1), in linear light.
/// Averaged over the footprint (box filter), so that squares smaller than a pixel turn into their mean.
struct CheckerboardTexture {
  std::array<float, 2> counts = {1, 1};
  std::array<Rgb, 2> even, odd;
  int axis = 0;
  bool operator==(const CheckerboardTexture&) const = default;
};

enum class Filter {
  bilinear,    ///< in the full image
  mipmap,      ///< trilinear, over the footprint's longer side
  anisotropic  ///< over the ellipse that the footprint is
};

/// In place of colours: how much of three materials there is in a texel, `first` and the two after it, of
/// `count` in all. A picture of materials tells the number of one (from 0) and how much of it.
struct MaterialGroup {
  int first = -1;  ///< -1: colours
  int count = 0;
  auto operator<=>(const MaterialGroup&) const = default;
};

struct ImageTexture {
  std::shared_ptr<const Pyramid> image;
  UvTransform uv;
  Filter filter = Filter::mipmap;
  bool alpha = false;  ///< the image has alpha, which lets light through
  bool operator==(const ImageTexture&) const = default;
};

/// Six faces of a cube about the observer, with borders (cube_map.h): those of level k at 6 k.
struct CubeTexture {
  std::shared_ptr<const Pyramid> faces;
  Filter filter = Filter::mipmap;  ///< not anisotropic
  bool operator==(const CubeTexture&) const = default;
};

}  // namespace nullcone::postrender
