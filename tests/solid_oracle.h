// Straight rays against solids in long double: all roots of all surfaces, and between them a point's
// membership by inequalities. Knows nothing of the search.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/base/vector.h"
#include "core/scene/solid.h"
#include "tests/random_rays.h"

namespace nullcone::test {
namespace {

/// Random solids about the origin, of an extent of about 1, times `scale`.
class RandomSolid {
 public:
  explicit RandomSolid(Random& random) : random_(random) {}

  Solid primitive(PrimitiveType type, double scale) {
    Solid out;
    out.primitives = {make(type, scale)};
    out.primitives[0].centre = {0, 0, 0};
    out.steps = {{Join::take, 0, false}};
    out.ball = reach(out.primitives[0]);
    return out;
  }
  Solid joined(double scale) {
    Solid out;
    const auto count = static_cast<std::uint32_t>(random_.uniform(2, 6));
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto type = static_cast<PrimitiveType>(static_cast<int>(random_.uniform(0, 3)));
      const auto join = static_cast<Join>(static_cast<int>(random_.uniform(1, 4)));
      out.primitives.push_back(make(type, scale));
      out.steps.push_back({Join::take, i, i > 0 && join == Join::subtract});
      if (i > 0) out.steps.push_back({join, 0, false});
      out.ball = std::max(out.ball, reach(out.primitives.back()));
    }
    return out;
  }

 private:
  Primitive make(PrimitiveType type, double scale) {
    Primitive out;
    out.type = type;
    const auto z = random_.direction(), x = host::normalised(host::cross(random_.direction(), z));
    out.axes = {x.c, host::cross(z, x).c, z.c};
    for (double& half : out.half) half = scale * random_.logarithmic(0.02, 1);
    if (type != PrimitiveType::ellipsoid && type != PrimitiveType::box) out.half[1] = out.half[0];
    if (type == PrimitiveType::disk) {
      out.half[2] = 1;
      out.hole = std::max(0.0, random_.uniform(-0.5, 0.99));
    }
    for (double& c : out.centre) c = scale * random_.uniform(-0.5, 0.5);
    return out;
  }
  static double reach(const Primitive& p) {
    const double flat = p.type == PrimitiveType::disk ? 0 : p.half[2];
    return std::hypot(p.centre[0], p.centre[1], p.centre[2]) + std::hypot(p.half[0], p.half[1], flat);
  }
  Random& random_;
};

class SolidOracle {
 public:
  using L = long double;
  using Point = host::Vec3<L>;

  SolidOracle(const Solid& solid, const Point& X, const Point& k) : solid_(solid), X_(X), k_(k) {
    for (const Primitive& p : solid.primitives) add_roots(p);
    std::ranges::sort(roots_);
  }
  const std::vector<L>& roots() const { return roots_; }
  Point at(L lambda) const { return X_ + lambda * k_; }

  /// Distance from the surface to first order, negative inside; of what has no inside its magnitude.
  L distance(const Point& X) const {
    std::vector<L> stack;
    for (const SolidStep& step : solid_.steps) {
      if (step.join == Join::take) {
        stack.push_back(distance(solid_.primitives[step.primitive], X));
        continue;
      }
      const L b = stack.back();
      stack.pop_back();
      L& a = stack.back();
      a = step.join == Join::unite       ? std::min(a, b)
          : step.join == Join::intersect ? std::max(a, b)
                                         : std::max(a, -b);
    }
    return stack.front();
  }
  /// Crossings with lambda > 0 on either side of which the ray gets farther from the surface than `clear`.
  std::vector<L> clear_crossings(L clear) const {
    std::vector<L> out;
    for (std::size_t i = 0; i < roots_.size(); ++i) {
      if (roots_[i] <= 0) continue;
      const L before = i > 0 ? std::max(roots_[i - 1], L(0)) : L(0),
              after = i + 1 < roots_.size() ? roots_[i + 1] : roots_[i] + 1;
      const L a = distance(at((before + roots_[i]) / 2)), b = distance(at((after + roots_[i]) / 2));
      if (std::min(std::fabs(a), std::fabs(b)) < clear) continue;
      if (solid_.closed() ? (a < 0) != (b < 0) : rim(solid_.primitives[0], at(roots_[i])) < -clear)
        out.push_back(roots_[i]);
    }
    return out;
  }

