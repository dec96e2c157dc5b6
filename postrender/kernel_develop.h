// Exposure, tone curve and gamut mapping along a run of pixels (develop.h).
#pragma once

#include "postrender/color.h"
#include "postrender/kernel.h"
#include "postrender/lanes.h"

NULLCONE_KERNEL_BEGIN

void expose(const postrender::Rgbx* display, float gain, const postrender::Rgbx* physical,
            float physical_gain, std::size_t count, const postrender::Planes& out) {
  float* __restrict r = out.r, * __restrict g = out.g, * __restrict b = out.b;
  if (physical == nullptr) {
    for (std::size_t i = 0; i < count; ++i) {
      r[i] = gain * display[i].r;
      g[i] = gain * display[i].g;
      b[i] = gain * display[i].b;
    }
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    r[i] = gain * display[i].r + physical_gain * physical[i].r;
    g[i] = gain * display[i].g + physical_gain * physical[i].g;
    b[i] = gain * display[i].b + physical_gain * physical[i].b;
  }
}

inline float luminance_of(float r, float g, float b) {
  return postrender::kLuminance.r * r + postrender::kLuminance.g * g + postrender::kLuminance.b * b;
}

/// 1 - exp(-x) for x >= 0, to 2e-7: exp(-x) = 2^n (1 + p), so that nothing is lost where x is small.
inline float one_minus_exp(float x) {
  const float t = x < 40 ? -x : -40.0f;
  const float n = nearest_of(t * 1.44269504f);
  const float y = (t - n * 0.693359375f) + n * 2.12194440e-4f;  // ln 2 in two parts (Cephes)
  float p = 1.9875691500e-4f;
  p = p * y + 1.3981999507e-3f;
  p = p * y + 8.3334519073e-3f;
  p = p * y + 4.1665795894e-2f;
  p = p * y + 1.6666665459e-1f;
  p = p * y + 5.0000001201e-1f;
  p = p * y * y + y;
  const float scale = bits_as<float>((static_cast<std::int32_t>(n) + 127) << 23);
  return (1 - scale) - scale * p;
}

/// Y -> 1 - exp(-k Y), the three components alike. Far beyond the shoulder the ratio alone would lose the
/// colour to 0 * infinity.
void exponential_curve(float k, std::size_t count, const postrender::Planes& colors) {
  float* __restrict r = colors.r, * __restrict g = colors.g, * __restrict b = colors.b;
  for (std::size_t i = 0; i < count; ++i) {
    const float Y = luminance_of(r[i], g[i], b[i]);
    const bool lit = Y > 0, endless = lit & !(Y < __builtin_inff());
    const float ratio = one_minus_exp(k * Y) / Y;
    const float factor = lit ? ratio : 1.0f;
    r[i] = endless ? 1.0f : factor * r[i];
    g[i] = endless ? 1.0f : factor * g[i];
    b[i] = endless ? 1.0f : factor * b[i];
  }
}

inline float clipped(float x) {
  const float below = x < 1 ? x : 1.0f;
  return x > 0 ? below : 0.0f;
}

inline float least(float a, float b) { return a < b ? a : b; }
inline float most(float a, float b) { return a > b ? a : b; }

void desaturate(std::size_t count, const postrender::Planes& colors) {
  float* __restrict r = colors.r, * __restrict g = colors.g, * __restrict b = colors.b;
  for (std::size_t i = 0; i < count; ++i) {
    const float Y = luminance_of(r[i], g[i], b[i]);
    const float lowest = least(least(r[i], g[i]), b[i]), highest = most(most(r[i], g[i]), b[i]);
    // How much may be kept of the colour's difference from grey.
    const float upwards = Y / (Y - lowest), downwards = (1 - Y) / (highest - Y);
    const float kept = least(lowest < 0 ? upwards : 1.0f, highest > 1 ? downwards : 1.0f);
    const bool black = !(Y > 0), white = Y >= 1;
    const auto mapped = [&](float c) {  // rounding may leave the gamut by a bit
      const float inside = clipped(Y + kept * (c - Y));
      const float lit = white ? 1.0f : inside;
      return black ? 0.0f : lit;
    };
    r[i] = mapped(r[i]);
    g[i] = mapped(g[i]);
    b[i] = mapped(b[i]);
  }
}

void clip(std::size_t count, const postrender::Planes& colors) {
  for (float* __restrict plane : {colors.r, colors.g, colors.b})
    for (std::size_t i = 0; i < count; ++i) plane[i] = clipped(plane[i]);
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
