// Stars of a sky: points with a brightness and a temperature, and a grid on the sphere in which they are
// found.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

namespace nullcone::postrender {

using Direction = std::array<double, 3>;  ///< of length 1

struct Star {
  std::array<float, 3> direction;  ///< in which it is seen: of length 1, in the sky's static frame
  float illuminance_lx;            ///< there, without lens and motion
  float temperature_K;
};

/// What a star of apparent visual magnitude 0 brings outside of the atmosphere, in lx (C. W. Allen,
/// Astrophysical Quantities, 1973, section 13).
inline constexpr double kMagnitude0_lx = 2.54e-6;
double illuminance_lx(double magnitude);

/// The direction of a right ascension and declination: +x at (0, 0), +y at (90, 0), +z at the pole.
Direction direction_of(double right_ascension_deg, double declination_deg);

/// A box with edges along the axes, ends included.
struct Box {
  std::array<float, 3> low, high;
  bool meets(const Box& other) const {
    for (std::size_t i = 0; i < 3; ++i)
      if (!(low[i] <= other.high[i] && other.low[i] <= high[i])) return false;
    return true;
  }
};

/// Stars in a tree of boxes, halved along their longest edge down to a few stars: also where they crowd.
class StarField {
 public:
  explicit StarField(std::vector<Star> stars);

  /// Those of a box stand side by side.
  std::span<const Star> stars() const { return stars_; }
  /// From..to in kelvin; (1, 1) where there are none.
  std::array<float, 2> temperatures() const { return temperatures_; }

  /// Calls f(first, last) for numbers of stars, among which are all in the box.
  template <class F>
  void within(const Box& box, F&& f) const {
    if (!stars_.empty()) visit({0, 0, static_cast<std::uint32_t>(stars_.size())}, box, f);
  }

 private:
  static constexpr std::uint32_t kLeaf = 8;  ///< stars that are not divided any more, at most
  /// Boxes are numbered from the root, 0; the halves of box n are 2 n + 1 and 2 n + 2.
  struct Node {
    std::size_t number;
    std::uint32_t first, last;  ///< stars
    bool is_leaf() const { return last - first <= kLeaf; }
    std::uint32_t middle() const { return first + (last - first) / 2; }
    Node lower() const { return {2 * number + 1, first, middle()}; }
    Node upper() const { return {2 * number + 2, middle(), last}; }
  };
  template <class F>
  void visit(const Node& node, const Box& box, F& f) const {
    if (!boxes_[node.number].meets(box)) return;
    if (node.is_leaf()) return f(node.first, node.last);
    visit(node.lower(), box, f);
    visit(node.upper(), box, f);
  }
  void divide(const Node& node);

  std::vector<Star> stars_;
  std::vector<Box> boxes_;
  std::array<float, 2> temperatures_ = {1, 1};
};

}  // namespace nullcone::postrender
