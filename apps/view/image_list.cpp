#include "apps/view/image_list.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

#include "apps/view/named_object.h"
#include "apps/view/regions.h"

namespace nullcone::view {

namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::size_t kMostImages = 200;
constexpr std::uint32_t kLeftOut = 0xffffffffU;

/// Whether the right edge of the picture is the left one.
bool closes_on_itself(const Manifest& manifest) {
  const json setting = json::parse(manifest.setting, nullptr, false);
  const json::json_pointer type("/camera/type"), fov("/camera/fov_rad/0");
  return setting.is_object() && setting.contains(type) &&
         (setting[type] == "panorama" || setting[type] == "tetrahedron_map") && setting.contains(fov) &&
         setting[fov].is_number() && setting[fov].get<double>() > 2 * std::numbers::pi * (1 - 1e-12);
}

/// How many pictures stand side by side.
int cells_of(const Manifest& manifest) {
  const json setting = json::parse(manifest.setting, nullptr, false);
  const json::json_pointer type("/camera/type");
  return setting.is_object() && setting.contains(type) && setting[type] == "cube_map" ? 6 : 1;
}

/// Finite values of a channel.
struct Values {
  double least = std::numeric_limits<double>::infinity(), greatest = -least, sum = 0;
  std::size_t count = 0;

  void add(std::span<const float> column) {
    Values here = *this;  // in registers
    for (const float value : column) {
      if (!std::isfinite(value)) continue;
      const auto x = static_cast<double>(value);
      here.least = std::min(here.least, x), here.greatest = std::max(here.greatest, x);
      here.sum += x, ++here.count;
    }
    *this = here;
  }
  double mean() const { return sum / static_cast<double>(count); }
  ordered_json spread(double origin) const { return {least + origin, mean() + origin, greatest + origin}; }
};

struct Seen {
  std::uint32_t order = 0;
  std::size_t pixels = 0, start = 0;  ///< `start`: the column at its left end
  std::size_t left = 0, right = 0, top = 0, bottom = 0;
  double x = 0, y = 0;  ///< sums
  Values t, tau, shift, Z;

  /// The pixels [first, end) of a row.
  void add_pixels(std::size_t first, std::size_t end, std::size_t row, std::size_t width) {
    if (first < start && start < end) {
      add_pixels(start, end, row, width);
      end = start;
    }
    if (first < start) first += width, end += width;
    if (pixels == 0) left = first, right = end - 1, top = row;
    left = std::min(left, first), right = std::max(right, end - 1), bottom = row;
    const auto count = static_cast<double>(end - first);
    x += 0.5 * count * static_cast<double>(first + end - 1), y += count * static_cast<double>(row);
    pixels += end - first;
  }
  void add_crossings(const Hits& hits, std::size_t first, std::size_t end) {
    const auto add = [&](Values& to, const std::vector<float>& column) {
      if (!column.empty()) to.add(std::span(column).subspan(first, end - first));
    };
    add(t, hits.t), add(tau, hits.tau), add(shift, hits.shift);
    if (hits.t.empty()) add(Z, hits.Z);
  }
  /// Small for what comes first: light of earlier times, or without times what is farther away.
  double place(bool timed) const {
    if (timed) return t.count > 0 ? t.mean() : std::numeric_limits<double>::infinity();
    return Z.count > 0 ? -Z.mean() : 0;
  }
};

/// The largest regions, each by its place among them; kLeftOut for the others.
std::vector<std::uint32_t> choose(const Regions& regions) {
  std::vector<std::uint32_t> size(regions.count()), by_size(regions.count()), out(regions.count(), kLeftOut);
  for (const std::uint32_t region : regions.region) ++size[region];
  std::iota(by_size.begin(), by_size.end(), 0U);
  const std::size_t kept = std::min(kMostImages, by_size.size());
  std::partial_sort(
      by_size.begin(), by_size.begin() + static_cast<std::ptrdiff_t>(kept), by_size.end(),
      [&](std::uint32_t a, std::uint32_t b) { return size[a] != size[b] ? size[a] > size[b] : a < b; });
  for (std::uint32_t i = 0; i < kept; ++i) out[by_size[i]] = i;
  return out;
}

/// Of regions across both edges the column behind the widest gap, from which on they are whole.
void find_starts(const Regions& regions, const std::vector<std::uint32_t>& chosen, std::size_t width,
                 std::vector<Seen>& images) {
  std::vector<std::vector<bool>> columns(images.size());
  for (std::size_t pixel = 0; pixel + 1 < regions.first.size(); ++pixel)
    for (std::uint32_t i = regions.first[pixel]; i < regions.first[pixel + 1]; ++i) {
      const std::uint32_t region = regions.region[i];
      if (chosen[region] == kLeftOut || regions.over_edges[region] == 0) continue;
      std::vector<bool>& seen = columns[chosen[region]];
      seen.resize(width);
      seen[pixel % width] = true;
    }
  for (std::size_t i = 0; i < images.size(); ++i)
    for (std::size_t x = 0, gap = 0, widest = 0; x < columns[i].size(); ++x) {
      gap = columns[i][x] ? 0 : gap + 1;
      if (gap > widest) widest = gap, images[i].start = x + 1;
    }
}

/// Neighbours that belong to one image are handed over together, which is faster: f(image, first, end).
template <class F>
class Runs {
 public:
  explicit Runs(F f) : f_(std::move(f)) {}
  void add(std::uint32_t image, std::size_t place) {
    if (image != image_ || place != end_) {
      finish();
      image_ = image, first_ = place;
    }
    end_ = place + 1;
  }
  void finish() {
    if (image_ != kLeftOut) f_(image_, first_, end_);
    image_ = kLeftOut;
  }

