// Textures along a run of pixels.
#pragma once

#include "postrender/kernel.h"
#include "postrender/lanes.h"
#include "postrender/two_colors.h"

NULLCONE_KERNEL_BEGIN

constexpr std::size_t kBlock = 64;  ///< pixels whose look-ups are prepared together

/// Look-ups of a block: u from 0 to 1, v downwards, and the level.
struct LookUps {
  float x[kBlock], y[kBlock], level[kBlock];
};

inline void place(const postrender::ImageView& image, const postrender::Run& run, std::size_t first,
                  std::size_t count, LookUps& out) {
  const float u_scale = image.uv.scale[0], u_offset = image.uv.offset[0];
  const float v_scale = image.uv.scale[1], v_offset = image.uv.offset[1];
  const float *u = run.u + first, *v = run.v + first;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = finite_or_zero(u[i] * u_scale + u_offset);
    out.x[i] = x - floor_of(x);
    out.y[i] = 1 - finite_or_zero(v[i] * v_scale + v_offset);
  }
}

/// Half the logarithm to base 2 of x >= 1, within 7e-5: exact at powers of two, where the polynomial's ends
/// meet.
inline float half_log2(float x) {
  const auto bits = bits_as<std::int32_t>(x);
  const float t = bits_as<float>((bits & 0x7fffff) | 0x3f800000) - 1;
  const float bend = t * (1 - t) * (0.43837933f + t * (-0.23750133f + t * 0.08065315f));
  return 0.5f * (static_cast<float>((bits >> 23) - 127) + t + bend);
}

/// The level whose texels are as far apart as the longer side of the footprint.
inline void find_levels(const postrender::ImageView& image, const postrender::Run& run, std::size_t first,
                        std::size_t count, LookUps& out) {
  if (!image.mipmap) {
    for (std::size_t i = 0; i < count; ++i) out.level[i] = 0;
    return;
  }
  const float w = static_cast<float>(image.levels[0].width) * image.uv.scale[0];
  const float h = static_cast<float>(image.levels[0].height) * image.uv.scale[1];
  const float ww = w * w, hh = h * h, last_level = image.last_level;
  const float *ur = run.footprints.u_right + first, *vr = run.footprints.v_right + first;
  const float *ud = run.footprints.u_down + first, *vd = run.footprints.v_down + first;
  for (std::size_t i = 0; i < count; ++i) {
    const float right = ur[i] * ur[i] * ww + vr[i] * vr[i] * hh;
    const float down = ud[i] * ud[i] * ww + vd[i] * vd[i] * hh;
    const float longest = right < down ? down : right;
    const float level = half_log2(longest > 1 ? longest : 1.0f);
    out.level[i] = level < last_level ? level : last_level;
  }
}

/// Where the upper left of the four texels around each look-up stands in one level, and how far beyond its
/// centre the look-up is.
struct Corners {
  std::int32_t place[kBlock];
  float s[kBlock], t[kBlock];
};

/// Look-ups [from, to) in the same level. u wraps, v is clamped.
inline void find_corners(const postrender::LevelView& level, const LookUps& at, std::size_t from,
                         std::size_t to, Corners& out) {
  constexpr std::int32_t kTile = postrender::kTile, kLast = kTile - 1, kTileRow = postrender::kTileRow;
  constexpr int kTileBits = 3;
  static_assert(kTile == 1 << kTileBits);
  const auto width = static_cast<float>(level.width), height = static_cast<float>(level.height);
  const std::int32_t last_x = level.width - 1, row_of_tiles = level.row_of_tiles, first = level.first;
  for (std::size_t i = from; i < to; ++i) {
    const float x = at.x[i] * width - 0.5f;
    const std::int32_t low = static_cast<std::int32_t>(x + 1) - 1, column = low < 0 ? last_x : low;
    out.s[i] = x - static_cast<float>(low);
    const float unclamped = at.y[i] * height - 0.5f, above = unclamped < 0 ? 0.0f : unclamped;
    const float y = above > height - 1 ? height - 1 : above;
    const auto row = static_cast<std::int32_t>(y);
    out.t[i] = y - static_cast<float>(row);
    out.place[i] = first + (column >> kTileBits) * postrender::kTileTexels + (column & kLast) +
                   (row >> kTileBits) * row_of_tiles + (row & kLast) * kTileRow;
  }
}

