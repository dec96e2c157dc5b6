#include "postrender/shift_ranges.h"

#include <algorithm>
#include <limits>

namespace nullcone::postrender {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr ShiftRange kNone = {kInfinity, 0};

void include(ShiftRange& range, float g) {
  range.from = std::min(range.from, g);
  range.to = std::max(range.to, g);
}

ShiftRange found(ShiftRange range) { return range.from <= range.to ? range : ShiftRange{}; }

}  // namespace

std::vector<ShiftRange> shift_ranges(const Dataset& dataset) {
  const Hits& hits = dataset.hits;
  std::vector<ShiftRange> out(dataset.manifest.objects.size(), kNone);
  for (std::size_t i = 0; i < hits.shift.size(); ++i)
    if (is_ratio(hits.shift[i])) include(out[hits.id[i] - 1], hits.shift[i]);
  std::ranges::transform(out, out.begin(), found);
  return out;
}

std::vector<std::vector<LightShifts>> light_shift_ranges(const Dataset& dataset) {
  const Hits& hits = dataset.hits;
  std::vector<std::vector<LightShifts>> out(
      dataset.manifest.objects.size(),
      std::vector<LightShifts>(dataset.manifest.lights.size(), {kNone, kNone}));
  for (std::size_t path = 0; path < hits.light.size(); ++path) {
    const LightPath& light = hits.light[path];
    const std::size_t lamp = path / static_cast<std::size_t>(dataset.manifest.light_paths);
    for (std::size_t i = 0; i < hits.count(); ++i) {
      const float g = hits.shift.empty() ? 1.0f : hits.shift[i], product = g * light.shift[i];
      if (!(light.E[i] > 0 && is_ratio(light.shift[i]) && g > 0 && is_ratio(product))) continue;
      LightShifts& range = out[hits.id[i] - 1][lamp];
      include(range.light, light.shift[i]);
      include(range.product, product);
    }
  }
  for (std::vector<LightShifts>& lamps : out)
    for (LightShifts& range : lamps) range = {found(range.light), found(range.product)};
  return out;
}

}  // namespace nullcone::postrender
