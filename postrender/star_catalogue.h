// Where stars come from: files, and chance.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "postrender/stars.h"

namespace nullcone::postrender {

inline constexpr std::size_t kMostStars = 4'000'000;
inline constexpr double kColdestStar_K = 500, kHottestStar_K = 1e6;
inline constexpr double kBrightestMagnitude = -50, kFaintestMagnitude = 50;

/// Stars by chance: as many brighter than m as 10^(slope m) says, within the magnitudes; logarithms of
/// temperatures evenly within theirs; all over the sky, or in a round cluster (a normal distribution).
struct RandomStars {
  std::size_t count = 0;
  std::uint64_t seed = 0;
  std::array<double, 2> magnitudes = {0, 8}, temperatures_K = {3000, 15000};
  double slope = 0.5;
  std::optional<std::array<double, 2>> around_deg = {};  ///< right ascension and declination
  double spread_deg = 0;                                 ///< standard deviation along each direction
};

/// Rows [name,] right ascension, declination (degrees), magnitude, temperature (kelvin), separated by commas;
/// '#' begins a comment, a first row may hold names. Throws InputError "file: line n: ..."; `pointer` names
/// the entry of the look.
std::vector<Star> read_stars(const std::string& path, const std::string& pointer);

/// The same for the same numbers, everywhere.
void add_random_stars(const RandomStars& rule, std::vector<Star>& out);

}  // namespace nullcone::postrender