/// Tiles follow one another in no order that the processor would guess. The coarser level, a quarter of the
/// size, is mostly there already.
inline void fetch_early(const postrender::Texel* texels, const Corners& corners, std::size_t from,
                        std::size_t to) {
  for (std::size_t i = from; i < to; ++i) {
    const postrender::Texel* top = texels + static_cast<std::uint32_t>(corners.place[i]);
    __builtin_prefetch(top);
    __builtin_prefetch(top + postrender::kTileRow + 1);
  }
}

/// The left and the right column of texels, mixed along each.
inline TwoColors columns(const postrender::Texel* texels, const Corners& corners, std::size_t i) {
  const postrender::Texel* top = texels + static_cast<std::uint32_t>(corners.place[i]);
  const TwoColors upper = widened(load<Short8>(top)),
                  lower = widened(load<Short8>(top + postrender::kTileRow));
  return upper + corners.t[i] * (lower - upper);
}

/// One level.
inline Float4 bilinear(const postrender::Texel* texels, const Corners& corners, std::size_t i) {
  const TwoColors both = columns(texels, corners, i);
  return mix(first_of(both), second_of(both), corners.s[i]);
}

/// Two levels: bilinear() in both, and the mean.
inline Float4 trilinear(const postrender::Texel* texels, const Corners& fine, const Corners& coarse,
                        std::size_t i, float coarseness) {
  const TwoColors f = columns(texels, fine, i), c = columns(texels, coarse, i);
  const TwoColors left = firsts_of(f, c), right = seconds_of(f, c),
                  levels = left + each_times(fine.s[i], coarse.s[i], right - left);
  return mix(first_of(levels), second_of(levels), coarseness);
}

/// Where the look-ups that lie between the same two levels as the first one end.
inline std::size_t end_of_level(const LookUps& at, std::size_t first, std::size_t count) {
  const auto level = static_cast<std::int32_t>(at.level[first]);
  std::int32_t difference = 0;
  for (std::size_t i = first; i < count; ++i) difference |= static_cast<std::int32_t>(at.level[i]) ^ level;
  if (difference == 0) return count;
  std::size_t last = first;
  while (static_cast<std::int32_t>(at.level[last]) == level) ++last;
  return last;
}

/// The look-ups of a block with all that they need: the next block's texels are fetched while this one's are
/// mixed.
struct Block {
  std::size_t count = 0;
  LookUps at;
  Corners fine, coarse;
};

/// Whether any of the look-ups lies between its level and the next.
inline bool is_between(const LookUps& at, std::size_t first, std::size_t last) {
  const auto level = static_cast<float>(static_cast<std::int32_t>(at.level[first]));
  std::int32_t between = 0;
  for (std::size_t i = first; i < last; ++i) between |= at.level[i] != level ? 1 : 0;
  return between != 0;
}

/// Level by level: neighbouring pixels nearly always share theirs.
inline void prepare(const postrender::ImageView& image, const postrender::Run& run, std::size_t from,
                    Block& block) {
  block.count = run.count - from < kBlock ? run.count - from : kBlock;
  place(image, run, from, block.count, block.at);
  find_levels(image, run, from, block.count, block.at);
  for (std::size_t first = 0, last = 0; first < block.count; first = last) {
    const auto level = static_cast<std::int32_t>(block.at.level[first]);
    last = end_of_level(block.at, first, block.count);
    find_corners(image.levels[level], block.at, first, last, block.fine);
    if (is_between(block.at, first, last))
      find_corners(image.levels[level + 1], block.at, first, last, block.coarse);
    fetch_early(image.texels, block.fine, first, last);
  }
}

