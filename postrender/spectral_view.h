// Tables of light as pixel loops see them: plain data.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "postrender/image.h"

namespace nullcone::postrender {

/// From one node of a table to the next: c[0] + c[1] s + c[2] s^2 + c[3] s^3, s from 0 to 1. One cache line.
struct alignas(64) TableNode {
  std::array<Rgbx, 4> c;
};

/// A table as pixel loops see it. Nodes stand where the upper bits of the float g change.
struct TableView {
  const TableNode* nodes;
  float from, to;
  std::int32_t unused_bits;  ///< of g's mantissa between two nodes
  std::int32_t first;        ///< upper bits at the first node
  std::int32_t stride;       ///< nodes that stand side by side for one g: 1, or 3 for red, green and blue
};

/// Where the cells of a table stand along a ratio: at its upper bits.
struct GridView {
  float from, to;
  std::int32_t unused_bits, first;
};

/// A LitTable (lit_table.h): cells of 16 coefficients, those of s^i t^j at [4 i + j]; s along g, t along
/// g_light.
struct LitTableView {
  const Rgbx* cells;
  GridView along, across;
  std::int32_t across_cells;
};

/// A line of a spectrum, W m^-2 sr^-1.
struct TableLine {
  double wavelength_nm, strength;
  int component = 0;  ///< of three spectra: whose it is
};

/// A LineTable (spectrum.h).
struct LinesView {
  const TableLine* lines;
  std::size_t count;
  bool mixed;                     ///< colours are amounts of three spectra; else filters before one
  double first_nm, per_nm, last;  ///< of the response: sample i stands at first_nm + i / per_nm, i up to last
  const std::array<double, 3>* response;
  TableView power;
};

}  // namespace nullcone::postrender
