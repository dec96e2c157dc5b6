// Hundreds of thousands of random rays against boxes, slivers and moving ones among them: no crossing is
// missed, none is invented, neither on the way in nor out.
#include "core/trace/closed_onward.h"
#include "metrics/minkowski_kernel.h"
#include "tests/box_oracle.h"
#include "tests/random_rays.h"
#include "tests/sanitized.h"

namespace nullcone::test {
namespace {

using namespace nullcone::host;

constexpr int kBoxRays = kSanitized ? 10'000 : 150'000;
constexpr double kBoxLimit = 100;

struct BoxTally {
  int rays = 0, hits = 0, missed = 0, invented = 0, misplaced = 0, given_up = 0, unpaired = 0, moved = 0;

  /// `rounding` is a length: what may be called either way.
  template <class Path, class Body, class Ray>
  void compare(const BoxOracle& oracle, const Path& path, const Body& body, const Ray& ray, const Box& box,
               double resolution, double rounding) {
    ++rays;
    hits += oracle.meets();
    const Search<double> first = first_crossing(ray, box, kBoxLimit, resolution);
    bool lost = first.given_up;
    const std::vector<double> all = all_crossings(ray, box, kBoxLimit, resolution, lost);
    given_up += lost;
    missed += oracle.meets() && (!first.met || all.empty()) && oracle.depth() > rounding;
    unpaired += all.size() != 0 && all.size() != 2;
    invented += first.met && oracle.outside_by(first.lambda) > rounding;
    if (!oracle.meets()) return;
    const auto place = [&](double found, BoxOracle::L expected, std::size_t axis) {
      const double lambda = polish(path, body, box, found).lambda;
      const double steep = static_cast<double>(std::fabs(oracle.k[axis]));
      misplaced += std::fabs(lambda - static_cast<double>(expected)) * steep > rounding;
    };
    if (first.met && oracle.depth() > rounding) place(first.lambda, oracle.enter, oracle.axis_in);
    if (all.size() == 2 && oracle.depth() > rounding) {
      place(all[0], oracle.enter, oracle.axis_in);
      place(all[1], oracle.leave, oracle.axis_out);
    }
    moved += all.size() == 2 && all[0] != first.lambda;
  }
  void expect_clean() const {
    EXPECT_EQ(missed, 0);
    EXPECT_EQ(invented, 0);
    EXPECT_EQ(misplaced, 0);
    EXPECT_EQ(given_up, 0);
    EXPECT_EQ(unpaired, 0);
    EXPECT_EQ(moved, 0);
    EXPECT_GT(rays, kBoxRays / 2);
    EXPECT_GT(hits, rays / 8);
    EXPECT_LT(hits, rays * 7 / 8);
  }
};

/// Rays towards the point `target(edges)` of a box of random edges, in motion or at rest.
template <class Target>
BoxTally rays_towards(unsigned seed, double fastest, const Target& target) {
  Random random(seed);
  BoxTally tally;
  const Minkowski metric;
  for (int n = 0; n < kBoxRays; ++n) {
    const Vec3<double> edges = random_edges(random, random.logarithmic(1e-3, 1));
    const Vec4<double> u = four_velocity(random.uniform(0, fastest) * random.direction());
    const Vec3<double> z = random.direction(), x = normalised(cross(random.direction(), z));
    const LocalFrame<Minkowski> frame{metric, random.event(3), u, false, {}, {x, cross(z, x), z}};
    const auto [X, slope] = target(random, edges);
    // From the crossing with the point back to the future, in the object's frame and in the chart.
    const double tau = random.uniform(-3, 3), back = random.uniform(0.1, 20) / u[0];
    const auto chart = [&](const Vec3<double>& a) { return a[0] * x + a[1] * frame.axes[1] + a[2] * z; };
    const Vec3<double> k = chart(slope);
    const Vec4<double> past = boost(opposite(u), Vec4<double>{{-1, k[0], k[1], k[2]}});
    const Vec4<double> start = frame.event(tau, X) - back * past;
    using L = long double;
    const Vec4<L> from = boost(convert<L>(u), convert<L>(start - frame.start)),
                  along = boost(convert<L>(u), convert<L>(past));
    const auto rows = convert<L>(frame.axes);
    const BoxOracle oracle(rows * spatial(from), rows * spatial(along), edges);
    if (!oracle.starts_outside() || oracle.enter > kBoxLimit) continue;
    const MovingPlacing<Minkowski> placing{frame, make_orbit(frame, 1), false};
    const LocalBody<Minkowski> body{frame, placing.orbit};
    const Box box{0.5 * edges[0], 0.5 * edges[1], 0.5 * edges[2]};
    const auto ray = placing.ray(placing.launch(start), past);
    // Rounding of the coordinates, as the boost enlarges it.
    const double rounding = 2e-14 * u[0] * u[0] * (1 + norm(start) + norm(frame.start) + 20);
    tally.compare(oracle, ray.path, body, ray, box, 4e-15 * norm(spatial(start)), rounding);
  }
  return tally;
}

struct Aim {
  Vec3<double> X, slope;
};
Vec3<double> inside(Random& random, const Vec3<double>& edges, double part) {
  return Vec3<double>::map([&](std::size_t i) { return part * edges[i] * random.uniform(-0.5, 0.5); });
}

TEST(Box, IsMetByRaysFromEverywhere) {
  const auto target = [](Random& random, const Vec3<double>& edges) {
    return Aim{inside(random, edges, 1.6), random.direction()};
  };
  rays_towards(1, 0, target).expect_clean();
  rays_towards(2, 0.99, target).expect_clean();
}

TEST(Box, EdgesAndCornersAreGrazed) {
  // Points near edges (one component free) and corners, from far off down to what rounding resolves.
  const auto target = [](Random& random, const Vec3<double>& edges) {
    Vec3<double> X = inside(random, edges, 1);
    const double least = std::min({edges[0], edges[1], edges[2]});
    const auto free = static_cast<std::size_t>(random.uniform(0, 6));  // 3 and more: a corner
    for (std::size_t i = 0; i < 3; ++i)
      if (i != free)
        X[i] = std::copysign(0.5 * edges[i], X[i]) +
               std::copysign(random.logarithmic(1e-12, 0.1), random.normal()) * least;
    return Aim{X, random.direction()};
  };
  rays_towards(3, 0, target).expect_clean();
  rays_towards(4, 0.9, target).expect_clean();
}

TEST(Box, RaysAlongFacesAreToldApart) {
  // Almost parallel to a face, in front of it or behind it by little.
  const auto target = [](Random& random, const Vec3<double>& edges) {
    Vec3<double> X = inside(random, edges, 1.2), slope = random.direction();
    const auto i = static_cast<std::size_t>(random.uniform(0, 3));
    X[i] = std::copysign(0.5 * edges[i] * (1 + random.uniform(-1, 1) * random.logarithmic(1e-9, 1)), X[i]);
    slope[i] *= random.uniform(0, 1) < 0.1 ? 0 : random.logarithmic(1e-12, 1);
    return Aim{X, normalised(slope)};
  };
  rays_towards(5, 0, target).expect_clean();
  rays_towards(6, 0.9, target).expect_clean();
}

}  // namespace
}  // namespace nullcone::test