inline void mix_texels(const postrender::ImageView& image, const Block& block, postrender::Rgbx* out) {
  for (std::size_t first = 0, last = 0; first < block.count; first = last) {
    const auto level = static_cast<float>(static_cast<std::int32_t>(block.at.level[first]));
    last = end_of_level(block.at, first, block.count);
    if (is_between(block.at, first, last)) {
      for (std::size_t i = first; i < last; ++i)
        store(image.unit * trilinear(image.texels, block.fine, block.coarse, i, block.at.level[i] - level),
              out + i);
    } else {
      for (std::size_t i = first; i < last; ++i)
        store(image.unit * bilinear(image.texels, block.fine, i), out + i);
    }
  }
}

void image_colors(const postrender::ImageView& image, const postrender::Run& run, postrender::Rgbx* out) {
  if (run.count == 0) return;
  Block blocks[2];
  prepare(image, run, 0, blocks[0]);
  for (std::size_t first = 0, k = 0; first < run.count; first += kBlock, k = 1 - k) {
    if (first + kBlock < run.count) prepare(image, run, first + kBlock, blocks[1 - k]);
    mix_texels(image, blocks[k], out + first);
  }
}

/// The mean of the square wave (-1)^floor(x) over [x - width/2, x + width/2]: its integral is a triangle
/// wave.
inline float square_wave_mean(float x, float width) {
  const float side = width < kFarthest ? width : kFarthest;
  const float first = x - side / 2, last = x + side / 2;
  const float floor_first = floor_of(first);
  const auto triangle = [](float y) {
    const float phase = y - 2 * floor_of(y / 2);
    return phase < 1 ? phase : 2 - phase;
  };
  const float mean = (triangle(last) - triangle(first)) / (last - first);
  const float whole = floor_of(x), sharp = whole - 2 * floor_of(whole / 2) == 0 ? 1.0f : -1.0f;
  const float bounded = mean < -1 ? -1.0f : mean > 1 ? 1.0f : mean;
  return floor_first < floor_of(last) ? bounded : sharp;
}

constexpr float kBelowOne = 1 - 1e-6f;  ///< v = 1 belongs to the topmost squares

inline float magnitude(float x) { return x < 0 ? -x : x; }

inline Float4 lanes_of(postrender::Rgb c) { return Float4{c.r, c.g, c.b, 0}; }

void checkerboard_colors(const postrender::CheckerboardTexture& board, const postrender::Run& run,
                         postrender::Rgbx* out) {
  const Float4 odd = lanes_of(board.odd[0]), odd_change = lanes_of(board.odd[1]) - odd;
  const Float4 even = lanes_of(board.even[0]), even_change = lanes_of(board.even[1]) - even;
  const postrender::Footprints& f = run.footprints;
  const float nu = board.counts[0], nv = board.counts[1];
  for (std::size_t first = 0; first < run.count; first += kBlock) {
    const std::size_t count = run.count - first < kBlock ? run.count - first : kBlock;
    float along[kBlock], evenness[kBlock];
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t p = first + i;
      const float unwrapped = finite_or_zero(run.u[p]), upwards = finite_or_zero(run.v[p]);
      const float u = unwrapped - floor_of(unwrapped);
      const float v = upwards < 0 ? 0.0f : upwards < kBelowOne ? upwards : kBelowOne;
      const float wave = square_wave_mean(u * nu, nu * (magnitude(f.u_right[p]) + magnitude(f.u_down[p]))) *
                         square_wave_mean(v * nv, nv * (magnitude(f.v_right[p]) + magnitude(f.v_down[p])));
      evenness[i] = 0.5f + 0.5f * wave;
      along[i] = board.axis == 0 ? u : v;
    }
    for (std::size_t i = 0; i < count; ++i)
      store(mix(odd + along[i] * odd_change, even + along[i] * even_change, evenness[i]), out + first + i);
  }
}

NULLCONE_KERNEL_END
