#include "apps/view/image_list.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
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
  return setting.is_object() && setting.contains(type) && setting[type] == "panorama" &&
         setting.contains(fov) && setting[fov].is_number() &&
         setting[fov].get<double>() > 2 * std::numbers::pi * (1 - 1e-12);
}

/// Finite values of a channel.
struct Values {
  double least = std::numeric_limits<double>::infinity(), greatest = -least, sum = 0;
  std::size_t count = 0;

  void add(double x) {
    if (!std::isfinite(x)) return;
    least = std::min(least, x), greatest = std::max(greatest, x);
    sum += x, ++count;
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

  void add_pixel(std::size_t column, std::size_t row, std::size_t width) {
    if (column < start) column += width;
    if (pixels++ == 0) left = right = column, top = bottom = row;
    left = std::min(left, column), right = std::max(right, column);
    bottom = row;
    x += static_cast<double>(column), y += static_cast<double>(row);
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

/// Adds the crossings with the object in one pixel.
void add_crossings(const Hits& hits, std::uint32_t id, std::size_t pixel, const Regions& regions,
                   const std::vector<std::uint32_t>& chosen, std::vector<Seen>& images) {
  const auto add = [](Values& to, const std::vector<float>& column, std::size_t hit) {
    if (!column.empty()) to.add(static_cast<double>(column[hit]));
  };
  for (std::size_t hit = hits.offset[pixel]; hit < hits.offset[pixel + 1]; ++hit) {
    if (hits.id[hit] != id) continue;
    const std::uint32_t image = chosen[regions.at(pixel, hits.order.empty() ? 0 : hits.order[hit])];
    if (image == kLeftOut) continue;
    add(images[image].t, hits.t, hit);
    add(images[image].tau, hits.tau, hit);
    add(images[image].shift, hits.shift, hit);
    add(images[image].Z, hits.Z, hit);
  }
}

std::vector<Seen> gather(const Dataset& dataset, std::uint32_t id, const Regions& regions,
                         const std::vector<std::uint32_t>& chosen) {
  std::vector<Seen> out(std::min(kMostImages, regions.count()));
  const auto width = static_cast<std::size_t>(dataset.manifest.width);
  if (std::ranges::count(regions.over_edges, 1) > 0) find_starts(regions, chosen, width, out);
  for (std::size_t pixel = 0; pixel < dataset.pixels(); ++pixel) {
    for (std::uint32_t i = regions.first[pixel]; i < regions.first[pixel + 1]; ++i)
      if (const std::uint32_t image = chosen[regions.region[i]]; image != kLeftOut) {
        out[image].order = regions.order[i];
        out[image].add_pixel(pixel % width, pixel / width, width);
      }
    if (regions.first[pixel] < regions.first[pixel + 1])
      add_crossings(dataset.hits, id, pixel, regions, chosen, out);
  }
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
  const Regions regions = find_regions(dataset, id, closes_on_itself(manifest));
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
