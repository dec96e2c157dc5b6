// How far the texture coordinates move from pixel to pixel, from the records alone.
#pragma once

#include <cmath>
#include <cstddef>

#include "core/record/dataset.h"
#include "postrender/texture.h"

namespace nullcone::postrender {

/// Estimates footprints from differences with the four neighbours. A neighbour counts when its crossing of
/// the same rank met the same object by an image of the same order. Of the two neighbours along a direction
/// the nearer one in (u, v) is taken, so that the edge between two images of an object does not look like a
/// steep texture.
class FootprintEstimate {
 public:
  explicit FootprintEstimate(const Dataset& dataset)
      : hits_(dataset.hits),
        width_(static_cast<std::size_t>(dataset.manifest.width)),
        height_(static_cast<std::size_t>(dataset.manifest.height)) {}

  /// `hit` is a crossing of pixel (column, row).
  Footprint operator()(std::size_t hit, std::size_t column, std::size_t row) const {
    const std::size_t pixel = row * width_ + column;
    const std::size_t rank = hit - hits_.offset[pixel];
    Step right, down;
    if (column > 0) right.offer(difference(hit, pixel - 1, rank));
    if (column + 1 < width_) right.offer(difference(hit, pixel + 1, rank));
    if (row > 0) down.offer(difference(hit, pixel - width_, rank));
    if (row + 1 < height_) down.offer(difference(hit, pixel + width_, rank));
    return {right.u, right.v, down.u, down.v};
  }

 private:
  /// A step in (u, v); `found` is false where no neighbour counts, and then it is zero.
  struct Step {
    float u = 0, v = 0;
    bool found = false;
    void offer(const Step& other) {
      if (other.found && (!found || other.u * other.u + other.v * other.v < u * u + v * v)) *this = other;
    }
  };

  Step difference(std::size_t hit, std::size_t neighbour, std::size_t rank) const {
    const std::size_t other = hits_.offset[neighbour] + rank;
    if (other >= hits_.offset[neighbour + 1] || hits_.id[other] != hits_.id[hit] ||
        hits_.order[other] != hits_.order[hit])
      return {};
    const float u = hits_.u[other] - hits_.u[hit];
    // The seam: u = 0 and u = 1 are the same line.
    return {u - std::nearbyint(u), hits_.v[other] - hits_.v[hit], true};
  }

  const Hits& hits_;
  std::size_t width_, height_;
};

}  // namespace nullcone::postrender
