// The Gödel universe integrated, against its closed form, as far as it goes.
#include <gtest/gtest.h>

#include "core/trace/integrated_geodesic.h"
#include "metrics/goedel.h"
#include "tests/random_rays.h"

namespace nullcone::test {
namespace {

using namespace host;

/// The largest difference between both after `periods` turns, in units of the spacetime's local scale.
double worst_difference(double a, double radius, double periods, const Accuracy& accuracy, unsigned seed) {
  const Goedel metric{a};
  Random random(seed);
  double worst = 0;
  for (int i = 0; i < 20; ++i) {
    const double angle = random.uniform(0, 6.283), out = radius * a;
    const Vec4<double> event = {{0, out * std::cos(angle), out * std::sin(angle), random.uniform(-a, a)}};
    const Vec4<double> k = moving(random.direction(), i % 4 == 0 ? 0.6 : 1);
    const auto path = metric.path(event, k);
    const double end = periods * 4.442882938158366 * a / path.kappa;  // psi = pi a turn
    const std::array<double, 2> lambda = {end, -end};
    const auto points =
        integrated_geodesic(metric, event, static_tetrad(metric, event).to_chart(k), lambda, accuracy);
    for (std::size_t n = 0; n < 2; ++n) {
      EXPECT_EQ(points[n].status, Status::hit);
      const Vec4<double> off = Vec4<double>{points[n].event} - path.at(lambda[n]).event;
      worst = std::max(worst, norm(off) / std::max(2 * a, norm(spatial(event))));
    }
  }
  return worst;
}

TEST(IntegratedGoedel, AgreesWithTheClosedFormOverFiftyTurns) {
  // Errors of momentum add up with the turns, those of position with their square: 50^2 tolerances, times
  // ten. Beyond the Goedel radius 2a errors of direction grow as (1 + q^2), q = r/2a, on the way to the axis
  // and back.
  for (const double a : {1e-3, 1.0, 1e8})
    for (const double radius : {0.0, 0.5, 1.9, 2.1, 6.0}) {
      const double amplified = 1 + 0.25 * radius * radius;
      const Accuracy sharp{1e-13, 0, Integrator::prince_dormand87};
      EXPECT_LT(worst_difference(a, radius, 50, sharp, 3), 3e-9 * amplified * amplified)
          << a << " " << radius;
    }
}

TEST(IntegratedGoedel, ErrorsFollowTheTolerance) {
  for (std::size_t i = 0; i < kIntegratorNames.size(); ++i)
    for (const double rtol : {1e-6, 1e-8, 1e-10, 1e-12}) {
      const double off = worst_difference(1, 0, 1.5, {rtol, 0, static_cast<Integrator>(i)}, 4);
      EXPECT_LT(off, 100 * rtol) << kIntegratorNames[i] << rtol;
      EXPECT_GT(off, 1e-4 * rtol) << kIntegratorNames[i] << rtol << ": does the tolerance have an influence?";
    }
}

TEST(IntegratedGoedel, NumbersThatAreNoneEndWithAStatus) {
  const Goedel metric;
  const Vec4<double> event = {{0, 0.3, 0.2, 0}},
                     k = static_tetrad(metric, event).to_chart({{-1, 0.6, 0, 0.8}});
  const std::array<double, 3> lambda = {0.0, 1.0, -1.0};
  for (const double bad : {double(NAN), double(INFINITY), -double(INFINITY), 1e300})
    for (std::size_t i = 1; i < 4; ++i) {
      Vec4<double> x = event, v = k;
      x[i] = bad;
      const bool far_along_z = i == 3 && bad == 1e300;  // which changes nothing in this spacetime
      for (const GeodesicPoint& p :
           integrated_geodesic(metric, x, k, std::span(lambda).subspan(1), kBalanced))
        EXPECT_EQ(p.status == Status::hit, far_along_z) << "event " << i << " " << bad;
      v[i] = bad;
      for (const GeodesicPoint& p :
           integrated_geodesic(metric, event, v, std::span(lambda).subspan(1), kBalanced))
        EXPECT_NE(p.status, Status::hit) << "tangent " << i << " " << bad;
    }
  EXPECT_EQ(integrated_geodesic(metric, event, k, lambda, kBalanced)[0].event, event.c);
}

}  // namespace
}  // namespace nullcone::test
