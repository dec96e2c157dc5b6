// A triangle between neighbouring rays, in the picture and on the sky.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "postrender/sky_mesh.h"
#include "postrender/star_images.h"

namespace nullcone::postrender {

inline double dot(const Direction& a, const Direction& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
/// Exactly -cross(b, a).
inline Direction cross(const Direction& a, const Direction& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double square_distance(const Direction& a, const Direction& b) {
  const Direction d = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return dot(d, d);
}

/// A corner of a triangle, in pixels of the picture; and where it stands in the mesh.
struct Corner {
  const SkyVertex* vertex;
  double x, y;
  std::size_t row, column;
};

/// A triangle of neighbouring rays; corners in the order of the mesh. `clockwise` in that order.
class Triangle {
 public:
  Triangle(const Corner& a, const Corner& b, const Corner& c, bool clockwise)
      : corners_{a, b, c}, clockwise_(clockwise) {
    if (!a.vertex->on_sky || !b.vertex->on_sky || !c.vertex->on_sky) return;
    const double ab = square_distance(direction(0), direction(1)),
                 bc = square_distance(direction(1), direction(2)),
                 ac = square_distance(direction(0), direction(2));
    square_side_ = std::max({ab, bc, ac});
    seen_ = square_side_ <= kLargestStep * kLargestStep;
  }
  /// Whether it shows a piece of the sky.
  bool seen() const { return seen_; }
  /// The square of the longest side, a chord.
  double square_side() const { return square_side_; }
  const Corner& corner(std::size_t i) const { return corners_[i]; }

  /// To be called before those that follow.
  void prepare() {
    if (!seen_) return;
    edges_ = {cross(direction(0), direction(1)), cross(direction(1), direction(2)),
              cross(direction(0), direction(2))};
    volume_ = dot(direction(2), edges_[0]);
    seen_ = volume_ != 0;
  }
  /// Van Oosterom and Strackee 1983, "The solid angle of a plane triangle", eq. 8.
  double solid_angle() const {
    const Direction &A = direction(0), &B = direction(1), &C = direction(2);
    return 2 * std::atan2(std::abs(volume_), 1 + dot(A, B) + dot(B, C) + dot(A, C));
  }
  /// Whether it goes round on the sky as in the picture: 1, else -1.
  int sense() const { return clockwise_ == (volume_ > 0) ? 1 : -1; }
  /// In pixels.
  double area() const {
    const auto& [a, b, c] = corners_;
    return 0.5 * std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
  }

  /// Whether the star is inside, and the weights of the corners. What lies on an edge belongs to one of its
  /// two triangles, what lies on a corner to one of its six: the one that goes along the edge as the mesh
  /// does.
  bool holds(const Direction& star, std::array<double, 3>& weights) const {
    const double ab = dot(edges_[0], star), bc = dot(edges_[1], star), ac = dot(edges_[2], star);
    const bool inside = clockwise_ ? within(ab, true) && within(bc, true) && within(-ac, false)
                                   : within(ac, true) && within(-bc, false) && within(-ab, false);
    if (!inside) return false;
    const double sum = std::abs(ab) + std::abs(bc) + std::abs(ac);
    if (!(sum > 0)) return false;
    weights = {std::abs(bc) / sum, std::abs(ac) / sum, std::abs(ab) / sum};
    return true;
  }

 private:
  const Direction& direction(std::size_t i) const { return corners_[i].vertex->direction; }
  /// Of a side that is gone along clockwise in the picture; of mirrored images that is the other way round.
  bool within(double side, bool along) const {
    if (side == 0) return along;
    return (side > 0) == (clockwise_ != (volume_ < 0));
  }

  std::array<Corner, 3> corners_;
  std::array<Direction, 3> edges_{};  ///< each from the corner that stands first in the mesh
  double volume_ = 0, square_side_ = 0;
  bool clockwise_, seen_ = false;
};

}  // namespace nullcone::postrender
