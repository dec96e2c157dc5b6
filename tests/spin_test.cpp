// Boxes that spin about an axis of their own, at rest, fast and falling: where a ray is inside of them, point
// by point, against the crossings that the search has found before that point.
#include <gtest/gtest.h>

#include "metrics/goedel_kernel.h"
#include "metrics/minkowski_kernel.h"
#include "tests/box_oracle.h"
#include "tests/random_rays.h"
#include "tests/sanitized.h"

namespace nullcone::test {
namespace {

using namespace host;

struct Counts {
  std::size_t checked = 0, inside = 0, wrong = 0, lost = 0;
};

/// A ray that comes to the point X of the object at proper time tau after a way of `back`.
template <class M>
void compare(const MovingPlacing<M>& placing, const Box& box, const Vec3<double>& X, double tau,
             const Vec3<double>& n, double back, Counts& counts) {
  const LocalFrame<M>& frame = placing.frame;
  const double size = 2 * box.bounding_radius();
  const auto P = frame.metric.path(frame.event(tau, X), moving(n)).at(back);
  const auto ray = placing.ray(placing.launch(P.event), -P.local);
  bool given_up = false;
  const auto found = all_crossings(ray, box, back + 3 * size, 4e-15 * norm(spatial(P.event)), given_up);
  counts.lost += given_up;
  for (int i = 0; i < 400; ++i) {
    const double lambda = back + 0.01 * (i - 200) * size;
    if (lambda <= 0) continue;
    const Vec4<double> x_i = ray.path.at(lambda).event;
    const double at_time = proper_time(frame, x_i, placing.orbit.proper_time(x_i));
    const Vec3<double> at = frame.to_object(at_time, spatial(frame.rest(x_i, at_time)));
    const double f = std::max(
        {std::fabs(at[0]) - box.half_x, std::fabs(at[1]) - box.half_y, std::fabs(at[2]) - box.half_z});
    if (!(std::fabs(f) > 1e-10)) continue;
    const auto before = std::ranges::count_if(found, [&](double crossing) { return crossing < lambda; });
    ++counts.checked, counts.inside += f < 0;
    counts.wrong += (before % 2 == 1) != (f < 0);
  }
}

template <class M>
Counts rays_at_spinning_boxes(const M& metric, unsigned seed, double fastest, double largest) {
  Random random(seed);
  Counts counts;
  for (int object = 0; object < (kSanitized ? 4 : 80); ++object) {
    const Vec3<double> edges = random_edges(random, random.uniform(0.2, 1) * largest);
    const Box box{0.5 * edges[0], 0.5 * edges[1], 0.5 * edges[2]};
    const double ball = box.bounding_radius();
    const Vec3<double> z = random.direction(), x = normalised(cross(random.direction(), z));
    LocalFrame<M> frame{
        metric, random.event(1),     four_velocity(random.uniform(0, fastest) * random.direction()), true,
        {},     {x, cross(z, x), z}, {random.direction().c, random.uniform(-0.9, 0.9) / ball}};
    frame.prepare();
    const auto orbit = make_orbit(frame, ball);
    EXPECT_TRUE(orbit.fits());
    const MovingPlacing<M> placing{frame, orbit, false, 1.001 * ball};
    for (int n = 0; n < 40; ++n) {
      const auto X = Vec3<double>::map([&](std::size_t i) { return edges[i] * random.uniform(-0.7, 0.7); });
      compare(placing, box, X, random.uniform(-3, 3), random.direction(), random.uniform(1, 8), counts);
    }
  }
  return counts;
}

void expect_right(const Counts& counts) {
  EXPECT_EQ(counts.wrong, 0U);
  EXPECT_EQ(counts.lost, 0U);
  EXPECT_GT(counts.checked, kSanitized ? 50'000U : 1'000'000U);
  EXPECT_GT(counts.inside, counts.checked / 50);
}

TEST(SpinningBoxes, InMinkowski) { expect_right(rays_at_spinning_boxes(Minkowski{}, 1, 0.9, 1)); }
TEST(SpinningBoxes, InGoedel) { expect_right(rays_at_spinning_boxes(Goedel{2}, 2, 0.6, 0.2)); }

}  // namespace
}  // namespace nullcone::test
