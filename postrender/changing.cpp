#include "postrender/changing.h"

#include <algorithm>
#include <cmath>

namespace nullcone::postrender {

Timeline::Place Timeline::between_nodes(double time) const {
  if (!(time > nodes.front())) return {0, 0, 0};
  const auto next = static_cast<std::size_t>(std::ranges::upper_bound(nodes, time) - nodes.begin());
  if (next == nodes.size()) return {next - 1, next - 1, 0};
  const std::size_t i = next - 1;
  // Halves, because the difference of two finite times may not be finite.
  const double width = nodes[next] / 2 - nodes[i] / 2;
  return {i, next, width > 0 ? static_cast<float>((time / 2 - nodes[i] / 2) / width) : 0.0f};
}

Timeline::Place Timeline::at(const Times& times) const {
  const double time = clock == Clock::frame ? frame : times.at(clock);
  if (!nodes.empty()) return between_nodes(time);
  const auto pictures = static_cast<double>(count);
  double position = (time - from) * rate;
  if (loop) {
    position = std::fmod(position, pictures);
    if (position < 0) position += pictures;
  }
  if (!(position > 0)) return {0, 0, 0};
  // A small negative remainder plus the period may round to the period itself.
  if (position >= pictures) position = loop ? 0 : pictures - 1;
  const auto first = static_cast<std::size_t>(position);
  const std::size_t next = first + 1 < count ? first + 1 : loop ? 0 : first;
  const auto share = blend && next != first ? static_cast<float>(position - std::floor(position)) : 0.0f;
  return {first, share > 0 ? next : first, share};
}

}  // namespace nullcone::postrender
