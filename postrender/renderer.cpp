#include "postrender/renderer.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/base/error.h"
#include "postrender/color.h"
#include "postrender/develop.h"

namespace nullcone::postrender {

namespace {

constexpr int kBandRows = 16;

/// Everything that the pixel loop takes for granted.
void check_records(const Dataset& dataset) {
  const Hits& hits = dataset.hits;
  const auto refuse = [](const std::string& message) { throw InputError("dataset", message); };
  if (dataset.manifest.width < 1 || dataset.manifest.height < 1) refuse("an empty picture");
  if (hits.offset.size() != dataset.pixels() + 1 || hits.offset.front() != 0)
    refuse("expected one count of crossings a pixel");
  if (!std::ranges::is_sorted(hits.offset)) refuse("the counts of crossings run backwards");
  for_each_channel(hits, kHitChannels, [&](const auto& channel, const auto& column) {
    if (column.size() != hits.count())
      refuse("channel " + std::string(channel.name) + " holds " + std::to_string(column.size()) + " of " +
             std::to_string(hits.count()) + " crossings");
  });
  const std::size_t objects = dataset.manifest.objects.size();
  for (const std::uint32_t id : hits.id)
    if (id < 1 || id > objects)
      refuse("a crossing names object " + std::to_string(id) + "; expected 1 to " + std::to_string(objects));
}

struct TextureMaker {
  TextureCache& cache;
  Texture operator()(const ColorTexture& color) const { return color; }
  Texture operator()(const CheckerboardTexture& board) const { return board; }
  Texture operator()(const ImageLook& image) const {
    auto pyramid = cache.get(image.file, image.pointer);
    if (image.mipmap) return MipmapTexture{std::move(pyramid), image.uv};
    return BilinearTexture{std::move(pyramid), image.uv};
  }
};

struct SpectrumMaker {
  Effects effects;
  Spectrum operator()(const DisplayLook&) const { return DisplaySpectrum{effects}; }
  Spectrum operator()(const BlackBodyLook& body) const {
    return BlackBodySpectrum(body.temperature_K, effects);
  }
};

}  // namespace

Renderer::Renderer(Dataset dataset) : dataset_(std::move(dataset)) { check_records(dataset_); }

std::size_t Renderer::add_appearance(Shading& shading, const AppearanceLook& look, Rgb fallback,
                                     Effects effects) {
  const SpectrumLook spectrum = look.spectrum.value_or(DisplayLook{});
  // A body that radiates by itself needs no colour; one that is shown as it is gets its flat one.
  const Rgb plain = std::holds_alternative<BlackBodyLook>(spectrum) ? Rgb{1, 1, 1} : fallback;
  const TextureLook texture = look.texture.value_or(ColorTexture{plain});
  shading.appearances.push_back(
      {std::visit(TextureMaker{textures_}, texture), std::visit(SpectrumMaker{effects}, spectrum)});
  return shading.appearances.size() - 1;
}

Shading Renderer::prepare(const Look& look) {
  Shading shading{{}, {}, look.background};
  for (std::uint32_t id = 1; id <= dataset_.manifest.objects.size(); ++id) {
    const ObjectEntry& entry = dataset_.manifest.objects[id - 1];
    const auto found = look.objects.find(entry.name);
    const ObjectLook object = found == look.objects.end() ? ObjectLook{} : found->second;
    const Rgb fallback = default_color(id);
    ObjectShading out{
        entry.tau_origin, add_appearance(shading, object.appearance, fallback, look.effects), {}};
    for (const TimeSliceLook& slice : object.time_slices) {
      AppearanceLook appearance = slice.appearance;
      if (!appearance.texture) appearance.texture = object.appearance.texture;
      if (!appearance.spectrum) appearance.spectrum = object.appearance.spectrum;
      out.slices.push_back({slice.own_clock, slice.from, slice.to,
                            add_appearance(shading, appearance, fallback, look.effects)});
    }
    shading.objects.push_back(std::move(out));
  }
  return shading;
}

Image Renderer::render(const Look& look) {
  // Step 1: textures and tables.
  Shading shading = prepare(look);
  // Step 2: shade, unless only the development changed.
  if (shaded_ != shading) {
    shaded_.reset();
    radiance_.display.assign(dataset_.pixels(), {});
    radiance_.physical.assign(has_physical(shading) ? dataset_.pixels() : 0, {});
    const int rows = dataset_.manifest.height, bands = (rows + kBandRows - 1) / kBandRows;
    tbb::parallel_for(tbb::blocked_range<int>(0, bands, 1), [&](const auto& range) {
      for (int band = range.begin(); band < range.end(); ++band)
        shade_rows(dataset_, shading, band * kBandRows, std::min(rows, (band + 1) * kBandRows), radiance_);
    });
    shaded_ = std::move(shading);
    textures_.prune();
  }
  // Step 3: develop.
  return develop(radiance_, dataset_.manifest.width, dataset_.manifest.height, look.develop);
}

}  // namespace nullcone::postrender
