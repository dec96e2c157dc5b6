// What a surface does by its clock, exactly for every pixel: it blinks, glows, fades and changes its
// temperature.
#pragma once

#include <optional>

#include "postrender/changing.h"
#include "postrender/spectrum.h"

namespace nullcone::postrender {

/// A lamp: lit for `duty` of each period, from time = phase * period on.
struct Blink {
  Clock clock = Clock::tau;
  double period = 1;         ///< > 0, in units of time
  Number duty{0.5}, phase;   ///< duty within [0, 1]
  double fade = 0;           ///< how long switching takes, about each edge, in units of time
  bool transparent = false;  ///< off: lets light through; else black
  bool operator==(const Blink&) const = default;
};

/// 1: lit, 0: off. Off where the time is not finite.
double lit(const Blink& blink, const Times& times);

/// A black body whose temperature changes. B(lambda; g T) = X(g T / T0), where X is what is seen of a body of
/// T0 with both effects: so one table serves all temperatures.
struct ChangingTemperature {
  Number temperature_K;
  double reference_K = 1;  ///< T0, that of the appearance's spectrum
  Effects effects;         ///< those of the look; the spectrum itself has both
  bool operator==(const ChangingTemperature&) const = default;
};

/// The frequency ratio at which the reference is to be looked up, and by how much its light is to be
/// multiplied. Black where g is not positive and finite.
struct SeenReference {
  float shift;
  double factor;
};
SeenReference seen_reference(const ChangingTemperature& body, const Times& times, float g);

/// The ratios at which the reference is looked up, for shifts within a range.
ShiftRange reference_range(const ChangingTemperature& body, ShiftRange shifts);

struct Emission {
  Number opacity{1};    ///< times that of the crossing, within [0, 1]
  Number intensity{1};  ///< a factor on the light, >= 0
  std::optional<Blink> blink;
  std::optional<ChangingTemperature> temperature;

  double opacity_at(const Times& times) const {
    return opacity.at(times) * (blink && blink->transparent ? lit(*blink, times) : 1);
  }
  double intensity_at(const Times& times) const {
    return intensity.at(times) * (blink && !blink->transparent ? lit(*blink, times) : 1);
  }
  Clocks clocks() const;
  bool operator==(const Emission&) const = default;
};

}  // namespace nullcone::postrender
