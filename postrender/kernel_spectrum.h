// What of a surface's light is seen (spectrum.h), along a run of pixels.
#pragma once

#include "postrender/kernel.h"
#include "postrender/lanes.h"
#include "postrender/two_colors.h"

NULLCONE_KERNEL_BEGIN

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

void plain_light(const postrender::Lit& lit) {
  for (std::size_t i = 0; i < lit.count; ++i) add(lit.sum + i, lit.weight[i] * load<Float4>(lit.colors + i));
}

constexpr std::size_t kRow = 64;  ///< pixels whose places in the table are found together

/// Where pixels stand in a table, and their weights: 0 where g is not positive and finite.
struct Places {
  std::int32_t node[kRow];
  float s[kRow], weight[kRow];
};

inline void find_places(const postrender::TableView& table, const postrender::Lit& lit, std::size_t first,
                        std::size_t count, Places& out) {
  const float from = table.from, to = table.to;
  const std::int32_t unused = table.unused_bits, mask = (1 << unused) - 1, start = table.first;
  const float part = 1.0f / static_cast<float>(1 << unused);
  const std::int32_t stride = table.stride;
  for (std::size_t i = 0; i < count; ++i) {
    const float g = lit.g[first + i];
    const float above = g > from ? g : from, within = above < to ? above : to;
    const auto bits = bits_as<std::int32_t>(within);
    out.node[i] = ((bits >> unused) - start) * stride;
    out.s[i] = static_cast<float>(bits & mask) * part;
    out.weight[i] = (g > 0) & (g < __builtin_inff()) ? lit.weight[first + i] : 0.0f;
  }
}

inline Float4 color_at(const postrender::TableNode& node, float s) {
  const Float4 c0 = load<Float4>(&node.c[0]), c1 = load<Float4>(&node.c[1]), c2 = load<Float4>(&node.c[2]),
               c3 = load<Float4>(&node.c[3]);
  return c0 + s * (c1 + s * (c2 + s * c3));
}

/// The same for two pixels side by side.
inline TwoColors colors_at(const postrender::TableNode& a, const postrender::TableNode& b, float s, float t) {
  const auto both = [&](std::size_t k) { return two_of(load<Float4>(&a.c[k]), load<Float4>(&b.c[k])); };
  const TwoColors slope = both(1) + each_times(s, t, both(2) + each_times(s, t, both(3)));
  return both(0) + each_times(s, t, slope);
}

/// The table's colour, filtered component by component.
void filtered_light(const postrender::TableView& table, const postrender::Lit& lit) {
  Places at;
  for (std::size_t first = 0; first < lit.count; first += kRow) {
    const std::size_t count = lit.count - first < kRow ? lit.count - first : kRow;
    find_places(table, lit, first, count, at);
    const postrender::Rgbx* colors = lit.colors + first;
    postrender::Rgbx* sum = lit.sum + first;
    std::size_t i = 0;
    for (; i + 2 <= count; i += 2) {
      const TwoColors seen =
          colors_at(table.nodes[at.node[i]], table.nodes[at.node[i + 1]], at.s[i], at.s[i + 1]);
      store_two(load_two(sum + i) + each_times(at.weight[i], at.weight[i + 1], load_two(colors + i) * seen),
                sum + i);
    }
    if (i < count)
      add(sum + i, at.weight[i] * (load<Float4>(colors + i) * color_at(table.nodes[at.node[i]], at.s[i])));
  }
}

/// Each component of the colour is the amount of one of three spectra.
void mixed_light(const postrender::TableView& table, const postrender::Lit& lit) {
  Places at;
  for (std::size_t first = 0; first < lit.count; first += kRow) {
    const std::size_t count = lit.count - first < kRow ? lit.count - first : kRow;
    find_places(table, lit, first, count, at);
    for (std::size_t i = 0; i < count; ++i) {
      const postrender::Rgbx& amount = lit.colors[first + i];
      const postrender::TableNode* node = table.nodes + at.node[i];
      const Float4 light = amount.r * color_at(node[0], at.s[i]) + amount.g * color_at(node[1], at.s[i]) +
                           amount.b * color_at(node[2], at.s[i]);
      add(lit.sum + first + i, at.weight[i] * light);
    }
  }
}

/// What the sensor sees of lines, by the amounts of the spectra that they belong to. In double precision,
/// because its curves are steep, and the purest colours are small differences in linear sRGB.
inline Float4 shifted_lines(const postrender::LinesView& lines, double g, double power,
                            const float* amounts) {
  double seen[3] = {0, 0, 0};
  for (std::size_t k = 0; k < lines.count; ++k) {
    const double x = (lines.lines[k].wavelength_nm / g - lines.first_nm) * lines.per_nm;
    if (!(x >= 0 && x < lines.last)) continue;
    const auto low = static_cast<std::size_t>(x);
    const double s = x - static_cast<double>(low);
    const double strength = lines.lines[k].strength * static_cast<double>(amounts[lines.lines[k].component]);
    const double *a = &lines.response[low][0], *b = a + 3;
    for (int c = 0; c < 3; ++c) seen[c] = seen[c] + strength * (a[c] + s * (b[c] - a[c]));
  }
  return Float4{static_cast<float>(power * seen[0]), static_cast<float>(power * seen[1]),
                static_cast<float>(power * seen[2]), 0};
}

void light_of_lines(const postrender::LinesView& lines, const postrender::Lit& lit) {
  constexpr Float4 kAll = {1, 1, 1, 1};
  Places at;
  for (std::size_t first = 0; first < lit.count; first += kRow) {
    const std::size_t count = lit.count - first < kRow ? lit.count - first : kRow;
    find_places(lines.power, lit, first, count, at);
    for (std::size_t i = 0; i < count; ++i) {
      if (at.weight[i] == 0) continue;
      const Float4 power = color_at(lines.power.nodes[at.node[i]], at.s[i]),
                   color = load<Float4>(lit.colors + first + i), filter = lines.mixed ? kAll : color,
                   amount = lines.mixed ? color : kAll;
      float amounts[4];
      store(amount, amounts);
      const Float4 seen =
          shifted_lines(lines, static_cast<double>(lit.g[first + i]), static_cast<double>(power[0]), amounts);
      add(lit.sum + first + i, at.weight[i] * (filter * seen));
    }
  }
}

NULLCONE_KERNEL_END
