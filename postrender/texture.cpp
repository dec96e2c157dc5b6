#include "postrender/texture.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace nullcone::postrender {

namespace {

/// Area averages of `from` items to `to` items, along one axis.
struct Shrink {
  int from, to;
  template <class Read, class Write>
  void operator()(Read&& read, Write&& write) const {
    const double ratio = static_cast<double>(from) / to;
    for (int i = 0; i < to; ++i) {
      const double first = i * ratio, last = std::min((i + 1) * ratio, static_cast<double>(from));
      decltype(read(0)) sum{};
      for (int k = static_cast<int>(first); k < from && k < last; ++k) {
        const double weight = std::min(last, k + 1.0) - std::max(first, static_cast<double>(k));
        sum = sum + static_cast<float>(weight / ratio) * read(k);
      }
      write(i, sum);
    }
  }
};

/// One kind of values of a level (colours or alpha), half as wide and half as high.
template <class T>
std::vector<T> halved(const std::vector<T>& full, int width, int height) {
  const int narrow = std::max(1, width / 2), low = std::max(1, height / 2);
  const auto at = [](int i, int j, int w) {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(w) + static_cast<std::size_t>(i);
  };
  std::vector<T> columns(at(0, height, narrow)), out(at(0, low, narrow));
  for (int j = 0; j < height; ++j)
    Shrink{width, narrow}([&](int i) { return full[at(i, j, width)]; },
                          [&](int i, T x) { columns[at(i, j, narrow)] = x; });
  for (int i = 0; i < narrow; ++i)
    Shrink{height, low}([&](int j) { return columns[at(i, j, narrow)]; },
                        [&](int j, T x) { out[at(i, j, narrow)] = x; });
  return out;
}

TextureLevel halved(const TextureLevel& full) {
  TextureLevel half{std::max(1, full.width / 2), std::max(1, full.height / 2), {}};
  half.texels = halved(full.texels, full.width, full.height);
  if (!full.alpha.empty()) half.alpha = halved(full.alpha, full.width, full.height);
  return half;
}

/// The nearest half float; too small is 0, too large the largest, and what is not a number 0.
std::int16_t half_float(float x) {
  constexpr float kSmallest = 6.103515625e-5f, kLargest = 65504;
  if (!(std::abs(x) >= kSmallest)) return 0;
  auto bits = std::bit_cast<std::uint32_t>(std::min(std::abs(x), kLargest));
  bits += 0xfffU + ((bits >> 13) & 1U);  // to nearest, ties to even
  const std::uint32_t half = (bits >> 13) - (112U << 10);
  return static_cast<std::int16_t>(x < 0 ? half | 0x8000U : half);
}

std::int32_t texels_a_row_of_tiles(const TextureLevel& level) {
  return (level.width + kTile - 1) / kTile * kTileTexels;
}

Texel half_floats(Rgb c, float alpha) {
  return {half_float(c.r), half_float(c.g), half_float(c.b), half_float(alpha)};
}

/// What sticks out over the image by more than a texel is never read.
void append_tiles(const TextureLevel& level, int exponent,
                  std::vector<Texel, HugePageAllocator<Texel>>& texels) {
  const float scale = std::ldexp(1.0f, exponent);
  for (int top = 0; top < level.height; top += kTile)
    for (int left = 0; left < level.width; left += kTile)
      for (int j = top; j < top + kTileRow; ++j)
        for (int i = left; i < left + kTileRow; ++i) {
          const std::size_t at = level.place(i % level.width, std::min(j, level.height - 1));
          texels.push_back(
              half_floats(scale * level.texels[at], level.alpha.empty() ? 0.0f : scale * level.alpha[at]));
        }
}

}  // namespace

Rgb Pyramid::texel(std::size_t level, int i, int j) const {
  const LevelView& at = levels[level];
  const std::int32_t place =
      at.first + i / kTile * kTileTexels + i % kTile + j / kTile * at.row_of_tiles + j % kTile * kTileRow;
  const Texel& found = texels[static_cast<std::size_t>(place)];
  const auto decoded = [&](std::int16_t half) {
    const auto bits = (static_cast<std::uint32_t>(static_cast<std::int32_t>(half)) << 13) & 0x8fffe000U;
    return unit * (std::bit_cast<float>(bits) * 0x1p112f);
  };
  return {decoded(found[0]), decoded(found[1]), decoded(found[2])};
}

std::vector<TextureLevel> halvings(TextureLevel full) {
  std::vector<TextureLevel> out;
  out.push_back(std::move(full));
  while (out.back().width > 1 || out.back().height > 1) out.push_back(halved(out.back()));
  return out;
}

int normalising_exponent(std::span<const TextureLevel> pictures) {
  float largest = 0;
  for (const TextureLevel& picture : pictures) {
    if (!picture.alpha.empty()) largest = std::max(largest, 1.0f);
    for (const Rgb c : picture.texels)
      for (const float component : {c.r, c.g, c.b})
        if (std::isfinite(component)) largest = std::max(largest, std::abs(component));
  }
  int exponent = 0;
  std::frexp(largest, &exponent);
  return std::clamp(15 - exponent, -14, 60);
}

Pyramid tiled(std::span<const TextureLevel> levels, int exponent) {
  Pyramid out;
  out.unit = std::ldexp(1.0f, -exponent);
  for (const TextureLevel& level : levels) {
    out.levels.push_back({level.width, level.height, texels_a_row_of_tiles(level),
                          static_cast<std::int32_t>(out.texels.size())});
    append_tiles(level, exponent, out.texels);
  }
  return out;
}

Pyramid make_pyramid(TextureLevel full) {
  const int exponent = normalising_exponent({&full, 1});
  return tiled(halvings(std::move(full)), exponent);
}

}  // namespace nullcone::postrender
