#include "apps/view/regions.h"

#include <algorithm>

namespace nullcone::view {

namespace {

constexpr std::uint32_t kNone = 0xffffffffU;

/// Sets that grow together; each is named by its first member.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    for (std::uint32_t i = 0; i < count; ++i) parent_[i] = i;
  }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    (a < b ? parent_[b] : parent_[a]) = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// The one of a pixel with this order, or kNone.
std::uint32_t find_at(const Regions& all, std::size_t pixel, std::uint32_t wanted) {
  const std::uint32_t begin = all.first[pixel], end = all.first[pixel + 1];
  if (begin == end) return kNone;
  if (end - begin == 1) return all.order[begin] == wanted ? begin : kNone;
  const auto from = all.order.begin() + begin, to = all.order.begin() + end;
  const auto found = std::lower_bound(from, to, wanted);
  return found != to && *found == wanted ? begin + static_cast<std::uint32_t>(found - from) : kNone;
}

/// Every pixel's orders.
Regions gather(const Dataset& dataset, std::uint32_t id) {
  Regions out;
  const Hits& hits = dataset.hits;
  const bool ordered = hits.channels.has("order");
  const auto order_of = [&](std::size_t hit) { return ordered ? hits.order[hit] : 0; };
  out.first.reserve(dataset.pixels() + 1);
  out.order.reserve(hits.count());
  out.first.push_back(0);
  for (std::size_t pixel = 0; pixel < dataset.pixels(); ++pixel) {
    const auto begin = out.order.size();
    for (std::size_t hit = hits.offset[pixel]; hit < hits.offset[pixel + 1]; ++hit)
      if (hits.id[hit] == id) out.order.push_back(order_of(hit));
    if (out.order.size() > begin + 1) {
      const auto from = out.order.begin() + static_cast<std::ptrdiff_t>(begin);
      std::sort(from, out.order.end());
      out.order.erase(std::unique(from, out.order.end()), out.order.end());
    }
    out.first.push_back(static_cast<std::uint32_t>(out.order.size()));
  }
  return out;
}

/// Joins what stands at `pixel` with its neighbours to the left and above. Those neighbours that touch one
/// another are joined already: the one above with all others, the left one with that above it. `cell`:
/// the width of what is connected.
void join_before(const Regions& all, std::size_t width, std::size_t cell, std::size_t pixel, Sets& sets) {
  const std::size_t x = pixel % width % cell;
  const bool top = pixel < width, left = x == 0, right = x + 1 == cell;
  for (std::uint32_t i = all.first[pixel]; i < all.first[pixel + 1]; ++i) {
    const auto join = [&](bool outside, std::size_t back) {
      const std::uint32_t other = outside ? kNone : find_at(all, pixel - back, all.order[i]);
      if (other != kNone) sets.join(i, other);
      return other != kNone;
    };
    if (join(top, width)) continue;
    if (!join(left, 1)) join(top || left, width + 1);
    join(top || right, width - 1);
  }
}

/// Joins left and right edge; gives members that are connected that way.
std::vector<std::uint32_t> join_edges(const Regions& all, std::size_t width, Sets& sets) {
  std::vector<std::uint32_t> out;
  const std::size_t lines = (all.first.size() - 1) / width;
  for (std::size_t y = 0; y < lines; ++y)
    for (std::uint32_t i = all.first[y * width]; i < all.first[y * width + 1]; ++i)
      for (std::size_t row = y == 0 ? 0 : y - 1; row < std::min(y + 2, lines); ++row) {
        const std::uint32_t other = find_at(all, row * width + width - 1, all.order[i]);
        if (other == kNone) continue;
        sets.join(i, other);
        out.push_back(i);
      }
  return out;
}

}  // namespace

std::uint32_t Regions::at(std::size_t pixel, std::uint32_t wanted) const {
  return region[find_at(*this, pixel, wanted)];
}

Regions find_regions(const Dataset& dataset, std::uint32_t id, bool closed, int cells) {
  Regions out = gather(dataset, id);
  const auto width = static_cast<std::size_t>(dataset.manifest.width);
  // Step 1: neighbours.
  Sets sets(out.order.size());
  const std::size_t cell = std::max<std::size_t>(width / static_cast<std::size_t>(cells), 1);
  for (std::size_t pixel = 0; pixel < dataset.pixels(); ++pixel) join_before(out, width, cell, pixel, sets);
  std::vector<std::uint32_t> across;
  if (closed) across = join_edges(out, width, sets);
  // Step 2: numbers. The first member of a set comes before all others.
  out.region.resize(out.order.size());
  for (std::uint32_t i = 0; i < out.region.size(); ++i) {
    const std::uint32_t set = sets.find(i);
    out.region[i] = set == i ? static_cast<std::uint32_t>(out.over_edges.size()) : out.region[set];
    if (set == i) out.over_edges.push_back(0);
  }
  for (const std::uint32_t i : across) out.over_edges[out.region[i]] = 1;
  return out;
}

}  // namespace nullcone::view
