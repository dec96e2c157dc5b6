#include "postrender/illumination.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace nullcone::postrender {

namespace {

constexpr float kMostLight = 1e30f;  ///< beyond, 0 times infinity would be no number

constexpr auto kOnes = [] {
  std::array<float, kSegment> out{};
  out.fill(1.0f);
  return out;
}();

/// Dark where g is no ratio.
float power_of(float g, double power) {
  if (power == 0) return 1;
  return is_ratio(g) ? static_cast<float>(std::pow(static_cast<double>(g), power)) : 0.0f;
}

}  // namespace

void add_light(const Kernel& kernel, const Light& light, const Lit& lit) {
  if (!light.table) return kernel.plain(lit);
  const TableView table = light.table->view();
  (table.stride == 1 ? kernel.filtered : kernel.mixed)(table, lit);
  if (!light.lines) return;
  const LineTable& lines = *light.lines;
  kernel.lines(lines.view(table.stride == 3), lit);
}

Illumination::Path Illumination::path_along(std::size_t number, const RunPlace& place, std::size_t count) {
  const LightPath& path = dataset_.hits.light[number];
  const auto width = static_cast<std::size_t>(dataset_.manifest.width);
  const std::uint64_t* offset = dataset_.hits.offset.data() + place.row * width + place.first;
  if (one_each_[place.row] != 0)
    return {&path.E[*offset], &path.shift[*offset], &path.t[*offset], &path.tau[*offset]};
  const auto copy = [&](const std::vector<float>& column, std::array<float, kSegment>& to) {
    for (std::size_t i = 0; i < count; ++i) to[i] = column[offset[i] + place.rank];
    return to.data();
  };
  return {copy(path.E, copied_[0]), copy(path.shift, copied_[1]), copy(path.t, copied_[2]),
          copy(path.tau, copied_[3])};
}

void Illumination::add(const Appearance& surface, const RunPlace& place, const Lit& lit, const Sums& line) {
  const auto from_first = [&](Rgbx* sum) { return sum == nullptr ? nullptr : sum + place.first; };
  const Sums sums = {from_first(line.display), from_first(line.physical)};
  for (const LampShading& lamp : shading_.lamps)
    for (const std::size_t path : lamp.paths)
      add_path(surface, lamp, path_along(path, place, lit.count), lit, sums);
}

void Illumination::add_path(const Appearance& surface, const LampShading& lamp, const Path& path,
                            const Lit& lit, const Sums& sums) {
  // Step 1: mostly a lamp shines the same at all times.
  const std::size_t usual = lamp.when.appearance;
  if (lamp.when.plain() && !shading_.lamp_states[usual].clocks().any()) {
    const Reflection& reflection = surface.reflections[usual];
    if (weigh_steady(reflection, shading_.lamp_states[usual], path, lit))
      add_reflection(reflection, lit, sums);
    return;
  }
  // Step 2: else each pixel sees it as it was at its time, one state after the other.
  find_sights(lamp.when, path, lit.count);
  for (auto first = sights_.begin(); first != sights_.end();) {
    const std::uint32_t state = first->state;
    const auto last = std::find_if(first, sights_.end(), [&](const Sight& s) { return s.state != state; });
    const Reflection& reflection = surface.reflections[state];
    if (weigh(reflection, shading_.lamp_states[state], lamp.when.tau_origin, {first, last}, path, lit))
      add_reflection(reflection, lit, sums);
    first = last;
  }
}

/// Which pixels see the lamp in which states, sorted by state.
void Illumination::find_sights(const ObjectShading& lamp, const Path& path, std::size_t count) {
  sights_.clear();
  Coats states;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!(path.E[i] > 0)) continue;
    const Times times = {static_cast<double>(path.t[i]), static_cast<double>(path.tau[i]) + lamp.tau_origin};
    if (lamp.plain()) {
      sights_.push_back({static_cast<std::uint32_t>(lamp.appearance), i, 1});
      continue;
    }
    const std::size_t seen = find_coats(lamp, times, states);
    for (std::size_t k = 0; k < seen; ++k) sights_.push_back({states[k].appearance, i, states[k].share});
  }
  if (!lamp.plain()) std::ranges::stable_sort(sights_, {}, &Sight::state);
}

