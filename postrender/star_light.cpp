#include "postrender/star_light.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "postrender/black_body.h"
#include "postrender/illumination.h"

namespace nullcone::postrender {

namespace {

/// Along one axis: how much of a spot falls on each of the pixels that it may reach, 1 together.
struct Spread {
  static constexpr double kReach = 4;  ///< standard deviations
  static constexpr int kMost = 2 * 4 * 4 + 3;
  int first = 0, count = 0;
  std::array<float, kMost> part{};

  Spread(double at, double sigma) {
    first = static_cast<int>(std::floor(at - kReach * sigma));
    count = static_cast<int>(std::floor(at + kReach * sigma)) + 1 - first;
    const double scale = 1 / (sigma * std::numbers::sqrt2);
    std::array<double, kMost + 1> below{};
    for (int i = 0; i <= count; ++i) below[static_cast<std::size_t>(i)] = std::erf((first + i - at) * scale);
    const double all = below[static_cast<std::size_t>(count)] - below[0];
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
      part[i] = static_cast<float>((below[i + 1] - below[i]) / all);
  }
};

/// The radiance of each image times the pixels over which it is to be spread.
std::vector<Rgbx> colors_of(const Kernel& kernel, const StarShading& stars, const StarImages& images,
                            std::span<const float> visible) {
  const std::size_t count = images.images.size();
  std::vector<Rgbx> out(count);
  constexpr std::size_t kBlock = kSegment;
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, (count + kBlock - 1) / kBlock, 16), [&](const auto& range) {
        std::array<float, kBlock> g, weight;
        std::array<Rgbx, kBlock> white;
        white.fill(Rgbx{1, 1, 1});
        for (std::size_t block = range.begin(); block < range.end(); ++block) {
          const std::size_t first = block * kBlock, here = std::min(kBlock, count - first);
          for (std::size_t i = 0; i < here; ++i) {
            const StarImage& image = images.images[first + i];
            const Star& star = stars.field->stars()[image.star];
            const auto shift = static_cast<double>(image.shift), T = static_cast<double>(star.temperature_K);
            float seen = 0;
            for (std::size_t k = 0; k < 3; ++k) seen += image.weights[k] * visible[image.corners[k]];
            const double mu = static_cast<double>(image.magnification);
            const double capped = mu > stars.style.most_magnified ? stars.style.most_magnified / mu : 1;
            // A disc as bright as a black body, as large as makes this illuminance: by radiance times solid
            // angle.
            const double solid_angle = static_cast<double>(star.illuminance_lx) / black_body_xyz(T)[1];
            const bool sensible = shift > 0 && std::isfinite(shift);
            const double beamed = !sensible ? 0 : stars.power == 0 ? 1 : std::pow(shift, stars.power);
            g[i] = static_cast<float>((stars.doppler && sensible ? shift : 1) * T / kReferenceStar_K);
            weight[i] = static_cast<float>(std::min(1e30, stars.intensity * capped * beamed * solid_angle *
                                                              static_cast<double>(image.area) *
                                                              static_cast<double>(seen)));
          }
          add_light(kernel, stars.light, {here, g.data(), weight.data(), white.data(), out.data() + first});
        }
      });
  return out;
}

/// Lines [from, to) of the picture.
void add_spots(const StarShading& stars, const StarImages& images, const std::vector<Rgbx>& colors, int from,
               int to, int width, std::vector<Rgbx>& physical) {
  const double sigma = stars.style.size_px;
  const auto reach = static_cast<float>(Spread::kReach * sigma + 1);
  // Rows of triangles that come near: their borders increase.
  const auto begin = images.row_y.begin();
  const auto low = std::upper_bound(begin, images.row_y.end(), static_cast<float>(from) - reach);
  const auto high = std::lower_bound(begin, images.row_y.end(), static_cast<float>(to) + reach);
  const std::size_t rows = images.row_first.size() - 1;
  const auto row_of = [&](auto place, std::ptrdiff_t more) {
    return static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(place - begin + more, 0, static_cast<std::ptrdiff_t>(rows)));
  };
  for (std::size_t i = images.row_first[row_of(low, -1)]; i < images.row_first[row_of(high, 0)]; ++i) {
    const StarImage& image = images.images[i];
    const Rgbx& color = colors[i];
    if (color.r == 0 && color.g == 0 && color.b == 0) continue;
    const auto y = static_cast<double>(image.y);
    if (y + Spread::kReach * sigma < from || y - Spread::kReach * sigma > to) continue;
    const Spread across(static_cast<double>(image.x), sigma), down(y, sigma);
    for (int j = std::max(down.first, from); j < std::min(down.first + down.count, to); ++j) {
      Rgbx* line = physical.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(width);
      const float here = down.part[static_cast<std::size_t>(j - down.first)];
      for (int k = 0; k < across.count; ++k) {
        int column = across.first + k;
        if (images.wraps) column = (column % width + width) % width;
        if (column < image.left || column >= image.right) continue;
        const float part = here * across.part[static_cast<std::size_t>(k)];
        Rgbx& sum = line[column];
        sum = {sum.r + part * color.r, sum.g + part * color.g, sum.b + part * color.b};
      }
    }
  }
}

}  // namespace

std::shared_ptr<const StarField> StarCache::field(const StarsLook& look) {
  const std::lock_guard lock(mutex_);
  const std::string key = key_of(look);
  if (const auto found = fields_.find(key); found != fields_.end()) return found->second;
  return fields_[key] = std::make_shared<const StarField>(make_stars(look));
}

std::shared_ptr<const StarImages> StarCache::images(const std::shared_ptr<const StarField>& field,
                                                    std::uint32_t id, const Dataset& samples,
                                                    const Manifest& picture) {
  const std::lock_guard lock(mutex_);
  const std::pair key(field, id);
  if (const auto found = images_.find(key); found != images_.end()) return found->second;
  // Isolated: who waits in here must not take up work that waits for this lock.
  return images_[key] = tbb::this_task_arena::isolate([&] {
           return std::make_shared<const StarImages>(find_star_images(samples, picture, id, *field));
         });
}

void StarCache::prune() {
  const std::lock_guard lock(mutex_);
  for (auto entry = fields_.begin(); entry != fields_.end();) {
    const auto mine = [&](const auto& found) { return found.first.first == entry->second; };
    const auto holders = 1 + std::ranges::count_if(images_, mine);
    const bool unused = entry->second.use_count() == holders;
    if (unused) std::erase_if(images_, mine);
    entry = unused ? fields_.erase(entry) : std::next(entry);
  }
}

void add_stars(const Kernel& kernel, const StarShading& stars, const StarImages& images,
               std::span<const float> visible, int width, std::vector<Rgbx>& physical) {
  if (images.images.empty()) return;
  const std::vector<Rgbx> colors = colors_of(kernel, stars, images, visible);
  constexpr int kLines = 32;
  const int lines = static_cast<int>(physical.size() / static_cast<std::size_t>(width));
  tbb::parallel_for(tbb::blocked_range<int>(0, (lines + kLines - 1) / kLines, 1), [&](const auto& range) {
    for (int band = range.begin(); band < range.end(); ++band)
      add_spots(stars, images, colors, band * kLines, std::min(lines, (band + 1) * kLines), width, physical);
  });
}

}  // namespace nullcone::postrender