 private:
  F f_;
  std::uint32_t image_ = kLeftOut;
  std::size_t first_ = 0, end_ = 0;
};

void add_pixels(const Regions& regions, const std::vector<std::uint32_t>& chosen, std::size_t width,
                std::vector<Seen>& images) {
  for (std::size_t row = 0; row * width + 1 < regions.first.size(); ++row) {
    Runs runs([&](std::uint32_t image, std::size_t first, std::size_t end) {
      images[image].add_pixels(first, end, row, width);
    });
    for (std::size_t x = 0; x < width; ++x)
      for (std::uint32_t i = regions.first[row * width + x]; i < regions.first[row * width + x + 1]; ++i)
        runs.add(chosen[regions.region[i]], x);
    runs.finish();
  }
}

void add_crossings(const Hits& hits, std::uint32_t id, const Regions& regions,
                   const std::vector<std::uint32_t>& chosen, std::vector<Seen>& images) {
  Runs runs([&](std::uint32_t image, std::size_t first, std::size_t end) {
    images[image].add_crossings(hits, first, end);
  });
  for (std::size_t pixel = 0; pixel + 1 < regions.first.size(); ++pixel) {
    if (regions.first[pixel] == regions.first[pixel + 1]) continue;
    for (std::size_t hit = hits.offset[pixel]; hit < hits.offset[pixel + 1]; ++hit)
      if (hits.id[hit] == id)
        runs.add(chosen[regions.at(pixel, hits.order.empty() ? 0 : hits.order[hit])], hit);
  }
  runs.finish();
}

std::vector<Seen> gather(const Dataset& dataset, std::uint32_t id, const Regions& regions,
                         const std::vector<std::uint32_t>& chosen) {
  std::vector<Seen> out(std::min(kMostImages, regions.count()));
  const auto width = static_cast<std::size_t>(dataset.manifest.width);
  for (std::size_t i = 0; i < regions.region.size(); ++i)
    if (const std::uint32_t image = chosen[regions.region[i]]; image != kLeftOut)
      out[image].order = regions.order[i];
  if (std::ranges::count(regions.over_edges, 1) > 0) find_starts(regions, chosen, width, out);
  add_pixels(regions, chosen, width, out);
  add_crossings(dataset.hits, id, regions, chosen, out);
  return out;
}

ordered_json told(const Seen& image, std::size_t number, const Manifest& manifest, bool ordered,
                  double tau_origin) {
  const auto count = static_cast<double>(image.pixels), first_line = static_cast<double>(manifest.first_line);
  const auto above = static_cast<std::size_t>(manifest.first_line);
  ordered_json out = {{"number", number}};
  if (ordered) out["order"] = image.order;
  out["pixels"] = image.pixels;
  out["centre"] = {std::fmod(image.x / count, manifest.width), image.y / count + first_line};
  out["box"] = {image.left, image.top + above, image.right, image.bottom + above};
  if (image.t.count > 0) out["t"] = image.t.spread(0);
  if (image.tau.count > 0) out["tau"] = image.tau.spread(tau_origin);
  if (image.shift.count > 0) out["shift"] = image.shift.spread(0);
  return out;
}

}  // namespace

ordered_json images_of(const Dataset& dataset, const std::string& object) {
  const Manifest& manifest = dataset.manifest;
  const std::uint32_t id = number_of_object(manifest, object);
  const Regions regions = find_regions(dataset, id, closes_on_itself(manifest), cells_of(manifest));
  std::vector<Seen> images = gather(dataset, id, regions, choose(regions));
  const bool timed = dataset.hits.channels.has("t");
  std::ranges::stable_sort(images, {}, [&](const Seen& image) { return image.place(timed); });
  ordered_json list = ordered_json::array();
  for (const Seen& image : images)
    list.push_back(told(image, list.size() + 1, manifest, dataset.hits.channels.has("order"),
                        manifest.objects[id - 1].tau_origin));
  return {{"images", list}, {"omitted", regions.count() - images.size()}};
}

}  // namespace nullcone::view
