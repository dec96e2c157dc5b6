#include "postrender/lit_table.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace nullcone::postrender {

namespace {

using Color = std::array<double, 3>;
constexpr int kFewestBits = 2, kMostBits = 6;
constexpr double kError = 1e-6;

bool sensible(float g) { return g > 0 && g < std::numeric_limits<float>::infinity(); }

}  // namespace

LitTable::LitTable(AnySpectrum lamp, AnySpectrum reflectance, const Effects& effects, const Sensor& sensor,
                   ShiftRange shifts, ShiftRange light_shifts)
    : along_(shifts, kFewestBits), across_(light_shifts, kFewestBits) {
  const double power = effects.power(), light_power = !effects.searchlight ? 0
                                                      : effects.doppler    ? effects.irradiance.spectral
                                                                           : effects.irradiance.integrated;
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
    if (error_ < kError || bits == kMostBits || 4 * bytes() > kTableBytes) return;
  }
}

void LitTable::fill(const Colors& colors) {
  cells_.resize(static_cast<std::size_t>(along_.cells) * static_cast<std::size_t>(across_.cells));
  tbb::parallel_for(std::size_t{0}, cells_.size(), [&](std::size_t k) {
    const auto i = static_cast<std::int32_t>(k) / across_.cells,
               j = static_cast<std::int32_t>(k) % across_.cells;
    std::array<std::array<Color, 4>, 4> y;
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < 4; ++b)
        y[a][b] =
            colors(along_.place(i, static_cast<double>(a) / 3), across_.place(j, static_cast<double>(b) / 3));
    for (std::size_t c = 0; c < 3; ++c) {
      std::array<std::array<double, 4>, 4> rows;
      for (std::size_t a = 0; a < 4; ++a)
        rows[a] = cubic_through(y[a][0][c], y[a][1][c], y[a][2][c], y[a][3][c]);
      for (std::size_t b = 0; b < 4; ++b) {
        const auto column = cubic_through(rows[0][b], rows[1][b], rows[2][b], rows[3][b]);
        for (std::size_t a = 0; a < 4; ++a) (&cells_[k].c[4 * a + b].r)[c] = static_cast<float>(column[a]);
      }
    }
  });
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
      const auto g = static_cast<float>(along_.place(i, s)),
                 g_light = static_cast<float>(across_.place(j, t));
      if (g < along_.range.from || g > along_.range.to || g_light < across_.range.from ||
          g_light > across_.range.to)
        continue;
      const Color exact = colors(static_cast<double>(g), static_cast<double>(g_light));
      const Rgb found = color(g, g_light);
      const Color difference = {static_cast<double>(found.r) - exact[0],
                                static_cast<double>(found.g) - exact[1],
                                static_cast<double>(found.b) - exact[2]};
      const double scale = std::max(magnitude(exact), 0.01 * largest);
      if (scale > 0) error[k] = std::max(error[k], magnitude(difference) / scale);
    }
  });
  return *std::ranges::max_element(error);
}

Rgb LitTable::color(float g, float g_light) const {
  if (!sensible(g) || !sensible(g_light)) return {};
  const auto [i, s] = along_.find(g);
  const auto [j, t] = across_.find(g_light);
  const auto& c = cells_[static_cast<std::size_t>(i) * static_cast<std::size_t>(across_.cells) +
                         static_cast<std::size_t>(j)]
                      .c;
  Rgb out;
  for (std::size_t a = 4; a-- > 0;) {
    Rgb row;
    for (std::size_t b = 4; b-- > 0;) row = t * row + Rgb(c[4 * a + b]);
    out = s * out + row;
  }
  return out;
}

}  // namespace nullcone::postrender
