// What changes with the time of emission: numbers, and the choice among pictures.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/keyframes.h"

namespace nullcone::postrender {

using Clock = Keyframes::Clock;

/// When one crossing emitted its light.
struct Times {
  double t = 0;    ///< coordinate time minus that of the observation
  double tau = 0;  ///< the object's own clock: channel tau plus its tau_origin

  /// Of the clocks t and tau.
  double at(Clock clock) const { return clock == Clock::tau ? tau : t; }
};

/// A number that may change with the time of emission.
struct Number {
  double constant = 0;
  std::optional<Keyframes> keys = {};

  double at(const Times& times) const { return keys ? keys->at(times.at(keys->clock)) : constant; }
  bool always(double value) const { return !keys && constant == value; }
  bool operator==(const Number&) const = default;
};

/// Pictures that follow one another in time: which one an instant sees, or which two of them.
struct Timeline {
  /// share of `second`, 1 - share of `first`.
  struct Place {
    std::size_t first, second;
    float share;
    bool operator==(const Place&) const = default;
  };

  Clock clock = Clock::t;
  double frame = 0;           ///< the time where the clock is that of the animation
  std::size_t count = 1;      ///< pictures
  std::vector<double> nodes;  ///< when each picture is seen alone, increasing; empty: evenly, as follows
  double from = 0, rate = 1;  ///< picture i is seen from `from` + i/rate on
  bool loop = false;          ///< begins anew after the last; else the first and the last one are held
  bool blend = true;          ///< from each picture linearly to the next; else each until the next

  /// Times that are no numbers see the first picture.
  Place at(const Times& times) const;
  bool operator==(const Timeline&) const = default;

 private:
  Place between_nodes(double time) const;
};

/// Clocks that something goes by.
struct Clocks {
  bool t = false, tau = false;
  void add(Clock clock) { t |= clock == Clock::t, tau |= clock == Clock::tau; }
  void add(const Number& number) {
    if (number.keys) add(number.keys->clock);
  }
  void add(const Clocks& others) {
    t |= others.t;
    tau |= others.tau;
  }
  bool any() const { return t || tau; }
};

}  // namespace nullcone::postrender
