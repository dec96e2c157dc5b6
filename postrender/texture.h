// Textures in memory: colours over (u, v), u to the right and wrapping, v upwards and clamped.
//
// Each texture is a callable `Rgb operator()(float u, float v, const Footprint&)`; `kNeedsFootprint` says
// whether the footprint of the pixel is looked at. Types are resolved outside the pixel loop (shade.cpp).
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "postrender/image.h"

namespace nullcone::postrender {

/// How far (u, v) moves from one pixel to the next, to the right and down.
struct Footprint {
  float u_right = 0, v_right = 0, u_down = 0, v_down = 0;
};

/// One image; row 0 is the top (v = 1). Texel (i, j) has its centre at u = (i + 1/2)/width, v = 1 - (j +
/// 1/2)/height.
struct TextureLevel {
  int width = 0, height = 0;
  std::vector<Rgb> texels;

  Rgb texel(int i, int j) const {
    return texels[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(i)];
  }
  /// Bilinear, u wrapped and v clamped. Anything that is not finite reads texel 0.
  Rgb bilinear(float u, float v) const;
};

/// An image and its halvings down to one texel (mip-maps), in linear light.
struct Pyramid {
  std::vector<TextureLevel> levels;

  /// Trilinear: between the two levels whose texels are next to the footprint's longer side.
  Rgb trilinear(float u, float v, const Footprint& footprint) const;
  std::size_t bytes() const;
};

/// Builds the levels by area averages, whatever the size (powers of two are not needed).
Pyramid make_pyramid(TextureLevel full);

/// (u, v) -> (u, v) * scale + offset.
struct UvTransform {
  std::array<float, 2> offset = {0, 0}, scale = {1, 1};
  bool operator==(const UvTransform&) const = default;
};

struct ColorTexture {
  static constexpr bool kNeedsFootprint = false;
  Rgb color;

  Rgb operator()(float, float, const Footprint&) const { return color; }
  bool operator==(const ColorTexture&) const = default;
};

/// counts[0] squares along u, counts[1] along v. The square at u = v = 0 is even. Each kind's colour runs
/// from its first (at 0) to its second colour (at 1) along u (axis 0) or v (axis 1), in linear light.
struct CheckerboardTexture {
  static constexpr bool kNeedsFootprint = true;
  std::array<float, 2> counts = {1, 1};
  std::array<Rgb, 2> even, odd;
  int axis = 0;

  /// Averaged over the footprint (box filter), so that squares smaller than a pixel turn into their mean.
  Rgb operator()(float u, float v, const Footprint& footprint) const;
  bool operator==(const CheckerboardTexture&) const = default;
};

struct BilinearTexture {
  static constexpr bool kNeedsFootprint = false;
  std::shared_ptr<const Pyramid> image;
  UvTransform uv;

  Rgb operator()(float u, float v, const Footprint&) const {
    return image->levels.front().bilinear(u * uv.scale[0] + uv.offset[0], v * uv.scale[1] + uv.offset[1]);
  }
  bool operator==(const BilinearTexture&) const = default;
};

struct MipmapTexture {
  static constexpr bool kNeedsFootprint = true;
  std::shared_ptr<const Pyramid> image;
  UvTransform uv;

  Rgb operator()(float u, float v, const Footprint& f) const {
    const auto [su, sv] = uv.scale;
    return image->trilinear(u * su + uv.offset[0], v * sv + uv.offset[1],
                            {f.u_right * su, f.v_right * sv, f.u_down * su, f.v_down * sv});
  }
  bool operator==(const MipmapTexture&) const = default;
};

}  // namespace nullcone::postrender
