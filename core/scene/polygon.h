// Polygons cut into triangles.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace nullcone {

/// Cuts a polygon into triangles of its corners' places in the list, by cutting off ears; `corners` are in
/// the order in which they go round. What has no ear left (it crosses itself) is cut from its first corner.
class PolygonCutter {
 public:
  using Point = std::array<double, 3>;

  /// cut(a, b, c) for each triangle.
  template <class F>
  void operator()(std::span<const Point> corners, F&& cut) {
    left_.resize(corners.size());
    for (std::uint32_t i = 0; i < corners.size(); ++i) left_[i] = i;
    if (corners.size() > 3) lay_flat(corners);
    while (left_.size() > 3) {
      std::size_t ear = 0;
      while (ear < left_.size() && !is_ear(ear)) ++ear;
      if (ear == left_.size()) ear = 1;
      const std::size_t n = left_.size();
      cut(left_[(ear + n - 1) % n], left_[ear], left_[(ear + 1) % n]);
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    if (left_.size() == 3) cut(left_[0], left_[1], left_[2]);
  }

 private:
  using Flat = std::array<double, 2>;

  /// Along the axis that is nearest to the normal (Newell's), so that the polygon goes round to the left.
  void lay_flat(std::span<const Point> corners) {
    Point normal{};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Point &a = corners[i], &b = corners[(i + 1) % corners.size()];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t y = (k + 1) % 3, z = (k + 2) % 3;
        normal[k] += (a[y] - b[y]) * (a[z] + b[z]);
      }
    }
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if (std::fabs(normal[k]) > std::fabs(normal[axis])) axis = k;
    const double side = normal[axis] < 0 ? -1 : 1;
    flat_.resize(corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i)
      flat_[i] = {corners[i][(axis + 1) % 3], side * corners[i][(axis + 2) % 3]};
  }
  static double area(const Flat& a, const Flat& b, const Flat& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  }
  bool is_ear(std::size_t i) const {
    const std::size_t n = left_.size();
    const Flat &a = flat_[left_[(i + n - 1) % n]], &b = flat_[left_[i]], &c = flat_[left_[(i + 1) % n]];
    if (!(area(a, b, c) > 0)) return false;
    for (std::size_t k = 2; k + 1 < n; ++k) {
      const Flat& p = flat_[left_[(i + k) % n]];
      if (area(a, b, p) > 0 && area(b, c, p) > 0 && area(c, a, p) > 0) return false;
    }
    return true;
  }

  std::vector<std::uint32_t> left_;
  std::vector<Flat> flat_;
};

}  // namespace nullcone
