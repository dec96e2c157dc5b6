// What a surface radiates and what of it is seen (spectrum.h), along a run of pixels.
#pragma once

#include "postrender/kernel.h"
#include "postrender/lanes.h"

NULLCONE_KERNEL_BEGIN

inline float fourth_power(float g) { return (g * g) * (g * g); }

inline void add(postrender::Rgbx* sum, Float4 light) { store(load<Float4>(sum) + light, sum); }

bool weigh(const float* __restrict opacity, std::size_t count, float* __restrict transmittance,
           float* __restrict weight, std::uint32_t* __restrict appearance) {
  std::int32_t through = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const float above = opacity[i] < 0 ? 0.0f : opacity[i], A = above > 1 ? 1.0f : above;
    const float T = transmittance[i];
    const bool seen = (T > 0) & (appearance[i] != postrender::kUnseen);
    weight[i] = T * A;
    const float behind = seen ? T * (1 - A) : T;
    transmittance[i] = behind;
    through |= behind != 0 ? 1 : 0;
    appearance[i] = seen ? appearance[i] : postrender::kUnseen;
  }
  return through != 0;
}

void background_light(const float* transmittance, const postrender::Rgbx& color, std::size_t count,
                      postrender::Rgbx* sum) {
  const Float4 behind = load<Float4>(&color);
  for (std::size_t i = 0; i < count; ++i) add(sum + i, transmittance[i] * behind);
}

void display_light(bool searchlight, const postrender::Run& run, const postrender::Rgbx* colors,
                   postrender::Rgbx* sum) {
  for (std::size_t i = 0; i < run.count; ++i) {
    const float beaming = searchlight ? fourth_power(run.shift[i]) : 1.0f;
    add(sum + i, run.weight[i] * (beaming * load<Float4>(colors + i)));
  }
}

/// Where a temperature stands in the table, and by how much the entry is to be multiplied.
struct Seen {
  std::int32_t node;
  float s, factor;
};

/// Black for what is colder than the table or not a number; in proportion to the temperature beyond the
/// hottest.
inline Seen seen_at(float temperature_K) {
  constexpr auto kColdest = static_cast<float>(postrender::kColdest_K);
  constexpr auto kHottest = static_cast<float>(postrender::kHottest_K);
  constexpr int kUnused = 23 - postrender::kNodeBits;  // bits of the mantissa between two nodes
  const float within =
      temperature_K > kColdest ? temperature_K < kHottest ? temperature_K : kHottest : kColdest;
  const float beyond = temperature_K > kHottest ? temperature_K * (1 / kHottest) : 1.0f;
  const auto bits = bits_as<std::int32_t>(within);
  return {(bits >> kUnused) - postrender::kFirstNode,
          static_cast<float>(bits & ((1 << kUnused) - 1)) * (1.0f / (1 << kUnused)),
          temperature_K >= kColdest ? beyond : 0.0f};
}

inline Float4 color_at(const postrender::BlackBodyNode& node, float s) {
  const Float4 c0 = load<Float4>(&node.c[0]), c1 = load<Float4>(&node.c[1]), c2 = load<Float4>(&node.c[2]),
               c3 = load<Float4>(&node.c[3]);
  return c0 + s * (c1 + s * (c2 + s * c3));
}

/// Without `doppler` the colour is that at rest.
void light_at_rest(const postrender::BlackBodyView& body, const postrender::Run& run,
                   const postrender::Rgbx* colors, postrender::Rgbx* sum) {
  const Float4 at_rest = load<Float4>(&body.at_rest);
  for (std::size_t i = 0; i < run.count; ++i) {
    const float g = run.shift[i];
    const bool sensible = g > 0 && g < __builtin_inff();
    const float factor = body.searchlight ? fourth_power(g) : 1.0f;
    add(sum + i, run.weight[i] * ((sensible ? factor : 0.0f) * (load<Float4>(colors + i) * at_rest)));
  }
}

/// L(g lambda; T) = g^-5 B(lambda; g T): a look-up at g T.
void black_body_light(const postrender::BlackBodyView& body, const postrender::Run& run,
                      const postrender::Rgbx* colors, postrender::Rgbx* sum) {
  if (!body.doppler) return light_at_rest(body, run, colors, sum);
  constexpr std::size_t kRow = 64;
  for (std::size_t first = 0; first < run.count; first += kRow) {
    const std::size_t count = run.count - first < kRow ? run.count - first : kRow;
    std::int32_t node[kRow];
    float s[kRow], factor[kRow];
    for (std::size_t i = 0; i < count; ++i) {
      const float g = run.shift[first + i];
      const Seen seen = seen_at(g * body.temperature_K);
      const float beamed = body.searchlight ? seen.factor : seen.factor / (g * fourth_power(g));
      node[i] = seen.node;
      s[i] = seen.s;
      factor[i] = run.weight[first + i] * (g > 0 && g < __builtin_inff() ? beamed : 0.0f);
    }
    for (std::size_t i = 0; i < count; ++i)
      add(sum + first + i,
          factor[i] * (load<Float4>(colors + first + i) * color_at(body.nodes[node[i]], s[i])));
  }
}

NULLCONE_KERNEL_END
