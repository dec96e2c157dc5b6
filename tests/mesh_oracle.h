// Curves against all triangles one by one, in long double: roots in closed form. Knows nothing of trees.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/vector.h"
#include "core/scene/mesh_tree.h"

namespace nullcone::test {
namespace {

using L = long double;
using Point = host::Vec3<L>;

/// X + t W + t^2 A / 2.
struct Parabola {
  Point X, W, A;

  Point at(L t) const { return X + t * (W + (t / 2) * A); }
  Point slope(L t) const { return W + t * A; }
  /// Where n.at(t) = d, for t within 0 and `end`.
  std::vector<L> roots(const Point& n, L d, L end) const {
    const L c = host::dot(n, X) - d, b = host::dot(n, W), a = host::dot(n, A) / 2;
    std::vector<L> out;
    if (a == 0) {
      if (b != 0) out = {-c / b};
    } else if (const L room = b * b - 4 * a * c; room >= 0) {
      const L q = -(b + std::copysign(std::sqrt(room), b)) / 2;
      out = {q / a, c / q};
    }
    std::erase_if(out, [&](L t) { return !(t > 0 && t < end); });
    return out;
  }
};

/// C + cos(t) U + sin(t) V.
struct Circle {
  Point C, U, V;

  Point at(L t) const { return C + std::cos(t) * U + std::sin(t) * V; }
  Point slope(L t) const { return std::cos(t) * V - std::sin(t) * U; }
  std::vector<L> roots(const Point& n, L d, L end) const {
    const L u = host::dot(n, U), v = host::dot(n, V), r = std::hypot(u, v), c = (d - host::dot(n, C)) / r;
    std::vector<L> out;
    if (!(std::fabs(c) < 1)) return out;
    const L turn = 2 * std::numbers::pi_v<L>, phase = std::atan2(v, u), half = std::acos(c);
    for (const L first : {phase - half, phase + half})
      for (L t = first - turn; t < end; t += turn)
        if (t > 0) out.push_back(t);
    return out;
  }
};

/// A crossing with a triangle.
struct TrueCrossing {
  L t, speed;   ///< |slope|
  L steepness;  ///< how fast the curve comes through the plane
  L inside;     ///< how far from the nearest edge; negative outside of the triangle
  std::size_t triangle;
  Point normal;
};

template <class Curve>
std::vector<TrueCrossing> true_crossings(const TriangleSoup& soup, const Curve& curve, L end, L margin) {
  std::vector<TrueCrossing> out;
  for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
    Point p[3];
    for (std::size_t k = 0; k < 3; ++k) p[k] = host::convert<L>(soup.positions[soup.triangles[i][k]]);
    const Point n = host::normalised(host::cross(p[1] - p[0], p[2] - p[0]));
    for (const L t : curve.roots(n, host::dot(n, p[0]), end)) {
      const Point at = curve.at(t);
      L inside = 1e30L;
      for (std::size_t k = 0; k < 3; ++k) {
        const Point edge = p[(k + 1) % 3] - p[k];
        inside = std::min(inside, host::dot(host::cross(n, edge), at - p[k]) / host::norm(edge));
      }
      if (inside > -margin)
        out.push_back({t, host::norm(curve.slope(t)), host::dot(n, curve.slope(t)), inside, i, n});
    }
  }
  std::ranges::sort(out, {}, &TrueCrossing::t);
  return out;
}

}  // namespace
}  // namespace nullcone::test
