#include "postrender/renderer.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
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
  if (dataset.manifest.width < 1 || dataset.manifest.lines < 1) refuse("an empty picture");
  if (hits.offset.size() != dataset.pixels() + 1 || hits.offset.front() != 0)
    refuse("expected one count of crossings a pixel");
  if (!std::ranges::is_sorted(hits.offset)) refuse("the counts of crossings run backwards");
  for_each_channel(
      [&](const ChannelInfo& channel, const auto& column) {
        if (column.size() != hits.count())
          refuse("channel " + std::string(channel.name) + " holds " + std::to_string(column.size()) + " of " +
                 std::to_string(hits.count()) + " crossings");
      },
      hits);
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
    return ImageTexture{std::move(pyramid), image.uv, image.mipmap};
  }
};

struct SpectrumMaker {
  Effects effects;
  Spectrum operator()(const DisplayLook&) const { return DisplaySpectrum{effects}; }
  Spectrum operator()(const BlackBodyLook& body) const {
    return BlackBodySpectrum{effects, body.temperature_K};
  }
};

}  // namespace

Renderer::Renderer(Dataset dataset, const Kernel& kernel) : dataset_(std::move(dataset)), kernel_(kernel) {
  check_records(dataset_);
  one_each_ = lines_with_one_each(dataset_);
}

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

/// Calls work(row) for all rows, with one worker made by `make_worker` a thread.
template <class MakeWorker>
void Renderer::for_each_row(MakeWorker&& make_worker) const {
  const int rows = dataset_.manifest.lines, bands = (rows + kBandRows - 1) / kBandRows;
  tbb::enumerable_thread_specific<decltype(make_worker())> workers(make_worker);
  tbb::parallel_for(tbb::blocked_range<int>(0, bands, 1), [&](const auto& range) {
    auto& work = workers.local();
    for (int row = range.begin() * kBandRows; row < std::min(rows, range.end() * kBandRows); ++row)
      work(static_cast<std::size_t>(row));
  });
}

void Renderer::keep_radiance(const Shading& shading) {
  const std::size_t width = static_cast<std::size_t>(dataset_.manifest.width);
  radiance_.display.resize(dataset_.pixels());
  radiance_.physical.resize(has_physical(shading) ? dataset_.pixels() : 0);
  for_each_row([&] {
    return
        [this, width, shader = LineShader(dataset_, one_each_, shading, kernel_)](std::size_t row) mutable {
          shader.shade(row, radiance_.display.data() + row * width,
                       radiance_.physical.empty() ? nullptr : radiance_.physical.data() + row * width);
        };
  });
}

void Renderer::develop_kept(const DevelopLook& look, Image& image) const {
  const std::size_t width = static_cast<std::size_t>(dataset_.manifest.width);
  for_each_row([&] {
    return [this, width, &image, developer = LineDeveloper(look, kernel_)](std::size_t row) mutable {
      developer.develop(radiance_.display.data() + row * width,
                        radiance_.physical.empty() ? nullptr : radiance_.physical.data() + row * width,
                        row * width, width, image);
    };
  });
}

void Renderer::shade_and_develop(const Shading& shading, const DevelopLook& look, Image& image) const {
  const std::size_t width = static_cast<std::size_t>(dataset_.manifest.width);
  const std::size_t physical_width = has_physical(shading) ? width : 0;
  for_each_row([&] {
    return [=, &image, shader = LineShader(dataset_, one_each_, shading, kernel_),
            developer = LineDeveloper(look, kernel_),
            line = Radiance{std::vector<Rgbx>(width), std::vector<Rgbx>(physical_width)}](
               std::size_t row) mutable {
      Rgbx* physical = line.physical.empty() ? nullptr : line.physical.data();
      shader.shade(row, line.display.data(), physical);
      developer.develop(line.display.data(), physical, row * width, width, image);
    };
  });
}

Image Renderer::render(const Look& look) {
  Image image;
  render(look, {}, image);
  return image;
}

void Renderer::render(const Look& look, const ImageParts& parts, Image& image) {
  // Step 1: textures and tables.
  Shading shading = prepare(look);
  set_size(image, dataset_.manifest.width, dataset_.manifest.lines, parts);
  // Step 2: shade line by line, unless only the development changed. Radiance is kept where the white must be
  // found in it, and from the second picture of the same shading on.
  const bool physical = has_physical(shading),
             white_known = !physical || look.develop.white_cd_m2.has_value();
  const bool same = shaded_ == shading;
  if (!same) kept_ = false;
  shaded_.reset();
  if (!kept_ && (same || !white_known)) {
    keep_radiance(shading);
    kept_ = true;
  }
  // Step 3: develop.
  image.white_cd_m2 = 1;
  if (physical) image.white_cd_m2 = white_known ? *look.develop.white_cd_m2 : auto_white_cd_m2(radiance_);
  if (kept_) {
    develop_kept(look.develop, image);
  } else {
    shade_and_develop(shading, look.develop, image);
  }
  if (!same) textures_.prune();
  shaded_ = std::move(shading);
}

}  // namespace nullcone::postrender
