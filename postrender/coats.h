// What an object wears when: its own appearance, those of its time slices over it, and several at once where
// they fade into one another.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "postrender/changing.h"

namespace nullcone::postrender {

/// From `from` (included) to `to` (excluded) an object has another appearance.
struct Slice {
  Clock clock = Clock::t;
  double from = 0, to = 0;
  /// How long it takes to come and to go: linearly, half before and half after `from` and `to`.
  double fade_in = 0, fade_out = 0;
  std::size_t appearance = 0;  ///< the first of those that follow one another along `timeline`
  Timeline timeline = {};

  double start() const { return from - fade_in / 2; }
  double end() const { return to + fade_out / 2; }
  /// How much of it is there, from 0 to 1.
  double share(double time) const;
  bool operator==(const Slice&) const = default;
};

/// The slices of an object, and at hand which of them may hold when: a look-up takes the logarithm of their
/// number.
class SliceTable {
 public:
  SliceTable() = default;
  /// Throws TooManyFades where more than kMostFades would be seen through one another.
  explicit SliceTable(std::vector<Slice> slices);
  static constexpr std::size_t kMostFades = 16;
  struct TooManyFades {
    double time;
  };

  const std::vector<Slice>& slices() const { return slices_; }
  /// Numbers of the slices of one clock that may hold, the first first, down to one that holds wholly.
  std::span<const std::uint32_t> candidates(Clock clock, double time) const;
  bool operator==(const SliceTable& other) const { return slices_ == other.slices_; }

 private:
  struct OneClock {
    std::vector<double> edges;         ///< where anything begins or ends
    std::vector<std::uint32_t> begin;  ///< candidates before the first edge, after it, ...
    std::vector<std::uint32_t> numbers;
  };
  OneClock tabulated(Clock clock) const;

  std::vector<Slice> slices_;
  OneClock t_, tau_;
};

struct ObjectShading {
  double tau_origin = 0;
  std::size_t appearance = 0;  ///< the first of those that follow one another along `timeline`
  SliceTable slices = {};      ///< over it; the first that holds wins
  Timeline timeline = {};

  /// Whether always the one appearance is seen.
  bool plain() const { return slices.slices().empty() && timeline.count == 1; }
  /// Whether several appearances may be seen at once.
  bool blends() const;
  Clocks clocks() const;
  bool operator==(const ObjectShading&) const = default;
};

/// One of the appearances that a crossing shows, and its share of the light.
struct Coat {
  std::uint32_t appearance;
  float share;
};
using Coats = std::array<Coat, 2 * (2 * SliceTable::kMostFades + 1)>;

/// What an object wears: writes at least one coat and returns how many. Shares add up to 1.
std::size_t find_coats(const ObjectShading& object, const Times& times, Coats& out);

}  // namespace nullcone::postrender
