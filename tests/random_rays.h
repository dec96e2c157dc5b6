// Random directions and events for tests; a fixed seed, so that a failure can be repeated.
#pragma once

#include <random>

#include "core/base/vector.h"

namespace nullcone::test {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(engine_); }
  double normal() { return std::normal_distribution<double>()(engine_); }
  /// From `from` to `to`, evenly in the logarithm.
  double logarithmic(double from, double to) { return from * std::exp(uniform(0, std::log(to / from))); }
  host::Vec3<double> direction() {
    return host::normalised(host::Vec3<double>{{normal(), normal(), normal()}});
  }
  /// An event with |x|, |y| up to `reach`.
  host::Vec4<double> event(double reach) {
    return {{uniform(-5, 5), uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach)}};
  }

 private:
  std::mt19937_64 engine_;
};

/// A photon of frequency 1, or a particle of local velocity `speed`, in the static tetrad.
inline host::Vec4<double> moving(const host::Vec3<double>& n, double speed = 1) {
  return {{1.0, speed * n[0], speed * n[1], speed * n[2]}};
}

}  // namespace nullcone::test
