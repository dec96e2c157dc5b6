// A ray against a box in flat space, by the slab method in long double: knows nothing of the search.
#pragma once

#include <cmath>

#include "core/base/boost.h"
#include "core/trace/closed_onward.h"
#include "tests/by_ray.h"

namespace nullcone::test {
namespace {

/// Where a straight ray X + lambda k, lambda > 0, is inside a box with half edges `half`.
struct BoxOracle {
  using L = long double;
  host::Vec3<L> X, k;
  host::Vec3<double> half;
  L enter = -HUGE_VALL, leave = HUGE_VALL;
  std::size_t axis_in = 0, axis_out = 0;  ///< of the faces through which it comes and goes
  L margin_in = 0, margin_out = 0;        ///< in lambda, to the next face's plane: 0 at an edge

  BoxOracle(const host::Vec3<L>& from, const host::Vec3<L>& along, const host::Vec3<double>& edges)
      : X(from), k(along), half(0.5 * edges) {
    for (std::size_t i = 0; i < 3; ++i) {
      const L speed = std::fabs(k[i]), x = k[i] < 0 ? -X[i] : X[i];
      const L in = speed > 0 ? (-half[i] - x) / speed : std::fabs(x) <= half[i] ? -HUGE_VALL : HUGE_VALL;
      const L out = speed > 0 ? (half[i] - x) / speed : HUGE_VALL;
      margin_in = in > enter ? in - enter : std::min(margin_in, enter - in);
      margin_out = out < leave ? leave - out : std::min(margin_out, out - leave);
      if (in > enter) enter = in, axis_in = i;
      if (out < leave) leave = out, axis_out = i;
    }
  }
  bool meets() const { return enter > 0 && enter < leave; }
  bool starts_outside() const { return outside_by(0) > 0; }
  /// How far a point of the ray is from the box; negative inside, where it is the distance to the next face.
  double outside_by(L lambda) const {
    L beyond = 0, deepest = -HUGE_VALL;
    for (std::size_t i = 0; i < 3; ++i) {
      const L out = std::fabs(X[i] + lambda * k[i]) - half[i];
      deepest = std::max(deepest, out);
      if (out > 0) beyond += out * out;
    }
    return static_cast<double>(beyond > 0 ? std::sqrt(beyond) : deepest);
  }
  /// How deep the chord lies at its middle: what rounding must not swallow.
  double depth() const { return -outside_by(0.5L * (enter + leave)); }
};

/// Edges of all kinds: cubes, rods, and slivers down to a part of 1e-9 of the largest edge.
template <class Random>
host::Vec3<double> random_edges(Random& random, double largest) {
  host::Vec3<double> out = {{largest, largest, largest}};
  const auto thin = static_cast<int>(random.uniform(0, 4));  // how many edges are short
  for (int n = 0; n < thin; ++n) {
    const double part = random.uniform(0, 1) < 0.5 ? random.uniform(0.1, 1) : random.logarithmic(1e-9, 1);
    out[static_cast<std::size_t>(random.uniform(0, 3))] *= part;
  }
  return out;
}

/// All crossings of one ray with a box, as closed_onward.h finds them.
template <class Ray>
std::vector<double> all_crossings(const Ray& ray, const host::Box& box, double limit, double resolution,
                                  bool& given_up) {
  std::vector<double> out;
  double lambda = 0;
  for (bool inside = false; out.size() < 10; inside = !inside) {
    host::Search<double> search(limit);
    search.lambda = lambda;
    host::advance(ray, host::Onward<double, host::Box>{box, inside}, limit, resolution, host::kSearchLimit,
                  search);
    given_up |= search.given_up;
    if (!search.met) break;
    out.push_back(search.lambda);
    lambda = host::past_crossing(ray, box, search, resolution);
  }
  return out;
}

/// The shape's JSON.
inline std::string box(const host::Vec3<double>& edges) {
  return R"({"type": "box", "edges": )" + text_of(edges) + "}";
}

}  // namespace
}  // namespace nullcone::test
