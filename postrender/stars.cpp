#include "postrender/stars.h"

#include <algorithm>

namespace nullcone::postrender {

double illuminance_lx(double magnitude) { return kMagnitude0_lx * std::pow(10, -0.4 * magnitude); }

Direction direction_of(double right_ascension_deg, double declination_deg) {
  const double a = right_ascension_deg * std::numbers::pi / 180, d = declination_deg * std::numbers::pi / 180;
  return {std::cos(d) * std::cos(a), std::cos(d) * std::sin(a), std::sin(d)};
}

/// Its box, and those of its halves, whose stars change places.
void StarField::divide(const Node& node) {
  Box& box = boxes_[node.number];
  const auto from = stars_.begin() + node.first, to = stars_.begin() + node.last;
  box = {from->direction, from->direction};
  for (auto star = from; star != to; ++star)
    for (std::size_t i = 0; i < 3; ++i) {
      box.low[i] = std::min(box.low[i], star->direction[i]);
      box.high[i] = std::max(box.high[i], star->direction[i]);
    }
  if (node.is_leaf()) return;
  std::size_t longest = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (box.high[i] - box.low[i] > box.high[longest] - box.low[longest]) longest = i;
  std::nth_element(from, stars_.begin() + node.middle(), to,
                   [&](const Star& a, const Star& b) { return a.direction[longest] < b.direction[longest]; });
  divide(node.lower());
  divide(node.upper());
}

StarField::StarField(std::vector<Star> stars) : stars_(std::move(stars)) {
  if (stars_.empty()) return;
  std::size_t boxes = 1;
  for (std::size_t most = stars_.size(); most > kLeaf; most -= most / 2) boxes = 2 * boxes + 1;
  boxes_.resize(boxes);
  divide({0, 0, static_cast<std::uint32_t>(stars_.size())});
  const auto [coldest, hottest] = std::ranges::minmax(stars_, {}, &Star::temperature_K);
  temperatures_ = {coldest.temperature_K, hottest.temperature_K};
}

}  // namespace nullcone::postrender
