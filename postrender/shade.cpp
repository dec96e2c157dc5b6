#include "postrender/shade.h"

#include <algorithm>
#include <limits>

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

Layer LineShader::Expanded::layer() const {
  return {id.data(), order.data(), u.data(), v.data(), shift.data(), opacity.data()};
}

LineShader::LineShader(const Dataset& dataset, const Shading& shading, const Kernel& kernel)
    : dataset_(dataset),
      shading_(shading),
      kernel_(kernel),
      width_(static_cast<std::size_t>(dataset.manifest.width)),
      height_(static_cast<std::size_t>(dataset.manifest.height)),
      appearance_(width_),
      transmittance_(width_),
      weight_(width_),
      steps_(3 * (width_ + 1)),
      colors_(width_) {
  const std::vector<std::uint32_t> numbers(width_);
  const std::vector<float> values(width_);
  nothing_ = {kNowhere, 0, numbers, numbers, values, values, values, values};
  expanded_.fill(nothing_);
  counts_.fill({kNowhere, false});
  footprints_.fill(values);
}

bool LineShader::one_each(std::size_t row) {
  Counts& counts = counts_[row % 3];
  if (counts.row == row) return counts.one_each;
  const std::uint64_t* offset = dataset_.hits.offset.data() + row * width_;
  std::uint64_t difference = 0;
  for (std::size_t i = 0; i <= width_; ++i) difference |= offset[i] - offset[0] - i;
  counts = {row, difference == 0};
  return counts.one_each;
}

Layer LineShader::layer(std::ptrdiff_t row, std::size_t rank) {
  if (row < 0 || row >= static_cast<std::ptrdiff_t>(height_)) return nothing_.layer();
  const Hits& hits = dataset_.hits;
  const std::size_t line = static_cast<std::size_t>(row);
  const std::uint64_t* offset = hits.offset.data() + line * width_;
  // Step 1: as they lie in the dataset, if they lie side by side.
  if (rank == 0 && one_each(line)) {
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
  if (one_each(row)) return rank == 0;
  const std::uint64_t* offset = dataset_.hits.offset.data() + row * width_;
  bool any = false;
  for (std::size_t i = 0; i < width_; ++i)
    any |= (offset[i] + rank < offset[i + 1]) & (transmittance_[i] > 0);
  return any;
}

/// How the crossings of one rank look, object by object along the line.
void LineShader::find_appearances(std::size_t row, std::size_t rank, const Layer& here) {
  const std::uint64_t* offset = dataset_.hits.offset.data() + row * width_;
  for (std::size_t first = 0, last = 0; first < width_; first = last) {
    const std::uint32_t id = here.id[first];
    while (last < width_ && here.id[last] == id) ++last;
    const ObjectShading* object = id == 0 ? nullptr : &shading_.objects[id - 1];
    const std::size_t usual = object == nullptr ? kUnseen : object->appearance;
    std::fill(appearance_.begin() + static_cast<std::ptrdiff_t>(first),
              appearance_.begin() + static_cast<std::ptrdiff_t>(last), static_cast<std::uint32_t>(usual));
    if (object == nullptr || object->slices.empty()) continue;
    for (std::size_t i = first; i < last; ++i)
      appearance_[i] = static_cast<std::uint32_t>(appearance_at(*object, dataset_.hits, offset[i] + rank));
  }
  kernel_.weigh(here.opacity, width_, transmittance_.data(), weight_.data(), appearance_.data());
}

void LineShader::estimate_footprints(std::size_t row, std::size_t rank) {
  const auto at = static_cast<std::ptrdiff_t>(row);
  kernel_.footprints(
      {layer(at - 1, rank), layer(at, rank), layer(at + 1, rank)}, width_,
      {footprints_[0].data(), footprints_[1].data(), footprints_[2].data(), footprints_[3].data()},
      steps_.data());
}

void LineShader::shade_run(const Appearance& appearance, const Run& run, Rgbx* display, Rgbx* physical) {
  std::visit(TextureColors{kernel_, run, colors_.data()}, appearance.texture);
  std::visit(SeenLight{kernel_, run, colors_.data(), display, physical}, appearance.spectrum);
}

void LineShader::shade(std::size_t row, Rgbx* display, Rgbx* physical) {
  std::fill_n(display, width_, Rgbx{});
  if (physical != nullptr) std::fill_n(physical, width_, Rgbx{});
  std::ranges::fill(transmittance_, 1.0f);
  for (std::size_t rank = 0; anything_seen(row, rank); ++rank) {
    const Layer here = layer(static_cast<std::ptrdiff_t>(row), rank);
    find_appearances(row, rank, here);
    bool estimated = false;
    for (std::size_t first = 0, last = 0; first < width_; first = last) {
      while (last < width_ && appearance_[last] == appearance_[first]) ++last;
      if (appearance_[first] == kUnseen) continue;
      const Appearance& appearance = shading_.appearances[appearance_[first]];
      if (!estimated && needs_footprint(appearance.texture)) {
        estimate_footprints(row, rank);
        estimated = true;
      }
      const auto from = [&](const float* column) { return column + first; };
      const auto step = [&](std::size_t i) { return footprints_[i].data() + first; };
      shade_run(appearance,
                {last - first,
                 from(here.u),
                 from(here.v),
                 from(here.shift),
                 from(weight_.data()),
                 {step(0), step(1), step(2), step(3)}},
                display + first, physical == nullptr ? nullptr : physical + first);
    }
  }
  kernel_.background(transmittance_.data(), shading_.background, width_, display);
}

}  // namespace nullcone::postrender
