#include "postrender/shade.h"

#include <algorithm>

#include "postrender/footprint.h"

namespace nullcone::postrender {

namespace {

/// A crossing that contributes to its pixel.
struct Visible {
  std::size_t hit;
  std::uint32_t column, row;
  float weight;  ///< transmittance in front of it times its opacity
};

std::size_t appearance_at(const ObjectShading& object, const Hits& hits, std::size_t hit) {
  for (const Slice& slice : object.slices) {
    const double time = slice.own_clock ? static_cast<double>(hits.tau[hit]) + object.tau_origin
                                        : static_cast<double>(hits.t[hit]);
    if (time >= slice.from && time < slice.to) return slice.appearance;
  }
  return object.appearance;
}

/// The crossings of a band that are seen, one list an appearance; lays the background behind them.
std::vector<std::vector<Visible>> sort_by_appearance(const Dataset& dataset, const Shading& shading,
                                                     int first_row, int last_row, Radiance& radiance) {
  const Hits& hits = dataset.hits;
  const auto width = static_cast<std::uint32_t>(dataset.manifest.width);
  std::vector<std::vector<Visible>> lists(shading.appearances.size());
  for (auto row = static_cast<std::uint32_t>(first_row); row < static_cast<std::uint32_t>(last_row); ++row) {
    for (std::uint32_t column = 0; column < width; ++column) {
      const std::size_t pixel = std::size_t{row} * width + column;
      float transmittance = 1;
      for (std::size_t hit = hits.offset[pixel]; hit < hits.offset[pixel + 1] && transmittance > 0; ++hit) {
        const float opacity = std::clamp(hits.A[hit], 0.0f, 1.0f);
        const std::size_t appearance = appearance_at(shading.objects[hits.id[hit] - 1], hits, hit);
        lists[appearance].push_back({hit, column, row, transmittance * opacity});
        transmittance *= 1 - opacity;
      }
      radiance.display[pixel] = transmittance * shading.background;
    }
  }
  return lists;
}

/// The pixel loop: one texture type, one spectrum type.
template <class TextureType, class SpectrumType>
void shade_list(const Dataset& dataset, const std::vector<Visible>& list, const TextureType& texture,
                const SpectrumType& spectrum, std::vector<Rgb>& picture) {
  const Hits& hits = dataset.hits;
  const FootprintEstimate footprint_of(dataset);
  const auto width = static_cast<std::size_t>(dataset.manifest.width);
  for (const Visible& seen : list) {
    Footprint footprint;
    if constexpr (TextureType::kNeedsFootprint) footprint = footprint_of(seen.hit, seen.column, seen.row);
    const Rgb color = spectrum(texture(hits.u[seen.hit], hits.v[seen.hit], footprint), hits.shift[seen.hit]);
    Rgb& pixel = picture[seen.row * width + seen.column];
    pixel = pixel + seen.weight * color;
  }
}

}  // namespace

bool has_physical(const Shading& shading) {
  return std::ranges::any_of(shading.appearances, [](const Appearance& appearance) {
    return std::holds_alternative<BlackBodySpectrum>(appearance.spectrum);
  });
}

void shade_rows(const Dataset& dataset, const Shading& shading, int first_row, int last_row,
                Radiance& radiance) {
  const auto lists = sort_by_appearance(dataset, shading, first_row, last_row, radiance);
  for (std::size_t i = 0; i < lists.size(); ++i)
    std::visit(
        [&](const auto& texture, const auto& spectrum) {
          const bool physical = std::decay_t<decltype(spectrum)>::kPhysical;
          shade_list(dataset, lists[i], texture, spectrum, physical ? radiance.physical : radiance.display);
        },
        shading.appearances[i].texture, shading.appearances[i].spectrum);
}

}  // namespace nullcone::postrender
