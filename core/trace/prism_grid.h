// The swept light cone of a lamp near some targets: prisms between slices of common affine length, and which
// of them cover a point.
#pragma once

#include <limits>

#include "core/trace/critical_curve.h"
#include "core/trace/crossings.h"

NULLCONE_KERNEL_BEGIN

/// A ball of chart coordinates.
struct Ball {
  Vec3<double> centre;
  double radius;
};

struct Box3 {
  Vec3<double> low{{1e300, 1e300, 1e300}}, high{{-1e300, -1e300, -1e300}};

  void add(const Vec3<double>& x) {
    for (std::size_t i = 0; i < 3; ++i) low[i] = min(low[i], x[i]), high[i] = max(high[i], x[i]);
  }
  void widen(double part) {
    const Vec3<double> by = part * (high - low);
    low = low - by, high = high + by;
  }
  bool touches(const Box3& other) const {
    bool out = true;
    for (std::size_t i = 0; i < 3; ++i) out = out && low[i] <= other.high[i] && other.low[i] <= high[i];
    return out;
  }
  static Box3 around(const Ball& ball) {
    const Vec3<double> r{{ball.radius, ball.radius, ball.radius}};
    return {ball.centre - r, ball.centre + r};
  }
};

/// A point of the light cone: spatial coordinates, the ray's place in the mesh, how far it has come,
/// and the angle that it has swept about the origin.
struct ScanNode {
  Vec3<double> x, place;
  double lambda, turning;
};

/// What a triangle of rays sweeps in one slice: corners 0 to 2 at its beginning, 3 to 5 at its end, each in
/// the order of the rays' numbers: so neighbours split their common face along the same diagonal.
struct ScanPrism {
  std::array<std::uint32_t, 6> node;
  bool odd;         ///< that order turns the triangle round
  bool unresolved;  ///< the rays differ too much to tell what lies between them
};
inline constexpr std::array<std::array<std::size_t, 4>, 3> kTetrahedra = {
    {{0, 1, 2, 5}, {0, 1, 5, 4}, {0, 3, 4, 5}}};

/// How far outside a tetrahedron, in barycentric coordinates, it still answers.
inline constexpr double kInflation = 0.25;

/// Barycentric coordinates of x; NaN or infinite where the tetrahedron has no volume.
struct Barycentric {
  std::array<double, 4> weight;
  double volume;  ///< signed
  double least() const { return min(min(weight[0], weight[1]), min(weight[2], weight[3])); }

  Barycentric(const std::array<const ScanNode*, 4>& corner, const Vec3<double>& x) {
    const Vec3<double> a = corner[1]->x - corner[0]->x, b = corner[2]->x - corner[0]->x,
                       c = corner[3]->x - corner[0]->x, d = x - corner[0]->x;
    const Vec3<double> bc = cross(b, c);
    volume = dot(a, bc);
    const double over = 1 / volume;
    weight[1] = over * dot(d, bc), weight[2] = over * dot(a, cross(d, c)),
    weight[3] = over * dot(a, cross(b, d));
    weight[0] = 1 - weight[1] - weight[2] - weight[3];
  }
};

/// The prisms that touch a target's box, by the cells of a uniform grid.
class TargetGrid {
 public:
  TargetGrid() = default;
  /// Of the prisms whose boxes are given, `numbers` touch this target.
  TargetGrid(const Box3& box, const Pool<Box3>& boxes, const Pool<std::uint32_t>& numbers) : box_(box) {
    while (cells_ < 32 && cells_ * cells_ * cells_ * 4 < numbers.size()) ++cells_;
    const std::size_t count = cells_ * cells_ * cells_;
    start_.reset(new std::uint32_t[count + 1]());
    const auto for_each = [&](auto&& f) {
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        std::array<std::size_t, 3> low{}, high{};
        for (std::size_t c = 0; c < 3; ++c)
          low[c] = cell(boxes[numbers[i]].low[c], c), high[c] = cell(boxes[numbers[i]].high[c], c);
        for (std::size_t x = low[0]; x <= high[0]; ++x)
          for (std::size_t y = low[1]; y <= high[1]; ++y)
            for (std::size_t z = low[2]; z <= high[2]; ++z) f((x * cells_ + y) * cells_ + z, numbers[i]);
      }
    };
    for_each([&](std::size_t at, std::uint32_t) { ++start_[at + 1]; });
    for (std::size_t i = 0; i < count; ++i) start_[i + 1] += start_[i];
    items_.reset(new std::uint32_t[start_[count]]);
    const std::unique_ptr<std::uint32_t[]> next(new std::uint32_t[count]);
    for (std::size_t i = 0; i < count; ++i) next[i] = start_[i];
    for_each([&](std::size_t at, std::uint32_t number) { items_[next[at]++] = number; });
  }

  bool holds(const Vec3<double>& x) const { return box_.touches({x, x}); }
  /// f(number of a prism) for all that may cover x.
  template <class F>
  void for_each_at(const Vec3<double>& x, F&& f) const {
    const std::size_t at = (cell(x[0], 0) * cells_ + cell(x[1], 1)) * cells_ + cell(x[2], 2);
    for (std::uint32_t i = start_[at]; i < start_[at + 1]; ++i) f(items_[i]);
  }

 private:
  std::size_t cell(double x, std::size_t c) const {
    const double part = (x - box_.low[c]) / max(box_.high[c] - box_.low[c], 1e-300);
    const double last = static_cast<double>(cells_ - 1);
    return static_cast<std::size_t>(max(0.0, min(last, part * static_cast<double>(cells_))));
  }
  Box3 box_;
  std::size_t cells_ = 1;
  std::unique_ptr<std::uint32_t[]> start_, items_;
};

/// The prisms of a whole scan, and the grids of its targets.
struct LightCone {
  Pool<ScanNode> nodes{1024};
  Pool<ScanPrism> prisms{1024};
  std::size_t targets = 0;
  std::unique_ptr<TargetGrid[]> grids;
  std::size_t unresolved = 0;  ///< prisms
  bool complete = true;        ///< false: the sweep was given up
  CriticalCurve curve;

  Box3 box_of(const ScanPrism& prism) const {
    Box3 out;
    for (const std::uint32_t n : prism.node) out.add(nodes[n].x);
    out.widen(kInflation);
    return out;
  }
  void make_grids(const Ball* balls, std::size_t count) {
    targets = count;
    grids.reset(new TargetGrid[count]);
    Pool<Box3> boxes(prisms.size());
    for (std::size_t i = 0; i < prisms.size(); ++i) boxes.push(box_of(prisms[i]));
    for (std::size_t k = 0; k < count; ++k) {
      const Box3 box = Box3::around(balls[k]);
      Pool<std::uint32_t> numbers(1024);
      for (std::uint32_t i = 0; i < prisms.size(); ++i)
        if (boxes[i].touches(box)) numbers.push(i);
      grids[k] = TargetGrid(box, boxes, numbers);
    }
  }
};

NULLCONE_KERNEL_END
