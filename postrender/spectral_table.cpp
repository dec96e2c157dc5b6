#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "postrender/bit_grid.h"

namespace nullcone::postrender {

namespace {

using Color = std::array<double, 3>;
constexpr int kFewestBits = 4;

Color bounded(Color c) {
  const double largest = magnitude(c);
  if (largest <= kBrightestEntry) return c;
  if (!(largest < std::numeric_limits<double>::infinity()))
    return {kBrightestEntry, kBrightestEntry, kBrightestEntry};
  for (double& x : c) x *= kBrightestEntry / largest;
  return c;
}

/// The cubic through the values at 0, 1/3, 2/3 and 1.
using Cubic = std::array<Color, 4>;
Cubic cubic(const Color* y) {
  Cubic out;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = cubic_through(y[0][i], y[1][i], y[2][i], y[3][i]);
    for (std::size_t j = 0; j < 4; ++j) out[j][i] = k[j];
  }
  return out;
}

Color value_of(const Cubic& c, double s) {
  Color out;
  for (std::size_t i = 0; i < 3; ++i) out[i] = c[0][i] + s * (c[1][i] + s * (c[2][i] + s * c[3][i]));
  return out;
}

TableNode node_of(const Cubic& c) {
  TableNode out;
  for (std::size_t k = 0; k < 4; ++k)
    out.c[k] = Rgb{static_cast<float>(c[k][0]), static_cast<float>(c[k][1]), static_cast<float>(c[k][2])};
  return out;
}

/// One colour by g, refined by halving the cells: the samples of one grid, and the values between them, are
/// the samples of the next. Cells that are exact enough are halved by their own cubics.
class Column {
 public:
  Column(const SpectralTable::Colors& colors, const BitGrid& grid) : colors_(colors) {
    samples_.resize(size(3 * grid.cells + 1));
    tbb::parallel_for(std::int32_t{0}, 3 * grid.cells + 1, [&](std::int32_t i) {
      samples_[size(i)] = bounded(colors_(grid.place(i / 3, i % 3 / 3.0)));
    });
    settled_.assign(size(grid.cells), false);
    look_between(grid);
  }
  void refine(const BitGrid& fine) {
    std::vector<Color> merged;
    std::vector<bool> settled;
    for (std::size_t i = 0; i < between_.size(); ++i) merged.insert(merged.end(), {samples_[i], between_[i]});
    merged.push_back(samples_.back());
    for (const bool one : settled_) settled.insert(settled.end(), {one, one});
    samples_ = std::move(merged);
    settled_ = std::move(settled);
    look_between(fine);
  }
  Cubic cubic_of(std::int32_t cell) const { return cubic(&samples_[size(3 * cell)]); }

  /// The worst error between samples, relative to the colour there or a hundredth of the largest within half
  /// an octave. Cells of less than kTableError / 8 need no more looking at.
  double settle(const BitGrid& grid) {
    std::vector<double> error(size(grid.cells)), largest(size(grid.cells)), nearby(largest);
    for (std::int32_t cell = 0; cell < grid.cells; ++cell)
      for (int k = 0; k < 3; ++k)
        largest[size(cell)] = std::max(largest[size(cell)], magnitude(samples_[size(3 * cell + k)]));
    const std::int32_t reach = std::max(1, (1 << (23 - grid.unused_bits)) / 2);
    const auto stride = std::max(1, reach / 16);  // a rough look is enough
    double worst = 0;
    for (std::int32_t cell = 0; cell < grid.cells; ++cell) {
      if (settled_[size(cell)]) continue;
      double floor = largest[size(cell)];
      for (std::int32_t other = std::max(0, cell - reach); other < std::min(grid.cells, cell + reach + 1);
           other += stride)
        floor = std::max(floor, 0.01 * largest[size(other)]);
      if (!(floor > 1e-30)) continue;
      const double found = error_of(cell) / floor;
      worst = std::max(worst, found);
      settled_[size(cell)] = found < kTableError / 8;
    }
    return worst;
  }

 private:
  static std::size_t size(std::int32_t i) { return static_cast<std::size_t>(i); }

  double error_of(std::int32_t cell) const {
    const Cubic found = cubic_of(cell);
    double out = 0;
    for (int k = 0; k < 3; ++k) {
      const Color a = value_of(found, (k + 0.5) / 3), b = between_[size(3 * cell + k)];
      out = std::max(out, magnitude({a[0] - b[0], a[1] - b[1], a[2] - b[2]}));
    }
    return out;
  }

  void look_between(const BitGrid& grid) {
    between_.resize(size(3 * grid.cells));
    tbb::parallel_for(std::int32_t{0}, grid.cells, [&](std::int32_t cell) {
      for (int k = 0; k < 3; ++k) {
        const double s = (k + 0.5) / 3;
        between_[size(3 * cell + k)] =
            settled_[size(cell)] ? value_of(cubic_of(cell), s) : bounded(colors_(grid.place(cell, s)));
      }
    });
  }

  const SpectralTable::Colors& colors_;
  std::vector<Color> samples_, between_;
  std::vector<bool> settled_;  ///< by cell
};

}  // namespace

SpectralTable::SpectralTable(const std::vector<Colors>& colors, ShiftRange range)
    : stride_(static_cast<std::int32_t>(colors.size())) {
  BitGrid grid(range, kFewestBits);
  std::vector<Column> columns;
  for (const Colors& one : colors) columns.emplace_back(one, grid);
  const auto settle = [&] {
    double worst = 0;
    for (Column& column : columns) worst = std::max(worst, column.settle(grid));
    return worst;
  };
  const auto room = [&](const BitGrid& of) {
    return static_cast<std::size_t>(of.cells) * colors.size() * sizeof(TableNode) <= kTableBytes;
  };
  error_ = settle();
  while (error_ > kTableError && room(grid.halved())) {
    grid = grid.halved();
    for (Column& column : columns) column.refine(grid);
    error_ = settle();
  }
  range_ = grid.range;
  unused_bits_ = grid.unused_bits;
  first_ = grid.first;
  for (std::int32_t cell = 0; cell < grid.cells; ++cell)
    for (const Column& column : columns) nodes_.push_back(node_of(column.cubic_of(cell)));
}

TableView SpectralTable::view() const {
  return {nodes_.data(), range_.from, range_.to, unused_bits_, first_, stride_};
}

LinesView LineTable::view(bool mixed) const {
  return {lines.data(),    lines.size(), mixed,
          first_nm,        1 / step_nm,  static_cast<double>(response.size() - 1),
          response.data(), power->view()};
}

}  // namespace nullcone::postrender
