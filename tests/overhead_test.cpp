// A sphere at rest straight above the observer, along the axis of the Gödel universe: rays that run nearly
// along the axis never leave the cylinder about the sphere.
#include <numbers>

#include "tests/reference_cases.h"
#include "tests/traced.h"

namespace nullcone::test {
namespace {

using namespace nullcone::host;

constexpr double kLookback = 9;

/// How near a ray from the origin comes to the point at `height` on the axis, in the chart, which is the rest
/// frame of a sphere there. With the direction's part s across the axis and n_z along it, the ray has
/// r = r_max |sin psi|, z = n_z lambda, psi = kappa lambda/(sqrt2 a), r_max = 2 a s/sqrt(2 - s^2), a = 1.
double nearest(const Vec3<double>& look, double height) {
  const double s2 = look[0] * look[0] + look[1] * look[1], kappa = std::sqrt(1 - s2 / 2);
  const double r_max = 2 * std::sqrt(s2 / (2 - s2));
  double least = 1e300;
  constexpr int kPoints = 1000;
  const double from = std::max(std::fabs(height) - 0.45, 0.0) / std::fabs(look[2]);  // radii are below that
  const double to = std::min((std::fabs(height) + 0.45) / std::fabs(look[2]), kLookback);
  for (int i = 0; i <= kPoints && from < to; ++i) {
    const double lambda = from + (to - from) * i / kPoints;
    const double r = r_max * std::sin(kappa * lambda / std::numbers::sqrt2), z = look[2] * lambda - height;
    least = std::min(least, std::hypot(r, z));
  }
  return least;
}

TEST(Overhead, RaysAlongTheAxisMeetWhatStandsThere) {
  for (const double height : {-1.0, 0.5, 1.0, 2.2, 3.7, 4.4})
    for (const double radius : {0.05, 0.13, 0.4}) {
      const Traced traced = trace_text(
          R"({"metric": {"name": "goedel"}, "observer": {"event": [0, 0, 0, 0]}, "max_lookback": 9, "camera": {
          "type": "fisheye", "forward": [0, 0, )" +
          std::to_string(height) +
          R"(], "up": [0, 1, 0], "fov_deg": 120, "resolution": [80, 80]}, "objects": [{"name": "ball",
          "shape": {"type": "sphere", "radius": )" +
          std::to_string(radius) +
          R"(}, "placing": {"type": "local", "worldline": {"type": "static", "event": [0, 0, 0, )" +
          std::to_string(height) + "]}}}]}");
      std::vector<int> met(80 * 80, 0);
      traced.for_each_hit([&](const HitRecord&, std::size_t x, std::size_t y) { met[80 * y + x] = 1; });
      std::size_t meet = 0;
      for (std::size_t y = 0; y < 80; ++y)
        for (std::size_t x = 0; x < 80; ++x) {
          if (std::hypot(static_cast<double>(x) - 39.5, static_cast<double>(y) - 39.5) > 39.5) continue;
          const double distance = nearest(traced.look(x, y), height);
          if (std::fabs(distance - radius) < 1e-4) continue;  // what so many points leave open
          EXPECT_EQ(met[80 * y + x], distance < radius)
              << "height " << height << " radius " << radius << " pixel " << x << ", " << y;
          meet += distance < radius;
        }
      EXPECT_GT(meet, 3U) << "height " << height << " radius " << radius;
    }
}

}  // namespace
}  // namespace nullcone::test
