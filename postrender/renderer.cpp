#include "postrender/renderer.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/base/error.h"
#include "postrender/color.h"
#include "postrender/develop.h"
#include "postrender/exposure.h"
#include "postrender/needed_channels.h"
#include "postrender/sample_grid.h"
#include "postrender/texture_maker.h"

namespace nullcone::postrender {

namespace {

constexpr int kBandRows = 16;

/// Calls work(row) for all rows, with one worker made by `make_worker` a thread.
template <class MakeWorker>
void for_each_row(int rows, MakeWorker&& make_worker) {
  const int bands = (rows + kBandRows - 1) / kBandRows;
  tbb::enumerable_thread_specific<decltype(make_worker())> workers(make_worker);
  tbb::parallel_for(tbb::blocked_range<int>(0, bands, 1), [&](const auto& range) {
    auto& work = workers.local();
    for (int row = range.begin() * kBandRows; row < std::min(rows, range.end() * kBandRows); ++row)
      work(static_cast<std::size_t>(row));
  });
}

/// A scan line of what may be left out.
template <class Pixels>
auto* line_of(Pixels& pixels, std::size_t row, std::size_t width) {
  return pixels.empty() ? nullptr : pixels.data() + row * width;
}

/// Everything that the pixel loop takes for granted.
const Dataset& check_records(const Dataset& dataset) {
  const Hits& hits = dataset.hits;
  const auto refuse = [](const std::string& message) { throw InputError("dataset", message); };
  for (const std::string_view channel : {"A", "id"})
    if (!hits.channels.has(channel)) refuse("has no channel '" + std::string(channel) + "'");
  if (dataset.manifest.samples < 1) refuse("expected at least one sample a pixel");
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
  const Manifest& manifest = dataset.manifest;
  const bool paths =
      manifest.light_paths >= 0 &&
      hits.light.size() == manifest.lights.size() * static_cast<std::size_t>(manifest.light_paths);
  if ((hits.channels.has("light") || !hits.light.empty()) && !paths)
    refuse("expected the light of each path of each lamp");
  const std::size_t objects = manifest.objects.size();
  for (const std::uint32_t id : hits.id)
    if (id < 1 || id > objects)
      refuse("a crossing names object " + std::to_string(id) + "; expected 1 to " + std::to_string(objects));
  return dataset;
}

}  // namespace

std::shared_ptr<const Renderer::Source> Renderer::make_source(Dataset dataset) {
  Manifest manifest = check_records(dataset).manifest;
  dataset = by_samples(std::move(dataset));
  std::vector<std::uint8_t> one_each = lines_with_one_each(dataset);
  std::vector<ShiftRange> shifts = shift_ranges(dataset);
  std::vector<std::vector<LightShifts>> light_shifts = light_shift_ranges(dataset);
  return std::make_shared<const Source>(Source{std::move(manifest), std::move(dataset), std::move(one_each),
                                               std::move(shifts), std::move(light_shifts)});
}

Renderer::Renderer(Dataset dataset, const Kernel& kernel, std::shared_ptr<TextureCache> textures)
    : Renderer(make_source(std::move(dataset)), kernel, std::move(textures), std::make_shared<StarCache>()) {}

Renderer::Renderer(std::shared_ptr<const Source> source, const Kernel& kernel,
                   std::shared_ptr<TextureCache> textures, std::shared_ptr<StarCache> stars)
    : source_(std::move(source)),
      manifest_(source_->manifest),
      dataset_(source_->dataset),
      one_each_(source_->one_each),
      shifts_(source_->shifts),
      light_shifts_(source_->light_shifts),
      kernel_(kernel),
      textures_(std::move(textures)),
      stars_(std::move(stars)) {}

void Renderer::keep_radiance(const Shading& shading) {
  const std::size_t width = static_cast<std::size_t>(dataset_.manifest.width);
  const bool physical = has_physical(shading), display = !physical || has_display(shading);
  radiance_.display.resize(display ? dataset_.pixels() : 0);
  radiance_.physical.resize(physical ? dataset_.pixels() : 0);
  visible_.resize(shading.stars.empty() ? 0 : dataset_.pixels());
  begin_keeping();
  for_each_row(dataset_.manifest.lines, [&] {
    return
        [this, width, shader = LineShader(dataset_, one_each_, shading, kernel_)](std::size_t row) mutable {
          shader.shade(row, line_of(radiance_.display, row, width), line_of(radiance_.physical, row, width),
                       kept_colors(row), line_of(visible_, row, width));
        };
  });
  end_keeping();
  draw_stars(shading);
}

/// Points before what has been shaded; their spots are as wide as they are, whatever the pixel filter.
void Renderer::draw_stars(const Shading& shading) {
  for (const StarShading& stars : shading.stars)
    add_stars(kernel_, stars, *stars_->images(stars.field, stars.id, dataset_, manifest_), visible_,
              manifest_.width, radiance_.physical);
}

/// The radiance of pixels from that of their samples: first along the lines, then down the columns.
void Renderer::keep_filtered(const Shading& shading, const PixelFilter& filter) {
  const auto width = static_cast<std::size_t>(manifest_.width);
  const auto wide = static_cast<std::size_t>(dataset_.manifest.width);
  const bool physical = has_physical(shading);
  visible_.resize(shading.stars.empty() ? 0 : dataset_.pixels());
  const std::size_t narrowed = width * static_cast<std::size_t>(dataset_.manifest.lines);
  Radiance lines{std::vector<Rgbx>(narrowed), std::vector<Rgbx>(physical ? narrowed : 0)};
  const FilterTable across(filter, manifest_.width, manifest_.samples),
      down(filter, manifest_.lines, manifest_.samples);
  for_each_row(dataset_.manifest.lines, [&] {
    return [&, width, shader = LineShader(dataset_, one_each_, shading, kernel_),
            line = Radiance{std::vector<Rgbx>(wide), std::vector<Rgbx>(physical ? wide : 0)}](
               std::size_t row) mutable {
      shader.shade(row, line.display.data(), physical ? line.physical.data() : nullptr, {},
                   line_of(visible_, row, wide));
      filter_line(across, line.display.data(), lines.display.data() + row * width);
      if (physical) filter_line(across, line.physical.data(), lines.physical.data() + row * width);
    };
  });
  radiance_.display.resize(manifest_.pixels());
  radiance_.physical.resize(physical ? manifest_.pixels() : 0);
  for_each_row(manifest_.lines, [&] {
    return [&, width](std::size_t row) {
      filter_columns(down, row, lines.display.data(), width, radiance_.display.data() + row * width);
      if (physical)
        filter_columns(down, row, lines.physical.data(), width, radiance_.physical.data() + row * width);
    };
  });
  draw_stars(shading);
}

void Renderer::develop_kept(const DevelopLook& look, Image& image) const {
  const std::size_t width = static_cast<std::size_t>(manifest_.width);
  for_each_row(manifest_.lines, [&] {
    return [this, width, &image, developer = LineDeveloper(look, kernel_)](std::size_t row) mutable {
      developer.develop(line_of(radiance_.display, row, width), line_of(radiance_.physical, row, width),
                        row * width, width, image);
    };
  });
}

void Renderer::shade_and_develop(const Shading& shading, const DevelopLook& look, Image& image) {
  const std::size_t width = static_cast<std::size_t>(dataset_.manifest.width);
  const std::size_t physical_width = has_physical(shading) ? width : 0,
                    display_width = physical_width == 0 || has_display(shading) ? width : 0;
  begin_keeping();
  for_each_row(manifest_.lines, [&] {
    return [=, this, &image, shader = LineShader(dataset_, one_each_, shading, kernel_),
            developer = LineDeveloper(look, kernel_),
            line = Radiance{std::vector<Rgbx>(display_width), std::vector<Rgbx>(physical_width)}](
               std::size_t row) mutable {
      Rgbx *physical = line.physical.empty() ? nullptr : line.physical.data(),
           *display = line.display.empty() ? nullptr : line.display.data();
      shader.shade(row, display, physical, kept_colors(row));
      developer.develop(display, physical, row * width, width, image);
    };
  });
  end_keeping();
}

void Renderer::begin_keeping() {
  if (keeping_ == Keeping::wanted) colors_.resize(dataset_.pixels());
}
void Renderer::end_keeping() {
  if (keeping_ == Keeping::wanted) keeping_ = Keeping::known;
}
/// Where the colours of a line stand, or shall stand.
KeptColors Renderer::kept_colors(std::size_t row) {
  if (keeping_ == Keeping::no || one_each_[row] == 0) return {};
  const auto width = static_cast<std::size_t>(dataset_.manifest.width);
  return {colors_.data() + row * width, keeping_ == Keeping::known};
}

/// Colours of textures are worth their memory from the second picture of the same textures on.
void Renderer::decide_keeping(const Shading& shading) {
  constexpr std::size_t kMostPixels = std::size_t{1} << 24;
  const bool again = shaded_ && same_textures(*shaded_, shading) && keeps_colors(shading) &&
                     dataset_.pixels() <= kMostPixels;
  if (!again) keeping_ = Keeping::no;
  if (again && keeping_ == Keeping::no) keeping_ = Keeping::wanted;
}

Image Renderer::render(const Look& look) {
  Image image;
  render(look, {}, image);
  return image;
}

void Renderer::render(const Look& look, const ImageParts& parts, Image& image) {
  // Step 1: textures and tables.
  Shading shading = prepare(look);
  set_size(image, manifest_.width, manifest_.lines, parts);
  image.output = look.develop.output;
  // Step 2: shade line by line, unless only the development changed. Radiance is kept where the white must be
  // found in it, where pixels take in several samples, where there are stars, and from the second picture of
  // the same shading on.
  const bool physical = has_physical(shading),
             white_known = !physical || look.develop.white_cd_m2.has_value();
  const bool same = shaded_ == shading && filter_ == look.pixel_filter;
  const bool filtered = !is_identity(look.pixel_filter, manifest_.samples);
  if (!same) kept_ = false;
  decide_keeping(shading);
  shaded_.reset();
  if (!kept_ && (same || !white_known || filtered || !shading.stars.empty())) {
    if (filtered) {
      keep_filtered(shading, look.pixel_filter);
    } else {
      keep_radiance(shading);
    }
    kept_ = true;
  }
  // Step 3: develop.
  image.white_cd_m2 = 1;
  if (physical)
    image.white_cd_m2 =
        white_known ? *look.develop.white_cd_m2 : auto_white_cd_m2(radiance_, look.develop.auto_white);
  if (kept_) {
    develop_kept(look.develop, image);
  } else {
    shade_and_develop(shading, look.develop, image);
  }
  if (!same) {
    textures_->prune();
    lights_.prune();
    reflections_.prune();
  }
  filter_ = look.pixel_filter;
  shaded_ = std::move(shading);
  if (!same) stars_->prune();
}

}  // namespace nullcone::postrender
