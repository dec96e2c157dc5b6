// Stars of a sky: points with a brightness and a temperature, and a grid on the sphere in which they are
// found.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

namespace nullcone::postrender {

using Direction = std::array<double, 3>;  ///< of length 1

struct Star {
  std::array<float, 3> direction;  ///< in which it is seen: of length 1, in the sky's static frame
  float illuminance_lx;            ///< there, without lens and motion
  float temperature_K;
};

/// What a star of apparent visual magnitude 0 brings outside of the atmosphere, in lx (C. W. Allen,
/// Astrophysical Quantities, 1973, section 13).
inline constexpr double kMagnitude0_lx = 2.54e-6;
double illuminance_lx(double magnitude);

/// The direction of a right ascension and declination: +x at (0, 0), +y at (90, 0), +z at the pole.
Direction direction_of(double right_ascension_deg, double declination_deg);

/// Stars in the cells of a grid of latitudes and longitudes that are all about as large.
class StarField {
 public:
  explicit StarField(std::vector<Star> stars);

  /// Cell by cell, and in each in the order in which they came.
  std::span<const Star> stars() const { return stars_; }
  /// From..to in kelvin; (1, 1) where there are none.
  std::array<float, 2> temperatures() const { return temperatures_; }

  /// Calls f(first, last) for numbers of stars, among which are all that lie within `reach` (in radians,
  /// below 1) of the direction at this latitude and longitude.
  template <class F>
  void near(double latitude, double longitude, double reach, F&& f) const {
    const int low = row_at(latitude - reach), high = row_at(latitude + reach);
    // Nowhere farther aside than arcsin(sin(reach) / cos(latitude)).
    const double cosine = std::cos(latitude);
    const bool all_around = !(reach < cosine);
    const double aside = all_around ? 0 : std::numbers::pi / 2 * reach / cosine;
    for (int row = low; row <= high; ++row) {
      const Row& at = rows_[static_cast<std::size_t>(row)];
      const auto range = [&](int first, int last) {  // both included
        const std::uint32_t from = offset_[at.first + static_cast<std::size_t>(first)];
        const std::uint32_t to = offset_[at.first + static_cast<std::size_t>(last) + 1];
        if (from < to) f(from, to);
      };
      const double per_radian = at.count / (2 * std::numbers::pi);
      const double west = (longitude - aside + std::numbers::pi) * per_radian,
                   east = (longitude + aside + std::numbers::pi) * per_radian;
      if (all_around || east - west >= at.count - 1) {
        range(0, at.count - 1);
        continue;
      }
      const int first = wrapped(west, at.count), last = wrapped(east, at.count);
      if (first <= last) {
        range(first, last);
      } else {
        range(first, at.count - 1);
        range(0, last);
      }
    }
  }

 private:
  struct Row {
    std::size_t first;  ///< cell
    int count;
  };
  int row_at(double latitude) const {
    const auto rows = static_cast<double>(rows_.size());
    return static_cast<int>(std::clamp((latitude / std::numbers::pi + 0.5) * rows, 0.0, rows - 1));
  }
  static int wrapped(double cell, int count) {
    const int at = static_cast<int>(std::floor(cell)) % count;
    return at < 0 ? at + count : at;
  }
  std::size_t cell_of(const Star& star) const;

  std::vector<Star> stars_;
  std::vector<Row> rows_;              ///< from south to north
  std::vector<std::uint32_t> offset_;  ///< of the first star of each cell, and behind the last
  std::array<float, 2> temperatures_ = {1, 1};
};

}  // namespace nullcone::postrender
