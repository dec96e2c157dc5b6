// The bounds that the search near a falling object rests on (GoedelOrbit): speed and bend of rays in its rest
// frame.
#include "metrics/goedel_kernel.h"
#include "tests/random_rays.h"
#include "tests/sanitized.h"

#include <gtest/gtest.h>

namespace nullcone::test {
namespace {

using namespace nullcone::host;

constexpr Matrix3<double> kAxes = {{{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}};

TEST(OrbitBounds, HoldWhereverTheObjectFits) {
  Random random(1);
  int tried = 0;
  double fastest = 0, most_bent = 0;  // of what the bounds allow
  for (int object = 0; object < (kSanitized ? 40 : 600); ++object) {
    const double beta = random.uniform(0, 0.95);
    Vec3<double> direction = random.direction();
    if (object % 2) direction = normalised(Vec3<double>{{direction[0], direction[1], 0}});
    LocalFrame<Goedel> frame{Goedel{1}, {}, four_velocity(beta * direction), true, {}, kAxes};
    frame.prepare();
    const GoedelOrbit orbit = make_orbit(frame, random.logarithmic(1e-3, 0.6));
    if (!orbit.fits()) continue;
    for (int n = 0; n < 60; ++n, ++tried) {
      const Vec3<double> X = orbit.farthest * std::cbrt(random.uniform(0, 1)) * random.direction();
      const Vec4<double> event = frame.event(0.0, X);
      const Vec4<double> past = -moving(random.direction());
      const auto path = frame.metric.path(event, past);
      const double frequency = orbit.ray(orbit.launch(event), past).frequency, h = 1e-4 / frequency;
      Vec3<double> at[3];
      for (int i = 0; i < 3; ++i) {
        const Vec4<double> x = path.at((i - 1) * h).event;
        const double tau = proper_time(frame, x, 0.0);
        at[i] = frame.to_object(tau, spatial(frame.rest(x, tau)));
      }
      const double speed = norm((1 / (2 * h)) * (at[2] - at[0])) / frequency;
      const double bend = norm((1 / (h * h)) * (at[2] - 2.0 * at[1] + at[0])) / (frequency * frequency);
      // Differences over h know the second derivative to about 1e-6.
      EXPECT_LT(speed, orbit.stretch * (1 + 1e-6)) << "beta " << beta << " farthest " << orbit.farthest;
      EXPECT_GT(speed, 1 / orbit.stretch * (1 - 1e-6)) << "beta " << beta << " farthest " << orbit.farthest;
      EXPECT_LT(bend, orbit.bend + 1e-5) << "beta " << beta << " farthest " << orbit.farthest;
      fastest = std::max({fastest, speed / orbit.stretch, 1 / (speed * orbit.stretch)});
      most_bent = std::max(most_bent, bend / (orbit.bend + 1e-5));
    }
  }
  EXPECT_GT(tried, kSanitized ? 100 : 5000);
  RecordProperty("fastest_of_allowed", std::to_string(fastest));
  RecordProperty("most_bent_of_allowed", std::to_string(most_bent));
}

}  // namespace
}  // namespace nullcone::test
