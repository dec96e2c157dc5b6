// What is seen of lamps on surfaces that reflect each wavelength differently (lit_table.h), along a run of
// pixels.
#pragma once

#include "postrender/kernel.h"
#include "postrender/lanes.h"

NULLCONE_KERNEL_BEGIN

/// The cell of g, and the part of it from 0 to 1; outside of the range those of its ends.
struct CellPlace {
  std::int32_t cell;
  float part;
};
inline CellPlace place_in(const postrender::GridView& grid, float g) {
  const float above = g > grid.from ? g : grid.from, within = above < grid.to ? above : grid.to;
  const auto bits = bits_as<std::int32_t>(within);
  const std::int32_t whole = 1 << grid.unused_bits;
  return {(bits >> grid.unused_bits) - grid.first,
          static_cast<float>(bits & (whole - 1)) / static_cast<float>(whole)};
}

inline bool is_ratio(float g) { return (g > 0) & (g < __builtin_inff()); }

void reflected_light(const postrender::LitTableView& table, const float* g_light,
                     const postrender::Lit& lit) {
  for (std::size_t i = 0; i < lit.count; ++i) {
    if (!(is_ratio(lit.g[i]) & is_ratio(g_light[i])) | (lit.weight[i] == 0)) continue;
    const CellPlace along = place_in(table.along, lit.g[i]), across = place_in(table.across, g_light[i]);
    const postrender::Rgbx* c =
        table.cells + 16 * (static_cast<std::ptrdiff_t>(along.cell) * table.across_cells + across.cell);
    const auto row = [&](int a) {
      const postrender::Rgbx* of = c + 4 * a;
      return load<Float4>(of) +
             across.part * (load<Float4>(of + 1) +
                            across.part * (load<Float4>(of + 2) + across.part * load<Float4>(of + 3)));
    };
    const Float4 seen = row(0) + along.part * (row(1) + along.part * (row(2) + along.part * row(3)));
    const Float4 light = lit.weight[i] * (load<Float4>(lit.colors + i) * seen);
    store(load<Float4>(lit.sum + i) + light, lit.sum + i);
  }
}

NULLCONE_KERNEL_END
