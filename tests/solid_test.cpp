// Random rays against bodies of every kind, and against what unions, intersections and differences make of
// them: no crossing is missed, none is invented, and each is where long double finds it.
#include <gtest/gtest.h>

#include "core/trace/closed_onward.h"
#include "metrics/minkowski_kernel.h"
#include "tests/sanitized.h"
#include "tests/solid_oracle.h"

namespace nullcone::test {
namespace {

using namespace nullcone::host;

constexpr int kSolidRays = kSanitized ? 4'000 : 60'000;
constexpr double kSolidLimit = 100;

AnyShape shape_of(const Solid& solid, bool inside) {
  return AnyShape(
      SolidShape{solid.primitives.data(), solid.steps.data(), solid.steps.size(), solid.ball, inside});
}

struct SolidTally {
  int rays = 0, hits = 0, missed = 0, invented = 0, misplaced = 0, given_up = 0;
  double worst = 0;  ///< over the rounding that is allowed

  void expect_clean() const {
    EXPECT_EQ(missed, 0);
    EXPECT_EQ(invented, 0);
    EXPECT_EQ(misplaced, 0);
    EXPECT_EQ(given_up, 0);
    EXPECT_LT(worst, 0.1);
    EXPECT_GT(rays, kSolidRays / 2);
    EXPECT_GT(hits, rays / 10);
  }
};

/// All crossings of a ray, polished, as closed_onward.h finds them.
template <class Ray, class Body>
std::vector<double> all_crossings(const Ray& ray, const Body& body, const AnyShape& shape, double resolution,
                                  bool& given_up) {
  std::vector<double> out;
  double lambda = 0;
  for (bool inside = shape.starts_inside(); out.size() < 40; inside = !inside) {
    Search<double> search(kSolidLimit);
    search.lambda = lambda;
    advance(ray, Onward<double, AnyShape>{shape, inside}, kSolidLimit, resolution, kSearchLimit, search);
    given_up |= search.given_up;
    if (!search.met) return out;
    const auto X =
        body.local(ray.path.at(search.lambda).event, local_time(body, ray.path.at(search.lambda).event, 0.0))
            .second;
    out.push_back(polish(ray.path, body, surface_near(shape, X), search.lambda).lambda);
    lambda = past_crossing(ray, shape, search, resolution);
  }
  given_up = true;
  return out;
}

/// How fast a ray comes nearer to the surface at a crossing.
double steepness(const SolidOracle& oracle, SolidOracle::L lambda, SolidOracle::L size) {
  const SolidOracle::L step = 1e-7L * size;
  const auto before = oracle.distance(oracle.at(lambda - step)),
             after = oracle.distance(oracle.at(lambda + step));
  return static_cast<double>(std::max(std::fabs(after - before), std::fabs(before) + std::fabs(after)) /
                             (2 * step));
}

/// A ray against a solid at rest; `rounding` is a length: what may be called either way.
template <class Ray, class Body>
void compare(const SolidOracle& oracle, const Ray& ray, const Body& body, const AnyShape& shape,
             double resolution, double rounding, SolidTally& tally) {
  ++tally.rays;
  bool lost = false;
  const std::vector<double> found = all_crossings(ray, body, shape, resolution, lost);
  tally.given_up += lost;
  const auto clear = oracle.clear_crossings(10 * rounding);
  tally.hits += !clear.empty();
  for (const auto expected : clear) {
    if (expected > kSolidLimit) continue;
    double best = 1e300;
    for (const double lambda : found)
      best = std::min(best, static_cast<double>(std::fabs(lambda - expected)));
    const double off = best * steepness(oracle, expected, shape.bounding_radius());
    tally.missed += off > 1e3 * rounding;
    tally.misplaced += off > rounding;
    tally.worst = std::max(tally.worst, off / rounding);
  }
  for (const double lambda : found)
    tally.invented += static_cast<double>(std::fabs(oracle.distance(oracle.at(lambda)))) > rounding;
  const Search<double> first = first_crossing(ray, shape, kSolidLimit, resolution);
  tally.missed += !clear.empty() && !first.met;
}

/// Rays towards solids at rest in the chart, from outside or inside. `make(random, scale)`.
template <class Make>
SolidTally rays_towards(unsigned seed, bool inside, double smallest, const Make& make) {
  Random random(seed);
  SolidTally tally;
  while (tally.rays < kSolidRays * 3 / 4) {
    const double scale = random.logarithmic(smallest, 1);
    const Solid solid = make(random, scale);
    const AnyShape shape = shape_of(solid, inside);
    const Vec3<double> aim = 0.8 * solid.ball * random.uniform(0, 1) * random.direction();
    const double back = random.uniform(1.1, 20);
    const Vec3<double> n = random.direction(),
                       from = inside ? aim : aim - (back * std::max(1.0, 2 * solid.ball)) * n;
    using L = long double;
    const SolidOracle oracle(solid, convert<L>(from), convert<L>(n));
    const bool starts_in = solid.closed() && oracle.distance(convert<L>(from)) < 0;
    if (starts_in != inside) continue;
    const RestPlacing<Minkowski> placing{
        {}, {{0, 0, 0, 0}}, true, {Vec3<double>{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}, 1.001 * solid.ball};
    const RestBody body{placing.axes};
    const Vec4<double> start = {{0, from[0], from[1], from[2]}};
    const auto ray = placing.ray(placing.launch(start), Vec4<double>{{-1, n[0], n[1], n[2]}});
    compare(oracle, ray, body, shape, 4e-15 * norm(from), 4e-14 * (1 + norm(from)) + 1e-13 * scale, tally);
  }
  return tally;
}

auto only(PrimitiveType type) {
  return [type](Random& random, double scale) { return RandomSolid(random).primitive(type, scale); };
}

TEST(Solid, BodiesAreMetByRaysFromEverywhere) {
  for (const auto type : {PrimitiveType::ellipsoid, PrimitiveType::cylinder, PrimitiveType::box,
                          PrimitiveType::tube, PrimitiveType::disk}) {
    SCOPED_TRACE(static_cast<int>(type));
    rays_towards(static_cast<unsigned>(type) + 1, false, 1e-9, only(type)).expect_clean();
  }
}

TEST(Solid, BodiesAreLeftByRaysFromInside) {
  for (const auto type : {PrimitiveType::ellipsoid, PrimitiveType::cylinder, PrimitiveType::box}) {
    SCOPED_TRACE(static_cast<int>(type));
    rays_towards(static_cast<unsigned>(type) + 11, true, 1e-9, only(type)).expect_clean();
  }
}

TEST(Solid, JoinedBodiesFromOutsideAndInside) {
  const auto joined = [](Random& random, double scale) { return RandomSolid(random).joined(scale); };
  rays_towards(21, false, 1e-9, joined).expect_clean();
  rays_towards(22, true, 1e-9, joined).expect_clean();
}

}  // namespace
}  // namespace nullcone::test
