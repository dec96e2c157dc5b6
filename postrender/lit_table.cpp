#include "postrender/lit_table.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace nullcone::postrender {

namespace {

using Color = std::array<double, 3>;
constexpr int kFewestBits = 2, kMostBits = 10;
constexpr double kError = 3e-5, kDark = 1e-30;
constexpr std::size_t kMostBytes = std::size_t{4} << 20;

}  // namespace

LitTable::LitTable(AnySpectrum lamp, AnySpectrum reflectance, const Effects& effects, const Sensor& sensor,
                   ShiftRange shifts, ShiftRange light_shifts)
    : along_(shifts, kFewestBits), across_(light_shifts, kFewestBits) {
  const double power = effects.power(), light_power = effects.light_power();
  const Colors colors = [=, &sensor](double g, double g_light) {
    const AnySpectrum lit = product(effects.doppler ? shifted(lamp, g_light) : lamp, reflectance);
    Color out = sensor.rgb(lit->fold(sensor, effects.doppler ? g : 1));
    const double factor = std::pow(g, power) * std::pow(g_light, light_power);
    for (double& x : out) x *= factor;
    return out;
  };
  for (int bits = kFewestBits;; ++bits) {
    along_ = BitGrid(shifts, bits);
    across_ = BitGrid(light_shifts, bits);
    fill(colors);
    error_ = measure(colors);
    if (error_ < kError || bits == kMostBits || 4 * bytes() > kMostBytes) return;
  }
}

void LitTable::fill(const Colors& colors) {
  // Step 1: nodes, which neighbouring cells share.
  const auto rows = static_cast<std::size_t>(3 * along_.cells + 1),
             columns = static_cast<std::size_t>(3 * across_.cells + 1);
  const auto place = [](const BitGrid& grid, std::size_t node) {
    const auto cell = std::min(static_cast<std::int32_t>(node / 3), grid.cells - 1);
    return grid.place(cell, static_cast<double>(static_cast<std::int32_t>(node) - 3 * cell) / 3);
  };
  std::vector<Color> nodes(rows * columns);
  tbb::parallel_for(std::size_t{0}, nodes.size(), [&](std::size_t k) {
    nodes[k] = colors(place(along_, k / columns), place(across_, k % columns));
  });
  // Step 2: the bicubic through the 16 nodes of each cell.
  const auto across_cells = static_cast<std::size_t>(across_.cells);
  cells_.resize(static_cast<std::size_t>(along_.cells) * across_cells);
  for (std::size_t k = 0; k < cells_.size(); ++k)
    for (std::size_t c = 0; c < 3; ++c) {
      std::array<std::array<double, 4>, 4> cubics;
      for (std::size_t a = 0; a < 4; ++a) {
        const Color* y = &nodes[(3 * (k / across_cells) + a) * columns + 3 * (k % across_cells)];
        cubics[a] = cubic_through(y[0][c], y[1][c], y[2][c], y[3][c]);
      }
      for (std::size_t b = 0; b < 4; ++b) {
        const auto column = cubic_through(cubics[0][b], cubics[1][b], cubics[2][b], cubics[3][b]);
        for (std::size_t a = 0; a < 4; ++a) (&cells_[k].c[4 * a + b].r)[c] = static_cast<float>(column[a]);
      }
    }
}

double LitTable::measure(const Colors& colors) const {
  double largest = 0;
  for (const Cell& cell : cells_)
    largest =
        std::max({largest, std::abs(static_cast<double>(cell.c[0].r)),
                  std::abs(static_cast<double>(cell.c[0].g)), std::abs(static_cast<double>(cell.c[0].b))});
  std::vector<double> error(cells_.size());
  tbb::parallel_for(std::size_t{0}, cells_.size(), [&](std::size_t k) {
    const auto i = static_cast<std::int32_t>(k) / across_.cells,
               j = static_cast<std::int32_t>(k) % across_.cells;
    for (const auto& [s, t] : {std::pair{0.5, 0.17}, {0.17, 0.5}, {0.83, 0.83}}) {
      // Also beyond the ranges: they may lie between two of these places.
      const Color exact = colors(along_.place(i, s), across_.place(j, t));
      const Rgb found = cells_[k].at(static_cast<float>(s), static_cast<float>(t));
      const Color difference = {static_cast<double>(found.r) - exact[0],
                                static_cast<double>(found.g) - exact[1],
                                static_cast<double>(found.b) - exact[2]};
      const double scale = std::max(magnitude(exact), 0.01 * largest);
      if (scale > kDark) error[k] = std::max(error[k], magnitude(difference) / scale);
    }
  });
  return *std::ranges::max_element(error);
}

Rgb LitTable::Cell::at(float s, float t) const {
  Rgb out;
  for (std::size_t a = 4; a-- > 0;) {
    Rgb row;
    for (std::size_t b = 4; b-- > 0;) row = t * row + Rgb(c[4 * a + b]);
    out = s * out + row;
  }
  return out;
}

LitTableView LitTable::view() const {
  const auto grid = [](const BitGrid& of) {
    return GridView{of.range.from, of.range.to, of.unused_bits, of.first};
  };
  return {cells_.front().c.data(), grid(along_), grid(across_), across_.cells};
}

Rgb LitTable::color(float g, float g_light) const {
  if (!is_ratio(g) || !is_ratio(g_light)) return {};
  const auto [i, s] = along_.find(g);
  const auto [j, t] = across_.find(g_light);
  return cells_[static_cast<std::size_t>(i) * static_cast<std::size_t>(across_.cells) +
                static_cast<std::size_t>(j)]
      .at(s, t);
}

}  // namespace nullcone::postrender