 private:
  static Point local(const Primitive& p, const Point& X) {
    const Point from = X - host::convert<L>(p.centre);
    return Point::map([&](std::size_t i) { return host::dot(host::convert<L>(p.axes[i]), from); });
  }
  /// How far a point of the surface of a tube or disk is from its rim; negative where there is a surface.
  static L rim(const Primitive& p, const Point& X) {
    const Point Y = local(p, X);
    if (p.type == PrimitiveType::tube) return std::fabs(Y[2]) - p.half[2];
    const L rho = std::hypot(Y[0], Y[1]);
    return std::max(rho - p.half[0], p.hole * p.half[0] - rho);
  }
  static L distance(const Primitive& p, const Point& X) {
    const Point Y = local(p, X);
    const L rho = std::hypot(Y[0], Y[1]);
    const auto slab = [&](std::size_t i) { return std::fabs(Y[i]) - p.half[i]; };
    switch (p.type) {
      case PrimitiveType::box:
        return std::max({slab(0), slab(1), slab(2)});
      case PrimitiveType::cylinder:
        return std::max(rho - p.half[0], slab(2));
      case PrimitiveType::tube:
        return std::hypot(rho - p.half[0], std::max(slab(2), L(0)));
      case PrimitiveType::disk:
        return std::hypot(std::max({rho - p.half[0], p.hole * p.half[0] - rho, L(0)}), Y[2]);
      default: {
        L F = -1, slope = 0;
        for (std::size_t i = 0; i < 3; ++i)
          F += Y[i] * Y[i] / (L(p.half[i]) * p.half[i]),
              slope += std::pow(Y[i] / (L(p.half[i]) * p.half[i]), 2);
        return F / std::max(2 * std::sqrt(slope), L(1e-100));
      }
    }
  }
  /// Roots of sum over the axes of (Y/half)^2 = 1, from the point that is nearest to the centre: from afar
  /// the discriminant would lose all digits.
  void add_quadric(const Point& Y, const Point& W, const host::Vec3<L>& half, std::size_t axes) {
    L a = 0, b = 0, c = -1;
    for (std::size_t i = 0; i < axes; ++i)
      a += W[i] * W[i] / half[i] / half[i], b += W[i] * Y[i] / half[i] / half[i];
    if (a == 0) return;
    const L nearest = -b / a;
    b = 0;
    for (std::size_t i = 0; i < axes; ++i) {
      const L w = W[i] / half[i], y = Y[i] / half[i] + nearest * w;
      b += w * y, c += y * y;
    }
    const L discriminant = b * b - a * c;
    if (discriminant < 0) return;
    roots_.push_back(nearest + (-b - std::sqrt(discriminant)) / a);
    roots_.push_back(nearest + (-b + std::sqrt(discriminant)) / a);
  }
  void add_plane(L Y, L W) {
    if (W != 0) roots_.push_back(-Y / W);
  }
  void add_roots(const Primitive& p) {
    const Point Y = local(p, X_);
    const Point along = Point::map([&](std::size_t i) { return host::dot(host::convert<L>(p.axes[i]), k_); });
    const host::Vec3<L> half = host::convert<L>(p.half);
    if (p.type == PrimitiveType::ellipsoid) add_quadric(Y, along, half, 3);
    if (p.type == PrimitiveType::cylinder || p.type == PrimitiveType::tube) add_quadric(Y, along, half, 2);
    for (std::size_t i = p.type == PrimitiveType::box ? 0 : 2; i < 3; ++i) {
      if (p.type == PrimitiveType::ellipsoid || p.type == PrimitiveType::tube) break;
      if (p.type == PrimitiveType::disk) {
        add_plane(Y[2], along[2]);
        continue;
      }
      add_plane(Y[i] - half[i], along[i]);
      add_plane(Y[i] + half[i], along[i]);
    }
  }

  const Solid& solid_;
  Point X_, k_;
  std::vector<L> roots_;
};

}  // namespace
}  // namespace nullcone::test
