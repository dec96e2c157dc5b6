// Where stars are seen: the map from the picture to the sky, triangle by triangle between neighbouring rays,
// and the stars inside each triangle.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/record/dataset.h"
#include "postrender/stars.h"

namespace nullcone::postrender {

/// One image of one star. Magnification is what the lens, and the observer's motion, make of solid angles.
struct StarImage {
  float x, y;           ///< in pixels of the picture from its top left corner; y in the window's lines
  std::uint32_t star;   ///< its number in the field
  float shift;          ///< frequency ratio there
  float area;           ///< of the triangle, in pixels, a unit of solid angle on the sky: 1/sr
  float magnification;  ///< 0 where the camera is not known
  std::array<std::uint32_t, 3> corners;  ///< rays around it: numbers in the grid of samples
  std::array<float, 3> weights;          ///< of the corners
  std::int32_t left, right;              ///< columns of the picture that the spot may lie in: from..to
};

struct StarImages {
  std::vector<StarImage> images;       ///< row of triangles by row, from the top
  std::vector<std::size_t> row_first;  ///< of each row of triangles the first image, and behind the last
  std::vector<float> row_y;  ///< upper border of each row of triangles, and the last one's lower border
  bool wraps = false;        ///< the right edge of the picture is the left one
};

/// Farther beyond the edges of the picture no stars are looked for; in pixels. Spots reach back into it.
inline constexpr double kBeyondEdge = 4;
/// Neighbouring rays whose directions are farther apart than this (a chord of the unit sphere) do not belong
/// to one image of the sky, or to one too small for the picture.
inline constexpr double kLargestStep = 1;

/// All images of the stars of object `id`. `samples` is the dataset as by_samples() makes it, with uv; its
/// pixels are the rays of `picture`. Each image is found once: triangles share edges to the last bit.
StarImages find_star_images(const Dataset& samples, const Manifest& picture, std::uint32_t id,
                            const StarField& field);

}  // namespace nullcone::postrender
