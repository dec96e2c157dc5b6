#include "postrender/shade.h"

#include <algorithm>
#include <cstring>
#include <span>

namespace nullcone::postrender {

namespace {

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

}  // namespace

LineShader::LineShader(const Dataset& dataset, std::span<const std::uint8_t> one_each, const Shading& shading,
                       const Kernel& kernel)
    : dataset_(dataset),
      one_each_(one_each),
      shading_(shading),
      kernel_(kernel),
      layers_(dataset, one_each),
      illumination_(dataset, one_each, shading, kernel),
      layered_(std::ranges::any_of(shading.appearances, has_own_weight) ||
               std::ranges::any_of(shading.objects, &ObjectShading::blends)),
      clocks_(clocks_of(shading)),
      width_(static_cast<std::size_t>(dataset.manifest.width)),
      transmittance_(width_),
      opacity_(layered_ ? width_ : 0),
      parts_(layered_ ? width_ : 0),
      times_(clocks_.any() ? width_ : 0) {
  pass_at(0);
}

bool LineShader::anything_seen(std::size_t row, std::size_t rank) {
  if (one_each_[row] != 0) return rank == 0;
  const std::uint64_t* offset = dataset_.hits.offset.data() + row * width_;
  bool any = false;
  for (std::size_t i = 0; i < width_; ++i)
    any |= (offset[i] + rank < offset[i + 1]) & (transmittance_[i] > 0);
  return any;
}

/// The pass of this number, in which no pixel shows anything if it is a new one of this rank.
LineShader::Pass& LineShader::pass_at(std::size_t number) {
  if (number >= passes_.size()) {
    const std::size_t more = layered_ ? width_ : 0;
    passes_.push_back({std::vector<std::uint32_t>(width_), std::vector<float>(width_),
                       std::vector<float>(more), std::vector<Rgbx>(more)});
  }
  if (number >= used_) {
    std::ranges::fill(passes_[number].appearance, kUnseen);
    used_ = number + 1;
  }
  return passes_[number];
}

/// When the crossings of one rank emitted their light.
void LineShader::find_times(std::size_t row, std::size_t rank, const Layer& here) {
  const std::uint64_t* offset = dataset_.hits.offset.data() + row * width_;
  const Hits& hits = dataset_.hits;
  for (std::size_t i = 0; i < width_; ++i) {
    if (here.id[i] == 0) continue;
    const std::size_t hit = offset[i] + rank;
    if (clocks_.t) times_[i].t = static_cast<double>(hits.t[hit]);
    if (clocks_.tau)
      times_[i].tau = static_cast<double>(hits.tau[hit]) + shading_.objects[here.id[i] - 1].tau_origin;
  }
}

std::span<const Times> LineShader::times_of(std::size_t first, std::size_t count) const {
  return clocks_.any() ? std::span(times_).subspan(first, count) : std::span<const Times>();
}

/// Of pixels [first, last), which see one object.
void LineShader::find_coats_of(const ObjectShading& object, std::size_t first, std::size_t last) {
  Coats coats;
  for (std::size_t i = first; i < last; ++i) {
    const std::size_t count = find_coats(object, clocks_.any() ? times_[i] : Times{}, coats);
    for (std::size_t k = 0; k < count; ++k) {
      Pass& pass = pass_at(k);
      pass.appearance[i] = coats[k].appearance;
      if (layered_) pass.part[i] = coats[k].share;
    }
  }
}

/// How the crossings of one rank look, object by object along the line. False if nothing shines through.
bool LineShader::find_appearances(std::size_t row, std::size_t rank, const Layer& here) {
  if (clocks_.any()) find_times(row, rank, here);
  used_ = 1;
  bool hidden = false;
  std::vector<std::uint32_t>& appearances = passes_[0].appearance;
  if (layered_) std::ranges::fill(passes_[0].part, 1.0f);
  for (std::size_t first = 0, last = 0; first < width_; first = last) {
    const std::uint32_t id = here.id[first];
    last = end_of_run({here.id, width_}, first);
    const ObjectShading* object = id == 0 ? nullptr : &shading_.objects[id - 1];
    const bool seen = object != nullptr && shading_.appearances[object->appearance].opacity > 0;
    const std::size_t usual = seen ? object->appearance : kUnseen;
    std::fill(appearances.begin() + static_cast<std::ptrdiff_t>(first),
              appearances.begin() + static_cast<std::ptrdiff_t>(last), static_cast<std::uint32_t>(usual));
    if (seen && !object->plain()) find_coats_of(*object, first, last);
    hidden |= !seen;
  }
  Pass& pass = passes_[0];
  if (!layered_ && one_each_[row] == kOneOpaqueEach && !hidden) {
    if (!whole_weights_) std::ranges::fill(pass.weight, 1.0f);
    whole_weights_ = true;
    note_visible(here);
    return false;
  }
  whole_weights_ = false;
  if (layered_) find_opacities(row, rank, here);
  const bool through = kernel_.weigh(layered_ ? opacity_.data() : here.opacity, width_, transmittance_.data(),
                                     pass.weight.data(), pass.appearance.data());
  note_visible(here);
  if (layered_) share_weights();
  return through;
}

/// Opacities of one rank: as recorded, times what all coats together have.
void LineShader::find_opacities(std::size_t row, std::size_t rank, const Layer& here) {
  std::ranges::fill(parts_, 0.0f);
  for (std::size_t k = 0; k < used_; ++k) find_parts(passes_[k], row, rank, here);
  for (std::size_t i = 0; i < width_; ++i) opacity_[i] = here.opacity[i] * parts_[i];
}

/// Shares turn into parts: times the object's opacity, at its time, times the texture's alpha.
void LineShader::find_parts(Pass& pass, std::size_t row, std::size_t rank, const Layer& here) {
  for (std::size_t first = 0, last = 0; first < width_; first = last) {
    last = end_of_run(pass.appearance, first);
    if (pass.appearance[first] == kUnseen) continue;
    const Appearance& appearance = shading_.appearances[pass.appearance[first]];
    for (std::size_t i = first; i < last; ++i) pass.part[i] *= appearance.opacity;
    if (appearance.changes)
      for (std::size_t i = first; i < last; ++i)
        pass.part[i] *= static_cast<float>(appearance.emission.opacity_at(time_at(i)));
    if (has_alpha(appearance.texture)) find_alpha(pass, layers_.around(row, rank, here), first, last);
    for (std::size_t i = first; i < last; ++i) parts_[i] += pass.part[i];
  }
}

/// Where there is alpha, colours are looked up before opacities are known, and kept.
void LineShader::find_alpha(Pass& pass, const std::array<Layer, 3>& lines, std::size_t first,
                            std::size_t last) {
  const Appearance& appearance = shading_.appearances[pass.appearance[first]];
  for (std::size_t from = first; from < last; from += kSegment)
    look_up(lines, appearance.texture, from, std::min(kSegment, last - from), &pass.clear[from]);
  for (std::size_t i = first; i < last; ++i) {
    Rgbx& color = pass.clear[i];
    const float alpha = color.idle;
    pass.part[i] *= alpha;
    // Back to the colour of what is there: the weight brings the opacity in again.
    color = alpha > 0 ? Rgbx{color.r / alpha, color.g / alpha, color.b / alpha} : Rgbx{};
  }
}

/// Of pixels that see a sky with stars in this rank.
void LineShader::note_visible(const Layer& here) {
  if (visible_ == nullptr) return;
  const Pass& pass = passes_[0];
  for (const StarShading& stars : shading_.stars)
    for (std::size_t i = 0; i < width_; ++i)
      if (here.id[i] == stars.id && pass.appearance[i] != kUnseen) visible_[i] = pass.weight[i];
}

/// Every coat gets its part of the weight of its pixel, times how bright it is at its time.
void LineShader::share_weights() {
  for (std::size_t k = used_; k-- > 0;) {  // the first one last: it holds the whole weights
    Pass& pass = passes_[k];
    for (std::size_t i = 0; i < width_; ++i) {
      if (passes_[0].appearance[i] == kUnseen) pass.appearance[i] = kUnseen;
      if (pass.appearance[i] == kUnseen) continue;
      const float part = parts_[i] > 0 ? pass.part[i] / parts_[i] : 0.0f;
      const Appearance& appearance = shading_.appearances[pass.appearance[i]];
      const double intensity = appearance.changes ? appearance.emission.intensity_at(time_at(i)) : 1;
      pass.weight[i] = passes_[0].weight[i] * (part * static_cast<float>(intensity));
    }
  }
}

/// The texture's colours of pixels [first, first + count) of the middle one of three lines, at most kSegment.
void LineShader::look_up(const std::array<Layer, 3>& lines, const Texture& texture, std::size_t first,
                         std::size_t count, Rgbx* out) {
  const Layer& here = lines[1];
  const Footprints steps = {footprints_[0].data(), footprints_[1].data(), footprints_[2].data(),
                            footprints_[3].data()};
  if (needs_footprint(texture)) {
    if (layers_.recorded_steps()) {
      kernel_.recorded_footprints(here, first, count, steps);
    } else {
      kernel_.footprints(lines, width_, first, count, steps);
    }
  }
  const Run run = {count, here.u + first, here.v + first, nullptr, nullptr, steps};
  postrender::look_up(kernel_, texture, run, times_of(first, count), layers_.recorded_steps(), out);
}

/// With a factor on its weights.
Lit LineShader::dimmed(Lit lit, float factor) {
  if (factor == 1) return lit;
  for (std::size_t i = 0; i < lit.count; ++i) light_[i] = factor * lit.weight[i];
  lit.weight = light_.data();
  return lit;
}

void LineShader::shade_segment(const std::array<Layer, 3>& lines, const Pass& pass, const RunPlace& place,
                               std::size_t count, Rgbx* display, Rgbx* physical) {
  const Layer& here = lines[1];
  const std::size_t first = place.first;
  const Appearance& appearance = shading_.appearances[pass.appearance[first]];
  const bool known = has_alpha(appearance.texture);
  Rgbx* found = kept_.line != nullptr ? kept_.line + first : colors_.data();
  if (!known && !kept_.known) look_up(lines, appearance.texture, first, count, found);
  const Rgbx* colors = known ? &pass.clear[first] : found;
  Lit lit = {count, here.shift + first, pass.weight.data() + first, colors,
             (appearance.light.physical ? physical : display) + first};
  if (appearance.changes && appearance.emission.temperature) {
    for (std::size_t i = 0; i < count; ++i) {
      const SeenReference seen =
          seen_reference(*appearance.emission.temperature, time_at(first + i), lit.g[i]);
      shift_[i] = seen.shift;
      constexpr double kMost = 1e30;  // beyond, 0 times infinity would be no number
      light_[i] = static_cast<float>(std::min(static_cast<double>(lit.weight[i]) * seen.factor, kMost));
    }
    lit.g = shift_.data();
    lit.weight = light_.data();
  }
  if (!appearance.reflections.empty()) illumination_.add(appearance, place, lit, {display, physical});
  if (appearance.own_light > 0) add_light(kernel_, appearance.light, dimmed(lit, appearance.own_light));
  for (const Appearance::Component& component : appearance.more) {
    look_up(lines, component.texture, first, count, colors_.data());
    lit.colors = colors_.data();
    add_light(kernel_, component.light, lit);
  }
}

/// One coat of the crossings of one rank. Lines above and below are looked at for footprints only.
void LineShader::shade_pass(const Pass& pass, std::size_t row, std::size_t rank, const Layer& here,
                            Rgbx* display, Rgbx* physical) {
  std::array<Layer, 3> lines = {here, here, here};
  bool ready = false;
  for (std::size_t first = 0, last = 0; first < width_; first = last) {
    last = end_of_run(pass.appearance, first);
    if (pass.appearance[first] == kUnseen) continue;
    if (!ready && !kept_.known && needs_footprint(shading_.appearances[pass.appearance[first]].texture)) {
      lines = layers_.around(row, rank, here);
      ready = true;
    }
    for (std::size_t from = first; from < last; from += kSegment)
      shade_segment(lines, pass, {row, rank, from}, std::min(kSegment, last - from), display, physical);
  }
}

void LineShader::shade(std::size_t row, Rgbx* display, Rgbx* physical, KeptColors kept, float* visible) {
  kept_ = kept;
  visible_ = visible;
  if (visible != nullptr) std::fill_n(visible, width_, 0.0f);
  for (Rgbx* sum : {display, physical})
    if (sum != nullptr) std::memset(static_cast<void*>(sum), 0, width_ * sizeof(Rgbx));
  std::ranges::fill(transmittance_, 1.0f);
  bool shines_through = true;
  for (std::size_t rank = 0; shines_through && anything_seen(row, rank); ++rank) {
    const Layer here = layers_.at(static_cast<std::ptrdiff_t>(row), rank);
    shines_through = find_appearances(row, rank, here);
    for (std::size_t k = 0; k < used_; ++k) shade_pass(passes_[k], row, rank, here, display, physical);
  }
  if (shines_through && display != nullptr)
    kernel_.background(transmittance_.data(), shading_.background, width_, display);
}

}  // namespace nullcone::postrender
