#include "postrender/shade.h"

#include <algorithm>
#include <cstring>
#include <span>

namespace nullcone::postrender {

namespace {

std::size_t appearance_at(const ObjectShading& object, const Hits& hits, std::size_t hit) {
  for (const Slice& slice : object.slices) {
    const double time = slice.own_clock ? static_cast<double>(hits.tau[hit]) + object.tau_origin
                                        : static_cast<double>(hits.t[hit]);
    if (time >= slice.from && time < slice.to) return slice.appearance;
  }
  return object.appearance;
}

struct TextureColors {
  const Kernel& kernel;
  const Run& run;
  Rgbx* out;
  void operator()(const ColorTexture& texture) const { std::fill_n(out, run.count, Rgbx{texture.color}); }
  void operator()(const CheckerboardTexture& texture) const { kernel.checkerboard(texture, run, out); }
  void operator()(const ImageTexture& texture) const {
    const Pyramid& image = *texture.image;
    kernel.image({image.levels.data(), static_cast<float>(image.levels.size() - 1), image.texels.data(),
                  image.unit, texture.uv, texture.mipmap},
                 run, out);
  }
};

void add_light(const Kernel& kernel, const Light& light, const Lit& lit) {
  if (!light.table) return kernel.plain(lit);
  const TableView table = light.table->view();
  (table.stride == 1 ? kernel.filtered : kernel.mixed)(table, lit);
  if (!light.lines) return;
  const LineTable& lines = *light.lines;
  kernel.lines({lines.lines.data(), lines.lines.size(), lines.first_nm, 1 / lines.step_nm,
                static_cast<double>(lines.response.size() - 1), lines.response.data(), lines.power->view()},
               lit);
}

/// Where the run of equal values that begins at `first` ends.
std::size_t end_of_run(std::span<const std::uint32_t> values, std::size_t first) {
  constexpr std::size_t kStride = 16;
  const std::uint32_t value = values[first];
  std::size_t last = first;
  for (std::uint32_t difference = 0; last + kStride <= values.size(); last += kStride) {
    for (std::size_t i = 0; i < kStride; ++i) difference |= values[last + i] ^ value;
    if (difference != 0) break;
  }
  while (last < values.size() && values[last] == value) ++last;
  return last;
}

bool needs_footprint(const Texture& texture) {
  if (const auto* image = std::get_if<ImageTexture>(&texture)) return image->mipmap;
  return std::holds_alternative<CheckerboardTexture>(texture);
}

bool has_alpha(const Texture& texture) {
  const auto* image = std::get_if<ImageTexture>(&texture);
  return image != nullptr && image->alpha;
}

bool lets_light_through(const Appearance& appearance) {
  return appearance.opacity != 1 || has_alpha(appearance.texture);
}

}  // namespace

bool has_physical(const Shading& shading) {
  return std::ranges::any_of(shading.appearances,
                             [](const Appearance& appearance) { return appearance.light.physical; });
}

LineShader::LineShader(const Dataset& dataset, std::span<const std::uint8_t> one_each, const Shading& shading,
                       const Kernel& kernel)
    : dataset_(dataset),
      one_each_(one_each),
      shading_(shading),
      kernel_(kernel),
      layers_(dataset, one_each),
      see_through_(std::ranges::any_of(shading.appearances, lets_light_through)),
      width_(static_cast<std::size_t>(dataset.manifest.width)),
      appearance_(width_),
      transmittance_(width_),
      weight_(width_),
      opacity_(see_through_ ? width_ : 0),
      clear_colors_(see_through_ ? width_ : 0) {}

bool LineShader::anything_seen(std::size_t row, std::size_t rank) {
  if (one_each_[row] != 0) return rank == 0;
  const std::uint64_t* offset = dataset_.hits.offset.data() + row * width_;
  bool any = false;
  for (std::size_t i = 0; i < width_; ++i)
    any |= (offset[i] + rank < offset[i + 1]) & (transmittance_[i] > 0);
  return any;
}

/// How the crossings of one rank look, object by object along the line. False if nothing shines through.
bool LineShader::find_appearances(std::size_t row, std::size_t rank, const Layer& here) {
  const std::uint64_t* offset = dataset_.hits.offset.data() + row * width_;
  for (std::size_t first = 0, last = 0; first < width_; first = last) {
    const std::uint32_t id = here.id[first];
    last = end_of_run({here.id, width_}, first);
    const ObjectShading* object = id == 0 ? nullptr : &shading_.objects[id - 1];
    const bool seen = object != nullptr && shading_.appearances[object->appearance].opacity > 0;
    const std::size_t usual = seen ? object->appearance : kUnseen;
    std::fill(appearance_.begin() + static_cast<std::ptrdiff_t>(first),
              appearance_.begin() + static_cast<std::ptrdiff_t>(last), static_cast<std::uint32_t>(usual));
    if (!seen || object->slices.empty()) continue;
    for (std::size_t i = first; i < last; ++i)
      appearance_[i] = static_cast<std::uint32_t>(appearance_at(*object, dataset_.hits, offset[i] + rank));
  }
  if (see_through_) find_opacities(row, rank, here);
  return kernel_.weigh(see_through_ ? opacity_.data() : here.opacity, width_, transmittance_.data(),
                       weight_.data(), appearance_.data());
}

/// Opacities of one rank: as recorded, times the object's, times the texture's alpha. Where there is alpha,
/// colours are looked up here, and kept.
void LineShader::find_opacities(std::size_t row, std::size_t rank, const Layer& here) {
  std::copy_n(here.opacity, width_, opacity_.begin());
  for (std::size_t first = 0, last = 0; first < width_; first = last) {
    last = end_of_run(appearance_, first);
    if (appearance_[first] == kUnseen) continue;
    const Appearance& appearance = shading_.appearances[appearance_[first]];
    for (std::size_t i = first; i < last; ++i) opacity_[i] *= appearance.opacity;
    if (!has_alpha(appearance.texture)) continue;
    const std::array<Layer, 3> lines = layers_.around(row, rank, here);
    for (std::size_t from = first; from < last; from += kSegment)
      look_up(lines, appearance, from, std::min(kSegment, last - from), &clear_colors_[from]);
    for (std::size_t i = first; i < last; ++i) {
      Rgbx& color = clear_colors_[i];
      const float alpha = color.idle;
      opacity_[i] *= alpha;
      // Back to the colour of what is there: the weight brings the opacity in again.
      color = alpha > 0 ? Rgbx{color.r / alpha, color.g / alpha, color.b / alpha} : Rgbx{};
    }
  }
}

/// The texture's colours of pixels [first, first + count) of the middle one of three lines, at most kSegment.
void LineShader::look_up(const std::array<Layer, 3>& lines, const Appearance& appearance, std::size_t first,
                         std::size_t count, Rgbx* out) {
  const Layer& here = lines[1];
  const Footprints steps = {footprints_[0].data(), footprints_[1].data(), footprints_[2].data(),
                            footprints_[3].data()};
  if (needs_footprint(appearance.texture)) {
    if (layers_.recorded_steps()) {
      kernel_.recorded_footprints(here, first, count, steps);
    } else {
      kernel_.footprints(lines, width_, first, count, steps);
    }
  }
  const Run run = {count, here.u + first, here.v + first, here.shift + first, weight_.data() + first, steps};
  std::visit(TextureColors{kernel_, run, out}, appearance.texture);
}

void LineShader::shade_segment(const std::array<Layer, 3>& lines, const Appearance& appearance,
                               std::size_t first, std::size_t count, Rgbx* display, Rgbx* physical) {
  const Layer& here = lines[1];
  const bool known = has_alpha(appearance.texture);
  if (!known) look_up(lines, appearance, first, count, colors_.data());
  Rgbx* sum = appearance.light.physical ? physical : display;
  add_light(kernel_, appearance.light,
            {count, here.shift + first, weight_.data() + first,
             known ? &clear_colors_[first] : colors_.data(), sum + first});
}

/// The crossings of one rank. Lines above and below are looked at for footprints only.
void LineShader::shade_rank(std::size_t row, std::size_t rank, const Layer& here, Rgbx* display,
                            Rgbx* physical) {
  std::array<Layer, 3> lines = {here, here, here};
  bool ready = false;
  for (std::size_t first = 0, last = 0; first < width_; first = last) {
    last = end_of_run(appearance_, first);
    if (appearance_[first] == kUnseen) continue;
    const Appearance& appearance = shading_.appearances[appearance_[first]];
    if (!ready && needs_footprint(appearance.texture)) {
      lines = layers_.around(row, rank, here);
      ready = true;
    }
    for (std::size_t from = first; from < last; from += kSegment)
      shade_segment(lines, appearance, from, std::min(kSegment, last - from), display, physical);
  }
}

void LineShader::shade(std::size_t row, Rgbx* display, Rgbx* physical) {
  for (Rgbx* sum : {display, physical})
    if (sum != nullptr) std::memset(static_cast<void*>(sum), 0, width_ * sizeof(Rgbx));
  std::ranges::fill(transmittance_, 1.0f);
  bool shines_through = true;
  for (std::size_t rank = 0; shines_through && anything_seen(row, rank); ++rank) {
    const Layer here = layers_.at(static_cast<std::ptrdiff_t>(row), rank);
    shines_through = find_appearances(row, rank, here);
    shade_rank(row, rank, here, display, physical);
  }
  if (shines_through) kernel_.background(transmittance_.data(), shading_.background, width_, display);
}

}  // namespace nullcone::postrender
