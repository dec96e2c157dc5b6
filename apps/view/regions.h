// Connected regions of the crossings with one object.
#pragma once

#include <cstdint>
#include <vector>

#include "core/record/dataset.h"

namespace nullcone::view {

/// What is connected: a pixel in which the object is crossed with some order, once or several times. Those of
/// pixel i are number first[i] … first[i + 1] − 1, their orders increase.
struct Regions {
  std::vector<std::uint32_t> first, order;
  std::vector<std::uint32_t> region;  ///< of each, from 0
  std::vector<std::uint8_t>
      over_edges;  ///< of each region: whether it goes on from the right edge at the left
  std::size_t count() const { return over_edges.size(); }

  /// The one of a pixel that has this order; there must be one.
  std::uint32_t at(std::size_t pixel, std::uint32_t wanted) const;
};

/// Of the object with this number. Neighbours by sides and corners that have the same order are connected;
/// `closed`: also those at the left and the right edge of the picture; `cells`: so many pictures of equal
/// width stand side by side, between which nothing is connected.
Regions find_regions(const Dataset& dataset, std::uint32_t id, bool closed, int cells = 1);

}  // namespace nullcone::view
