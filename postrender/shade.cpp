#include "postrender/shade.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <span>

namespace nullcone::postrender {

namespace {

constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();

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

struct SeenLight {
  const Kernel& kernel;
  const Run& run;
  const Rgbx* colors;
  Rgbx *display, *physical;
  void operator()(const DisplaySpectrum& spectrum) const {
    kernel.display(spectrum.effects.searchlight, run, colors, display);
  }
  void operator()(const BlackBodySpectrum& body) const {
    const BlackBodyTable& table = BlackBodyTable::instance();
    kernel.black_body({table.nodes(), static_cast<float>(body.temperature_K), body.effects.doppler,
                       body.effects.searchlight, table.color_cd_m2(body.temperature_K)},
                      run, colors, physical);
  }
};

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

}  // namespace

bool has_physical(const Shading& shading) {
  return std::ranges::any_of(shading.appearances, [](const Appearance& appearance) {
    return std::holds_alternative<BlackBodySpectrum>(appearance.spectrum);
  });
}

std::vector<std::uint8_t> lines_with_one_each(const Dataset& dataset) {
  const auto width = static_cast<std::size_t>(dataset.manifest.width);
  std::vector<std::uint8_t> out;
  for (std::size_t line = 0; line < static_cast<std::size_t>(dataset.manifest.lines); ++line) {
    const std::uint64_t* offset = dataset.hits.offset.data() + line * width;
    std::uint64_t difference = 0;
    for (std::size_t i = 0; i <= width; ++i) difference |= offset[i] - offset[0] - i;
    out.push_back(difference == 0 ? 1 : 0);
  }
  return out;
}

Layer LineShader::Expanded::layer() const {
  return {id.data(), order.data(), u.data(), v.data(), shift.data(), opacity.data()};
}

LineShader::LineShader(const Dataset& dataset, std::span<const std::uint8_t> one_each, const Shading& shading,
                       const Kernel& kernel)
    : dataset_(dataset),
      one_each_(one_each),
      shading_(shading),
      kernel_(kernel),
      width_(static_cast<std::size_t>(dataset.manifest.width)),
      height_(static_cast<std::size_t>(dataset.manifest.lines)),
      appearance_(width_),
      transmittance_(width_),
      weight_(width_) {
  const std::vector<std::uint32_t> numbers(width_);
  const std::vector<float> values(width_);
  nothing_ = {kNowhere, 0, numbers, numbers, values, values, values, values};
  expanded_.fill(nothing_);
}

Layer LineShader::layer(std::ptrdiff_t row, std::size_t rank) {
  if (row < 0 || row >= static_cast<std::ptrdiff_t>(height_)) return nothing_.layer();
  const Hits& hits = dataset_.hits;
  const std::size_t line = static_cast<std::size_t>(row);
  const std::uint64_t* offset = hits.offset.data() + line * width_;
  // Step 1: as they lie in the dataset, if they lie side by side.
  if (rank == 0 && one_each_[line] != 0) {
    const std::size_t i = offset[0];
    return {&hits.id[i], &hits.order[i], &hits.u[i], &hits.v[i], &hits.shift[i], &hits.A[i]};
  }
  // Step 2: else side by side in a copy.
  Expanded& copy = expanded_[line % 3];
  if (copy.row == line && copy.rank == rank) return copy.layer();
  copy.row = line;
  copy.rank = rank;
  for (std::size_t i = 0; i < width_; ++i) {
    const std::size_t hit = offset[i] + rank;
    const bool there = hit < offset[i + 1];
    copy.id[i] = there ? hits.id[hit] : 0;
    copy.order[i] = there ? hits.order[hit] : 0;
    copy.u[i] = there ? hits.u[hit] : 0;
    copy.v[i] = there ? hits.v[hit] : 0;
    copy.shift[i] = there ? hits.shift[hit] : 0;
    copy.opacity[i] = there ? hits.A[hit] : 0;
  }
  return copy.layer();
}

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
    const std::size_t usual = object == nullptr ? kUnseen : object->appearance;
    std::fill(appearance_.begin() + static_cast<std::ptrdiff_t>(first),
              appearance_.begin() + static_cast<std::ptrdiff_t>(last), static_cast<std::uint32_t>(usual));
    if (object == nullptr || object->slices.empty()) continue;
    for (std::size_t i = first; i < last; ++i)
      appearance_[i] = static_cast<std::uint32_t>(appearance_at(*object, dataset_.hits, offset[i] + rank));
  }
  return kernel_.weigh(here.opacity, width_, transmittance_.data(), weight_.data(), appearance_.data());
}

/// Pixels [first, first + count) of the middle one of three lines, at most kSegment.
void LineShader::shade_segment(const std::array<Layer, 3>& lines, const Appearance& appearance,
                               std::size_t first, std::size_t count, Rgbx* display, Rgbx* physical) {
  const Layer& here = lines[1];
  const Footprints steps = {footprints_[0].data(), footprints_[1].data(), footprints_[2].data(),
                            footprints_[3].data()};
  if (needs_footprint(appearance.texture)) kernel_.footprints(lines, width_, first, count, steps);
  const Run run = {count, here.u + first, here.v + first, here.shift + first, weight_.data() + first, steps};
  std::visit(TextureColors{kernel_, run, colors_.data()}, appearance.texture);
  std::visit(SeenLight{kernel_, run, colors_.data(), display + first,
                       physical == nullptr ? nullptr : physical + first},
             appearance.spectrum);
}

/// The crossings of one rank. Lines above and below are looked at for footprints only.
void LineShader::shade_rank(std::size_t row, std::size_t rank, const Layer& here, Rgbx* display,
                            Rgbx* physical) {
  std::array<Layer, 3> lines = {here, here, here};
  bool around = false;
  for (std::size_t first = 0, last = 0; first < width_; first = last) {
    last = end_of_run(appearance_, first);
    if (appearance_[first] == kUnseen) continue;
    const Appearance& appearance = shading_.appearances[appearance_[first]];
    if (!around && needs_footprint(appearance.texture)) {
      const auto at = static_cast<std::ptrdiff_t>(row);
      lines = {layer(at - 1, rank), here, layer(at + 1, rank)};
      around = true;
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
    const Layer here = layer(static_cast<std::ptrdiff_t>(row), rank);
    shines_through = find_appearances(row, rank, here);
    shade_rank(row, rank, here, display, physical);
  }
  if (shines_through) kernel_.background(transmittance_.data(), shading_.background, width_, display);
}

}  // namespace nullcone::postrender
