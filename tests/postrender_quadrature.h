// An independent way from spectra to what a sensor sees.
#pragma once

#include <cmath>
#include <functional>

#include "postrender/sensor.h"

namespace nullcone::postrender {

using Color = std::array<double, 3>;

/// An independent quadrature: Simpson's rule, 64 steps in each interval between two samples of the sensor.
inline Color simpson(const std::function<double(double)>& L, const Sensor& sensor, double g) {
  Color sum{};
  for (std::size_t k = 0; k + 1 < sensor.response.size(); ++k) {
    constexpr int kSteps = 64;
    for (int i = 0; i <= kSteps; ++i) {
      const double s = static_cast<double>(i) / kSteps;
      const double nm = sensor.first_nm + sensor.step_nm * (static_cast<double>(k) + s);
      const double weight = (i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2) * sensor.step_nm / (3 * kSteps);
      for (std::size_t c = 0; c < 3; ++c)
        sum[c] += weight * std::lerp(sensor.response[k][c], sensor.response[k + 1][c], s) * L(g * nm);
    }
  }
  return sum;
}

}  // namespace nullcone::postrender
