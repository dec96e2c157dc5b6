// Exposure, gamut mapping and encoding along a run of pixels (develop.h).
#pragma once

#include "postrender/kernel_tone.h"

NULLCONE_KERNEL_BEGIN

inline float limited(double x) {
  constexpr auto kMost = static_cast<double>(postrender::kBrightest);
  return static_cast<float>(x > kMost ? kMost : x < -kMost ? -kMost : x);
}

/// A colour that float could not hold on its way, in double; black where it is no number.
[[gnu::noinline]] inline postrender::Rgb exposed_safely(const postrender::Exposure& by,
                                                        const postrender::Rgbx& display,
                                                        const postrender::Rgbx& physical) {
  const auto sum = [&](float d, float p) {
    return static_cast<double>(limited(static_cast<double>(by.gain) * static_cast<double>(d) +
                                       static_cast<double>(by.physical_gain) * static_cast<double>(p)));
  };
  const double r = sum(display.r, physical.r), g = sum(display.g, physical.g), b = sum(display.b, physical.b);
  if (!(r + g + b < 1e300)) return {};
  if (by.matrix == nullptr) return {limited(r), limited(g), limited(b)};
  const auto row = [&](const postrender::Rgb& m) {
    return limited(static_cast<double>(m.r) * r + static_cast<double>(m.g) * g +
                   static_cast<double>(m.b) * b);
  };
  return {row(by.matrix[0]), row(by.matrix[1]), row(by.matrix[2])};
}

inline bool sound(float r, float g, float b) {
  return __builtin_fabsf(r) + __builtin_fabsf(g) + __builtin_fabsf(b) <= postrender::kBrightest;
}

/// gain * display + physical_gain * physical: first as colours lie in memory, then by component.
inline void add_up(const postrender::Rgbx* display, const postrender::Rgbx* physical,
                   const postrender::Exposure& by, std::size_t count, const postrender::Planes& out) {
  float sums[4 * postrender::kSegment];
  const float gain = by.gain, physical_gain = by.physical_gain;
  const float* __restrict d = &display->r;
  if (physical == nullptr) {
    for (std::size_t i = 0; i < 4 * count; ++i) sums[i] = gain * d[i];
  } else {
    const float* __restrict p = &physical->r;
    for (std::size_t i = 0; i < 4 * count; ++i) sums[i] = gain * d[i] + physical_gain * p[i];
  }
  float* __restrict r = out.r, * __restrict g = out.g, * __restrict b = out.b;
  for (std::size_t i = 0; i < count; ++i) {
    r[i] = sums[4 * i];
    g[i] = sums[4 * i + 1];
    b[i] = sums[4 * i + 2];
  }
}

/// Through the matrix, if there is one; returns whether all colours are sound.
inline bool transformed(const postrender::Rgb* matrix, std::size_t count, const postrender::Planes& colors) {
  float* __restrict r = colors.r, * __restrict g = colors.g, * __restrict b = colors.b;
  std::int32_t faults = 0;
  if (matrix == nullptr) {
    for (std::size_t i = 0; i < count; ++i) faults |= sound(r[i], g[i], b[i]) ? 0 : 1;
    return faults == 0;
  }
  const postrender::Rgb x = matrix[0], y = matrix[1], z = matrix[2];
  for (std::size_t i = 0; i < count; ++i) {
    const float R = r[i], G = g[i], B = b[i];
    r[i] = x.r * R + x.g * G + x.b * B;
    g[i] = y.r * R + y.g * G + y.b * B;
    b[i] = z.r * R + z.g * G + z.b * B;
    faults |= sound(r[i], g[i], b[i]) ? 0 : 1;
  }
  return faults == 0;
}

void expose(const postrender::Rgbx* display, const postrender::Rgbx* physical, const postrender::Exposure& by,
            std::size_t count, const postrender::Planes& out) {
  add_up(display, physical, by, count, out);
  if (transformed(by.matrix, count, out)) return;
  for (std::size_t i = 0; i < count; ++i) {
    if (sound(out.r[i], out.g[i], out.b[i])) continue;
    const postrender::Rgb c =
        exposed_safely(by, display[i], physical == nullptr ? postrender::Rgbx{} : physical[i]);
    out.r[i] = c.r;
    out.g[i] = c.g;
    out.b[i] = c.b;
  }
}

