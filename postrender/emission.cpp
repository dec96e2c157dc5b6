#include "postrender/emission.h"

#include <algorithm>
#include <cmath>

namespace nullcone::postrender {

double lit(const Blink& blink, const Times& times) {
  const double duty = blink.duty.at(times);
  double x = times.at(blink.clock) / blink.period - blink.phase.at(times);
  if (!std::isfinite(x) || duty <= 0) return 0;
  if (duty >= 1) return 1;
  x -= std::floor(x);
  if (blink.fade == 0) return x < duty ? 1 : 0;
  const double inside = x < duty ? std::min(x, duty - x) : -std::min(x - duty, 1 - x);
  return std::clamp(0.5 + inside * blink.period / blink.fade, 0.0, 1.0);
}

SeenReference seen_reference(const ChangingTemperature& body, const Times& times, float g) {
  if (!(g > 0) || !std::isfinite(g)) return {1, 0};
  const auto shift = static_cast<double>(g);
  const double ratio = body.temperature_K.at(times) / body.reference_K;
  // As told in spectrum.h: L(g lambda; T) = g^-5 B(lambda; g T).
  const double power = body.effects.power() - (body.effects.doppler ? 5 : 0);
  const double factor = power == 0 ? 1 : std::pow(shift, power);
  return {static_cast<float>(body.effects.doppler ? shift * ratio : ratio), factor};
}

ShiftRange reference_range(const ChangingTemperature& body, ShiftRange shifts) {
  const auto [least, most] = std::ranges::minmax(body.temperature_K.keys->values);
  const ShiftRange seen = body.effects.doppler ? shifts : ShiftRange{};
  return {static_cast<float>(static_cast<double>(seen.from) * least / body.reference_K),
          static_cast<float>(static_cast<double>(seen.to) * most / body.reference_K)};
}

Clocks Emission::clocks() const {
  Clocks out;
  out.add(opacity);
  out.add(intensity);
  if (blink) {
    out.add(blink->clock);
    out.add(blink->duty);
    out.add(blink->phase);
  }
  if (temperature) out.add(temperature->temperature_K);
  return out;
}

}  // namespace nullcone::postrender
