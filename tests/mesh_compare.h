// What the search finds along a ray, against all triangles one by one.
#pragma once

#include <gtest/gtest.h>

#include "core/trace/closed_onward.h"
#include "tests/mesh_oracle.h"

namespace nullcone::test {
namespace {

using namespace nullcone::host;

struct Tally {
  int rays = 0, hits = 0, missed = 0, invented = 0, misplaced = 0, given_up = 0, turned = 0, doubled = 0;
  double worst = 0;  ///< over the rounding that is allowed
  double steps = 0;

  void expect_clean(int least_hits) const {
    EXPECT_EQ(missed, 0);
    EXPECT_EQ(invented, 0);
    EXPECT_EQ(misplaced, 0);
    EXPECT_EQ(given_up, 0);
    EXPECT_EQ(turned, 0);
    EXPECT_EQ(doubled, 0);
    EXPECT_LT(worst, 0.5);
    EXPECT_GT(hits, least_hits);
  }
};

/// All crossings of a ray, as closed_onward.h finds them.
template <class Ray>
std::vector<double> all_crossings(const Ray& ray, const AnyShape& shape, double limit, double resolution,
                                  Tally& tally) {
  std::vector<double> out;
  double lambda = 0;
  for (int i = 0; i < 2000; ++i) {
    Search<double> search(limit);
    search.lambda = lambda;
    advance(ray, Onward<double, AnyShape>{shape, false}, limit, resolution, kSearchLimit, search);
    tally.given_up += search.given_up;
    tally.steps += search.steps;
    if (!search.met) return out;
    out.push_back(search.lambda);
    lambda = past_crossing(ray, shape, search, resolution);
  }
  ++tally.given_up;
  return out;
}

/// A mesh, and how its surface counts: `rounding` is a length, what may be called either way.
struct Subject {
  const TriangleSoup& soup;
  const AnyShape& shape;
  double rounding;
  bool closed;
};

/// What a ray has to meet: where all triangles about the place are crossed in the same direction, and the
/// place is within one of them, or the mesh has no edges. Returns the least of their steepnesses there, else
/// 0.
L clear_steepness(const std::vector<TrueCrossing>& all, const TrueCrossing& c, const Subject& subject) {
  const L steep = std::fabs(c.steepness), clear = 30 * subject.rounding;
  L least = steep;
  bool within = false;
  for (const TrueCrossing& other : all) {
    const L apart = std::fabs(other.t - c.t) * std::max(steep, std::fabs(other.steepness));
    if (apart > clear) continue;
    if (other.triangle != c.triangle && !subject.closed) return 0;
    if ((other.steepness > 0) != (c.steepness > 0)) return 0;
    if (std::fabs(other.steepness) < 1e-4L * other.speed) return 0;
    least = std::min(least, std::fabs(other.steepness));
    within |= other.inside > clear;
  }
  return subject.closed || within ? least : 0;
}

template <class Ray, class Curve>
void compare(const Subject& subject, const Curve& curve, const Ray& ray, double limit, double resolution,
             Tally& tally) {
  ++tally.rays;
  const std::vector<double> found = all_crossings(ray, subject.shape, limit, resolution, tally);
  const auto all = true_crossings(subject.soup, curve, limit, 3 * L(subject.rounding));
  std::size_t clear = 0;
  double first = kFar;
  for (const TrueCrossing& c : all) {
    const L steepness = clear_steepness(all, c, subject);
    if (steepness == 0 || c.t > 0.999L * limit || c.inside < -0.01L * subject.rounding) continue;
    ++clear;
    first = std::min(first, static_cast<double>(c.t));
    const L apart = 25 * subject.rounding / (c.inside > 25 * subject.rounding ? steepness : c.speed);
    const bool alone = std::ranges::none_of(all, [&](const TrueCrossing& other) {
      return std::fabs(other.t - c.t) < 2 * apart && (other.steepness > 0) != (c.steepness > 0);
    });
    double off = 1e300, at = 0;
    int times = 0;
    for (const double lambda : found) {
      const auto d = static_cast<double>(std::fabs((lambda - c.t) * steepness));
      times += std::fabs(lambda - c.t) < apart;
      if (d < off) off = d, at = lambda;
    }
    tally.doubled += alone && times > 1;
    tally.missed += off > 1e3 * subject.rounding;
    tally.misplaced += off > subject.rounding;
    tally.worst = std::max(tally.worst, off / subject.rounding);
    if (c.inside < 30 * subject.rounding) continue;
    const Vec3<double> X =
        Vec3<double>::map([&](std::size_t i) { return static_cast<double>(curve.at(at)[i]); });
    const auto facet = subject.shape.facet(X);
    tally.turned +=
        !(dot(facet.normal(X),
              Vec3<double>::map([&](std::size_t i) { return static_cast<double>(c.normal[i]); })) > 0.99) ||
        !(std::fabs(facet.value(X)) < subject.rounding);
  }
  tally.hits += clear > 0;
  for (const double lambda : found)
    tally.invented += std::ranges::none_of(all, [&](const TrueCrossing& c) {
      return std::fabs((lambda - c.t) * c.steepness) < 2 * subject.rounding ||
             std::fabs(lambda - c.t) < 2 * subject.rounding;
    });
  const Search<double> search = first_crossing(ray, subject.shape, limit, resolution);
  tally.missed += first < kFar && !(search.met && search.lambda < first + 1e-6);
}

}  // namespace
}  // namespace nullcone::test
