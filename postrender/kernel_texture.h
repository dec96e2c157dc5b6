// Textures along a run of pixels.
#pragma once

#include "postrender/kernel.h"
#include "postrender/lanes.h"

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

/// The four texels around each look-up in one level stand at x + y, for low or high x and low or high y.
struct Neighbours {
  std::int32_t low_x[kBlock], high_x[kBlock], low_y[kBlock], high_y[kBlock];
  float s[kBlock], t[kBlock];
};

/// Look-ups [from, to) in the same level. u wraps, v is clamped.
inline void find_neighbours(const postrender::LevelView& level, const LookUps& at, std::size_t from,
                            std::size_t to, Neighbours& out) {
  const auto width = static_cast<float>(level.width), height = static_cast<float>(level.height);
  const std::int32_t last_x = level.width - 1, last_y = level.height - 1;
  const std::int32_t row_of_tiles = level.row_of_tiles, first = level.first;
  const auto x_place = [](std::int32_t i) { return (i >> 2) * 16 + (i & 3); };
  const auto y_place = [=](std::int32_t j) { return first + (j >> 2) * row_of_tiles + (j & 3) * 4; };
  for (std::size_t i = from; i < to; ++i) {
    const float x = at.x[i] * width - 0.5f;
    const std::int32_t low = static_cast<std::int32_t>(x + 1) - 1, high = low + 1;
    out.s[i] = x - static_cast<float>(low);
    out.low_x[i] = x_place(low < 0 ? last_x : low);
    out.high_x[i] = x_place(high > last_x ? 0 : high);
  }
  for (std::size_t i = from; i < to; ++i) {
    const float unclamped = at.y[i] * height - 0.5f, above = unclamped < 0 ? 0.0f : unclamped;
    const float y = above > height - 1 ? height - 1 : above;
    const auto low = static_cast<std::int32_t>(y);
    out.t[i] = y - static_cast<float>(low);
    out.low_y[i] = y_place(low);
    out.high_y[i] = y_place(low < last_y ? low + 1 : last_y);
  }
}

/// Sign, exponent and mantissa of half floats where floats have them; times 2^112 this is their value.
inline Float4 placed(Int4 half) {
  return bits_as<Float4>((half << 13) & static_cast<std::int32_t>(0x8fffe000U));
}
inline Float8 placed(Int8 half) {
  return bits_as<Float8>((half << 13) & static_cast<std::int32_t>(0x8fffe000U));
}

inline Short4 texel_at(const postrender::Texel* texels, std::int32_t x, std::int32_t y) {
  return load<Short4>(texels + static_cast<std::uint32_t>(x + y));
}

/// One level.
inline Float4 widened(Short4 half) {
  // Each half float becomes the upper half of a word, and then goes down again with its sign.
  const Short4 none = {};
  return placed(bits_as<Int4>(__builtin_shufflevector(none, half, 0, 4, 1, 5, 2, 6, 3, 7)) >> 16);
}

inline Float4 bilinear(const postrender::Texel* texels, float unit, const Neighbours& near, std::size_t i) {
  const std::int32_t left = near.low_x[i], right = near.high_x[i], top = near.low_y[i],
                     bottom = near.high_y[i];
  const Float4 a = unit * widened(texel_at(texels, left, top)),
               b = unit * widened(texel_at(texels, right, top)),
               c = unit * widened(texel_at(texels, left, bottom)),
               d = unit * widened(texel_at(texels, right, bottom));
  return mix(mix(a, b, near.s[i]), mix(c, d, near.s[i]), near.t[i]);
}

/// Two levels: bilinear() in both, and the mean.
inline Float4 trilinear(const postrender::Texel* texels, float unit, const Neighbours& fine,
                        const Neighbours& coarse, std::size_t i, float coarseness) {
#ifdef __AVX2__  // side by side in one register, with the same roundings
  const auto both = [&](const std::int32_t(Neighbours::*x)[kBlock],
                        const std::int32_t(Neighbours::*y)[kBlock]) {
    const Short8 half =
        __builtin_shufflevector(texel_at(texels, (fine.*x)[i], (fine.*y)[i]),
                                texel_at(texels, (coarse.*x)[i], (coarse.*y)[i]), 0, 1, 2, 3, 4, 5, 6, 7);
    return unit * placed(__builtin_convertvector(half, Int8));
  };
  const auto each = [](float f, float c) { return Float8{f, f, f, f, c, c, c, c}; };
  const Float8 s = each(fine.s[i], coarse.s[i]), t = each(fine.t[i], coarse.t[i]);
  const Float8 a = both(&Neighbours::low_x, &Neighbours::low_y),
               b = both(&Neighbours::high_x, &Neighbours::low_y),
               c = both(&Neighbours::low_x, &Neighbours::high_y),
               d = both(&Neighbours::high_x, &Neighbours::high_y);
  const Float8 top = a + s * (b - a), bottom = c + s * (d - c), color = top + t * (bottom - top);
  return mix(__builtin_shufflevector(color, color, 0, 1, 2, 3),
             __builtin_shufflevector(color, color, 4, 5, 6, 7), coarseness);
#else
  return mix(bilinear(texels, unit, fine, i), bilinear(texels, unit, coarse, i), coarseness);
#endif
}

/// The look-ups of a block, level by level: neighbouring pixels nearly always share theirs.
inline void image_block(const postrender::ImageView& image, const LookUps& at, std::size_t count,
                        postrender::Rgbx* out) {
  const float unit = image.unit * 0x1p112f;
  Neighbours fine, coarse;
  for (std::size_t first = 0, last = 0; first < count; first = last) {
    const auto level = static_cast<std::int32_t>(at.level[first]);
    bool between = false;
    while (last < count && static_cast<std::int32_t>(at.level[last]) == level)
      between |= at.level[last++] != static_cast<float>(level);
    find_neighbours(image.levels[level], at, first, last, fine);
    if (!between) {
      for (std::size_t i = first; i < last; ++i) store(bilinear(image.texels, unit, fine, i), out + i);
      continue;
    }
    find_neighbours(image.levels[level + 1], at, first, last, coarse);
    for (std::size_t i = first; i < last; ++i)
      store(trilinear(image.texels, unit, fine, coarse, i, at.level[i] - static_cast<float>(level)), out + i);
  }
}

void image_colors(const postrender::ImageView& image, const postrender::Run& run, postrender::Rgbx* out) {
  LookUps at;
  for (std::size_t first = 0; first < run.count; first += kBlock) {
    const std::size_t count = run.count - first < kBlock ? run.count - first : kBlock;
    place(image, run, first, count, at);
    find_levels(image, run, first, count, at);
    image_block(image, at, count, out + first);
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
