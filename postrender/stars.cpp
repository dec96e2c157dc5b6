#include "postrender/stars.h"

#include <numeric>

namespace nullcone::postrender {

double illuminance_lx(double magnitude) { return kMagnitude0_lx * std::pow(10, -0.4 * magnitude); }

Direction direction_of(double right_ascension_deg, double declination_deg) {
  const double a = right_ascension_deg * std::numbers::pi / 180, d = declination_deg * std::numbers::pi / 180;
  return {std::cos(d) * std::cos(a), std::cos(d) * std::sin(a), std::sin(d)};
}

std::size_t StarField::cell_of(const Star& star) const {
  const auto [x, y, z] = star.direction;
  const Row& row =
      rows_[static_cast<std::size_t>(row_at(std::asin(std::clamp(static_cast<double>(z), -1.0, 1.0))))];
  const double longitude = std::atan2(static_cast<double>(y), static_cast<double>(x));
  return row.first +
         static_cast<std::size_t>(wrapped((longitude / (2 * std::numbers::pi) + 0.5) * row.count, row.count));
}

StarField::StarField(std::vector<Star> stars) {
  // Step 1: cells for two stars each, as wide as they are high.
  constexpr double kMostRows = 4096;
  const double rows =
      std::clamp(std::sqrt(static_cast<double>(stars.size()) * std::numbers::pi / 8), 4.0, kMostRows);
  const int count = static_cast<int>(rows);
  std::size_t cells = 0;
  for (int row = 0; row < count; ++row) {
    const double middle = ((row + 0.5) / count - 0.5) * std::numbers::pi;
    rows_.push_back({cells, std::max(1, static_cast<int>(2 * count * std::cos(middle)))});
    cells += static_cast<std::size_t>(rows_.back().count);
  }
  // Step 2: sort the stars into them.
  std::vector<std::size_t> cell(stars.size());
  offset_.resize(cells + 1);
  for (std::size_t i = 0; i < stars.size(); ++i) ++offset_[(cell[i] = cell_of(stars[i])) + 1];
  std::partial_sum(offset_.begin(), offset_.end(), offset_.begin());
  std::vector<std::uint32_t> next(offset_.begin(), offset_.end() - 1);
  stars_.resize(stars.size());
  for (std::size_t i = 0; i < stars.size(); ++i) stars_[next[cell[i]]++] = stars[i];
  if (stars.empty()) return;
  const auto [coldest, hottest] = std::ranges::minmax(stars, {}, &Star::temperature_K);
  temperatures_ = {coldest.temperature_K, hottest.temperature_K};
}

}  // namespace nullcone::postrender