inline float clipped(float x) {
  const float below = x < 1 ? x : 1.0f;
  return x > 0 ? below : 0.0f;
}

inline float least(float a, float b) { return a < b ? a : b; }
inline float most(float a, float b) { return a > b ? a : b; }

/// As masks: of choices the compiler would make blends, which cost more.
inline float where_between_0_and_1(float Y, float x) {
  const std::int32_t keep = -(static_cast<std::int32_t>(Y > 0) & static_cast<std::int32_t>(Y < 1));
  return bits_as<float>(bits_as<std::int32_t>(x) & keep);
}

void desaturate(const postrender::Rgb& weights, std::size_t count, const postrender::Planes& colors) {
  float* __restrict r = colors.r, * __restrict g = colors.g, * __restrict b = colors.b;
  const postrender::Rgb w = weights;
  for (std::size_t i = 0; i < count; ++i) {
    const float Y = luminance_of(w, r[i], g[i], b[i]), grey = clipped(Y);
    const float lowest = least(least(r[i], g[i]), least(b[i], 0.0f)),
                highest = most(most(r[i], g[i]), most(b[i], 1.0f));
    // How much may be kept of the colour's difference from grey: all within the gamut, nothing of black and
    // of white.
    const float upwards = Y / (Y - lowest), downwards = (1 - Y) / (highest - Y);
    const float kept = where_between_0_and_1(Y, least(upwards, downwards));
    r[i] = clipped(grey + kept * (r[i] - grey));  // rounding may leave the gamut by a bit
    g[i] = clipped(grey + kept * (g[i] - grey));
    b[i] = clipped(grey + kept * (b[i] - grey));
  }
}

void clip(std::size_t count, const postrender::Planes& colors) {
  for (float* __restrict plane : {colors.r, colors.g, colors.b})
    for (std::size_t i = 0; i < count; ++i) plane[i] = clipped(plane[i]);
}

/// As Srgb8Table has it: the place within its bin carries into the code. The look-ups are a loop of their
/// own, which leaves all else to wide instructions.
inline void encode(const std::uint32_t* table, std::size_t count, const float* __restrict from,
                   std::uint8_t* __restrict to) {
  constexpr float kBins = postrender::Srgb8Table::kBins, kPlaces = 1 << postrender::Srgb8Table::kPlaceBits;
  std::int32_t bins[postrender::kSegment];
  std::uint32_t sums[postrender::kSegment];
  for (std::size_t i = 0; i < count; ++i) {
    const float at = kBins * clipped(from[i]);
    bins[i] = static_cast<std::int32_t>(at);
    sums[i] =
        static_cast<std::uint32_t>(static_cast<std::int32_t>(kPlaces * (at - static_cast<float>(bins[i]))));
  }
  for (std::size_t i = 0; i < count; ++i) sums[i] += table[bins[i]];
  for (std::size_t i = 0; i < count; ++i)
    to[i] = static_cast<std::uint8_t>(sums[i] >> postrender::Srgb8Table::kPlaceBits);
}

void encode_srgb8(const std::uint32_t* table, const postrender::Planes& colors, std::size_t count,
                  std::uint8_t* __restrict out) {
  std::uint8_t r[postrender::kSegment], g[postrender::kSegment], b[postrender::kSegment];
  encode(table, count, colors.r, r);
  encode(table, count, colors.g, g);
  encode(table, count, colors.b, b);
  for (std::size_t i = 0; i < count; ++i) {
    out[3 * i] = r[i];
    out[3 * i + 1] = g[i];
    out[3 * i + 2] = b[i];
  }
}

void interleave(const postrender::Planes& colors, std::size_t count, postrender::Rgb* out) {
  const float* __restrict r = colors.r, * __restrict g = colors.g, * __restrict b = colors.b;
  for (std::size_t i = 0; i < count; ++i) {
    out[i].r = r[i];
    out[i].g = g[i];
    out[i].b = b[i];
  }
}

NULLCONE_KERNEL_END