/// Writes product_ and weight_. False if no light arrives.
bool Illumination::weigh_steady(const Reflection& reflection, const LampState& state, const Path& path,
                                const Lit& lit) {
  const auto factor = static_cast<float>(state.intensity.constant / std::numbers::pi);
  float most = 0;
  for (std::size_t i = 0; i < lit.count; ++i) {
    const float g_light = path.shift[i], E = path.E[i];
    product_[i] = g_light > 0 ? lit.g[i] * g_light : 0.0f;
    const float light = lit.weight[i] * std::min(E * factor, kMostLight);
    weight_[i] = E > 0 ? std::min(light, kMostLight) : 0.0f;
    most = weight_[i] > most ? weight_[i] : most;
  }
  if (!(most > 0)) return false;
  if (reflection.light_power != 0)
    for (std::size_t i = 0; i < lit.count; ++i)
      weight_[i] = std::min(weight_[i] * power_of(path.shift[i], reflection.light_power), kMostLight);
  if (reflection.spectral) {
    std::copy_n(lit.g, lit.count, along_.begin());
    std::copy_n(path.shift, lit.count, across_.begin());
  }
  return true;
}

/// The same where the lamp changes with time, for the pixels of `sights` alone.
bool Illumination::weigh(const Reflection& reflection, const LampState& state, double tau_origin,
                         std::span<const Sight> sights, const Path& path, const Lit& lit) {
  std::fill_n(weight_.begin(), lit.count, 0.0f);
  bool any = false;
  for (const Sight& sight : sights) {
    const std::size_t i = sight.pixel;
    const float g = lit.g[i], g_light = path.shift[i];
    const Times times = {static_cast<double>(path.t[i]), static_cast<double>(path.tau[i]) + tau_origin};
    const float ratio =
        state.temperature
            ? static_cast<float>(state.temperature->temperature_K.at(times) / state.temperature->reference_K)
            : 1.0f;
    // A table of Planck's law serves all temperatures: B(lambda; g T) = g^5 B(g lambda; T).
    const bool at_rest = state.temperature && !reflection.doppler;
    along_[i] = at_rest ? 1 : g;
    across_[i] = at_rest ? ratio : ratio * g_light;
    product_[i] = along_[i] * across_[i];
    if (state.temperature && !(is_ratio(g) && is_ratio(g_light))) continue;
    if (g_light < 0) product_[i] = 0;
    const double light = state.intensity_at(times) * state.opacity_at(times) *
                         static_cast<double>(sight.share) * static_cast<double>(path.E[i]) /
                         std::numbers::pi *
                         static_cast<double>(lit.weight[i] * power_of(g, reflection.power) *
                                             power_of(g_light, reflection.light_power));
    weight_[i] = light > 0 ? std::min(static_cast<float>(light), kMostLight) : 0.0f;
    any |= weight_[i] > 0;
  }
  return any;
}

void Illumination::add_reflection(const Reflection& reflection, const Lit& lit, const Sums& sums) {
  Rgbx* sum = reflection.light.physical ? sums.physical : sums.display;
  if (!reflection.spectral)
    return add_light(kernel_, reflection.light,
                     {lit.count, product_.data(), weight_.data(), lit.colors, sum});
  const SpectralReflection& spectral = *reflection.spectral;
  kernel_.reflected(spectral.table.view(), across_.data(),
                    {lit.count, along_.data(), weight_.data(), lit.colors, sum});
  for (const ReflectedLine& one : spectral.lines) {
    std::fill_n(filtered_.begin(), lit.count, Rgbx{});
    kernel_.filtered(one.reflectance->view(),
                     {lit.count, across_.data(), weight_.data(), lit.colors, filtered_.data()});
    kernel_.lines(one.line->view(false), {lit.count, product_.data(), kOnes.data(), filtered_.data(), sum});
  }
}

}  // namespace nullcone::postrender
