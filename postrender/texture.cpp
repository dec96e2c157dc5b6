#include "postrender/texture.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace nullcone::postrender {

namespace {

constexpr std::int32_t kTile = 4;

/// Area averages of `count` items (a `stride` apart) to `fewer` items, along one axis.
struct Shrink {
  int from, to;
  template <class Read, class Write>
  void operator()(Read&& read, Write&& write) const {
    const double ratio = static_cast<double>(from) / to;
    for (int i = 0; i < to; ++i) {
      const double first = i * ratio, last = std::min((i + 1) * ratio, static_cast<double>(from));
      Rgb sum;
      for (int k = static_cast<int>(first); k < from && k < last; ++k) {
        const double weight = std::min(last, k + 1.0) - std::max(first, static_cast<double>(k));
        sum = sum + static_cast<float>(weight / ratio) * read(k);
      }
      write(i, sum);
    }
  }
};

TextureLevel halved(const TextureLevel& full) {
  const auto at = [](int i, int j, int width) {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i);
  };
  TextureLevel narrow{std::max(1, full.width / 2), full.height, {}};
  narrow.texels.resize(at(0, narrow.height, narrow.width));
  for (int j = 0; j < full.height; ++j)
    Shrink{full.width, narrow.width}([&](int i) { return full.texel(i, j); },
                                     [&](int i, Rgb c) { narrow.texels[at(i, j, narrow.width)] = c; });
  TextureLevel half{narrow.width, std::max(1, full.height / 2), {}};
  half.texels.resize(at(0, half.height, half.width));
  for (int i = 0; i < half.width; ++i)
    Shrink{full.height, half.height}([&](int j) { return narrow.texel(i, j); },
                                     [&](int j, Rgb c) { half.texels[at(i, j, half.width)] = c; });
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

/// Binary exponent that brings the largest component to [2^14, 2^15), the top of half floats.
int normalising_exponent(const TextureLevel& full) {
  float largest = 0;
  for (const Rgb c : full.texels)
    for (const float component : {c.r, c.g, c.b})
      if (std::isfinite(component)) largest = std::max(largest, std::abs(component));
  int exponent = 0;
  std::frexp(largest, &exponent);
  return std::clamp(15 - exponent, -14, 60);
}

/// Texels in rows of tiles; what sticks out over the image is never read.
std::int32_t texels_a_tile_row(const TextureLevel& level) {
  return (level.width + kTile - 1) / kTile * kTile * kTile;
}

void append_tiles(const TextureLevel& level, int exponent, std::vector<Texel>& texels) {
  const std::size_t first = texels.size();
  const std::int32_t pitch = texels_a_tile_row(level);
  texels.resize(first + static_cast<std::size_t>(pitch) *
                            static_cast<std::size_t>((level.height + kTile - 1) / kTile));
  const float scale = std::ldexp(1.0f, exponent);
  for (int j = 0; j < level.height; ++j) {
    Texel* row =
        texels.data() + first + static_cast<std::size_t>(j / kTile) * static_cast<std::size_t>(pitch);
    for (int i = 0; i < level.width; ++i) {
      const Rgb c = scale * level.texel(i, j);
      row[i / kTile * kTile * kTile + j % kTile * kTile + i % kTile] = {half_float(c.r), half_float(c.g),
                                                                        half_float(c.b), 0};
    }
  }
}

}  // namespace

Rgb Pyramid::texel(std::size_t level, int i, int j) const {
  const LevelView& at = levels[level];
  const Texel& found = texels[static_cast<std::size_t>(at.first + i / kTile * kTile * kTile + i % kTile +
                                                       j / kTile * at.row_of_tiles + j % kTile * kTile)];
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

Pyramid make_pyramid(TextureLevel full) {
  const int exponent = normalising_exponent(full);
  Pyramid out;
  out.unit = std::ldexp(1.0f, -exponent);
  const std::vector<TextureLevel> levels = halvings(std::move(full));
  for (const TextureLevel& level : levels) {
    out.levels.push_back(
        {level.width, level.height, texels_a_tile_row(level), static_cast<std::int32_t>(out.texels.size())});
    append_tiles(level, exponent, out.texels);
  }
  return out;
}

}  // namespace nullcone::postrender
