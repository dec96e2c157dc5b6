// Tone curves along a run of pixels (develop.h): on the luminance, the three components scaled alike. All
// components are at most kBrightest.
#pragma once

#include "postrender/kernel.h"
#include "postrender/lanes.h"

NULLCONE_KERNEL_BEGIN

inline float luminance_of(const postrender::Rgb& weights, float r, float g, float b) {
  return weights.r * r + weights.g * g + weights.b * b;
}

/// Colours times factor(luminance), where there is light.
template <class Factor>
inline void scaled_by_luminance(const postrender::Rgb& weights, std::size_t count,
                                const postrender::Planes& colors, Factor&& factor) {
  float* __restrict r = colors.r, * __restrict g = colors.g, * __restrict b = colors.b;
  const postrender::Rgb w = weights;
  for (std::size_t i = 0; i < count; ++i) {
    const float Y = luminance_of(w, r[i], g[i], b[i]);
    const float found = factor(Y);
    const float s = Y > 0 ? found : 1.0f;
    r[i] = s * r[i];
    g[i] = s * g[i];
    b[i] = s * b[i];
  }
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

/// Y -> 1 - exp(-k Y).
void exponential_curve(float k, const postrender::Rgb& weights, std::size_t count,
                       const postrender::Planes& colors) {
  scaled_by_luminance(weights, count, colors, [k](float Y) { return one_minus_exp(k * Y) / Y; });
}

/// Y -> Y (a1 x + a0) / ((b2 x + b1) x + b0) with x = stretch Y; 1 from `white` on.
void filmic_curve(const postrender::FilmicCurve& curve, const postrender::Rgb& weights, std::size_t count,
                  const postrender::Planes& colors) {
  const postrender::FilmicCurve c = curve;
  scaled_by_luminance(weights, count, colors, [c](float Y) {
    const float x = c.stretch * Y;
    const float above = c.a1 * x + c.a0, below = (c.b2 * x + c.b1) * x + c.b0;
    const bool within = Y < c.white;
    return (within ? above : 1.0f) / (within ? below : Y);
  });
}

/// Straight from node to node, in proportion to Y below the first one, held above the last point.
void table_curve(const postrender::ToneTableView& table, const postrender::Rgb& weights, std::size_t count,
                 const postrender::Planes& colors) {
  constexpr int kShift = postrender::kToneShift;
  const postrender::ToneTableView t = table;
  scaled_by_luminance(weights, count, colors, [t](float Y) {
    const float held = Y < t.highest ? Y : t.highest;
    const float at = held > t.lowest ? held : t.lowest;
    const auto bits = bits_as<std::int32_t>(at);
    const float* node = t.nodes + ((bits >> kShift) - t.first);
    const float s = static_cast<float>(bits & ((1 << kShift) - 1)) * (1.0f / (1 << kShift));
    return (node[0] + s * (node[1] - node[0])) / (Y > t.highest ? Y : at);
  });
}

NULLCONE_KERNEL_END
