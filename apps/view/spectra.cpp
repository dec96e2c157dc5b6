#include "apps/view/spectra.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "core/base/error.h"
#include "postrender/needed_channels.h"
#include "postrender/renderer.h"
#include "postrender/shading_in_time.h"

namespace nullcone::view {

namespace {

namespace pr = postrender;
using nlohmann::ordered_json;
using Kind = pr::SpectrumLook::Kind;

constexpr std::size_t kMostSpectra = 32;
constexpr double kShortest_nm = 300, kLongest_nm = 1000, kStep_nm = 5, kMostSteps = 400;

/// Every 5 nm over what eyes and most sensors see; wider steps where a sensor sees far more.
std::vector<double> wavelengths_for(const pr::Sensor& sensor) {
  const double from = std::max(kStep_nm, std::min(kShortest_nm, std::floor(sensor.first_nm))),
               to = std::max(kLongest_nm, std::ceil(sensor.last_nm()));
  const double step = kStep_nm * std::max(1.0, std::ceil((to - from) / (kStep_nm * kMostSteps)));
  std::vector<double> out;
  for (int i = 0; from + i * step <= to; ++i) out.push_back(from + i * step);
  return out;
}

/// One appearance of an object, with one of its spectra that follow one another in time.
struct Worn {
  pr::AppearanceLook look;
  pr::SpectrumLook spectrum;
};

/// An object's appearances by the numbers in its coats.
struct Wardrobe {
  std::vector<Worn> worn;
  pr::ObjectShading when;
};

Wardrobe wardrobe_of(const pr::ObjectLook& object, double tau_origin) {
  Wardrobe out;
  const auto add = [&](const pr::AppearanceLook& look) {
    const std::size_t first = out.worn.size();
    for (const pr::SpectrumLook& node : look.spectrum_in_time.nodes) out.worn.push_back({look, node});
    if (out.worn.size() == first) out.worn.push_back({look, look.spectrum.value_or(pr::SpectrumLook{})});
    return first;
  };
  out.when = pr::shading_in_time(tau_origin, object.appearance, object.time_slices, add);
  return out;
}

/// What is seen where the texture's colour is known without looking it up.
pr::AnySpectrum mixture(const Worn& worn, std::uint32_t id) {
  const pr::Rgb plain = worn.spectrum.physical ? pr::Rgb{1, 1, 1} : pr::default_color(id);
  const pr::TextureLook texture = worn.look.texture.value_or(pr::ColorTexture{plain});
  const auto* color = std::get_if<pr::ColorTexture>(&texture);
  if (color == nullptr) return nullptr;
  const std::array<float, 3> amounts = {color->color.r, color->color.g, color->color.b};
  std::vector<pr::AnySpectrum> parts;
  for (std::size_t i = 0; i < 3; ++i)
    parts.push_back(pr::scaled(worn.spectrum.spectra[i], static_cast<double>(amounts[i])));
  return pr::sum(std::move(parts));
}

/// The spectrum of one coat without its intensity; null: it has none.
pr::AnySpectrum spectrum_of(const Worn& worn, const pr::Times& times, std::uint32_t id) {
  if (worn.spectrum.kind == Kind::mixed) return mixture(worn, id);
  if (worn.spectrum.kind != Kind::filtered) return nullptr;
  const auto& temperature_K = worn.look.spectrum_in_time.temperature_K;
  return temperature_K ? pr::black_body(temperature_K->at(times)) : worn.spectrum.spectra[0];
}

pr::Times times_of(const Dataset& dataset, double tau_origin, std::size_t hit) {
  const Hits& hits = dataset.hits;
  return {hits.t.empty() ? 0 : static_cast<double>(hits.t[hit]),
          hits.tau.empty() ? 0 : static_cast<double>(hits.tau[hit]) + tau_origin};
}

struct Emitted {
  pr::AnySpectrum spectrum;  ///< null: none
  bool physical = true;
};

/// All coats together, each with its share of what the object lets be seen of itself.
Emitted emitted_at(const Wardrobe& wardrobe, const pr::Times& times, std::uint32_t id,
                   const pr::Effects& effects) {
  pr::Coats coats;
  const std::size_t count = pr::find_coats(wardrobe.when, times, coats);
  std::vector<pr::AnySpectrum> parts;
  std::vector<double> amounts;
  double all = 0;
  Emitted out;
  for (std::size_t k = 0; k < count; ++k) {
    const Worn& worn = wardrobe.worn[coats[k].appearance];
    const pr::Emission emission = pr::emission_of(worn.look, effects);
    const double share = static_cast<double>(coats[k].share) * emission.opacity_at(times);
    all += share;
    const pr::AnySpectrum spectrum = share > 0 ? spectrum_of(worn, times, id) : nullptr;
    if (!spectrum) continue;
    parts.push_back(spectrum);
    amounts.push_back(share * emission.intensity_at(times));
    out.physical &= worn.spectrum.physical;
  }
  for (std::size_t k = 0; k < parts.size(); ++k)
    if (amounts[k] != all) parts[k] = pr::scaled(parts[k], amounts[k] / all);
  if (!parts.empty()) out.spectrum = parts.size() == 1 ? parts[0] : pr::sum(std::move(parts));
  return out;
}

/// JSON has neither infinities nor what is not a number, which spectra reach with the wildest shifts only.
double tamed(double x) { return std::isnan(x) ? 0 : std::min(x, 1e300); }

ordered_json sampled(const pr::SpectralDistribution& spectrum, const std::vector<double>& nm, double factor) {
  ordered_json out = ordered_json::array();
  for (const double x : nm) out.push_back(factor > 0 ? tamed(factor * spectrum.at(x)) : 0.0);
  return out;
}

/// `ratio`: of wavelengths, emitted / observed; `factor`: on the radiance.
ordered_json lines_of(const pr::SpectralDistribution& emitted, double ratio, double factor) {
  ordered_json out = ordered_json::array();
  for (const pr::SpectralLine& line : emitted.lines())
    out.push_back({{"emitted_nm", line.wavelength_nm},
                   {"strength", line.strength},
                   {"observed_nm", tamed(line.wavelength_nm / ratio)},
                   {"observed_strength", tamed(factor * line.strength / ratio)}});
  return out;
}

/// What is seen of it with the frequency ratio g.
ordered_json told(const Emitted& emitted, const pr::Look& look, float g) {
  const pr::Effects& effects = look.effects;
  const auto shift = static_cast<double>(g);
  const bool seen = g > 0 && std::isfinite(g);
  const double ratio = seen && effects.doppler ? shift : 1;
  const double factor = seen ? tamed(std::pow(shift, effects.power())) : 0;
  const std::vector<double> nm = wavelengths_for(*look.sensor);
  const pr::AnySpectrum observed = ratio == 1 ? emitted.spectrum : pr::shifted(emitted.spectrum, ratio);
  return {{"wavelength_nm", nm},
          {"emitted", sampled(*emitted.spectrum, nm, 1)},
          {"observed", sampled(*observed, nm, factor)},
          {"lines", lines_of(*emitted.spectrum, ratio, factor)},
          {"unit", emitted.physical ? "W m^-2 sr^-1 nm^-1" : "relative"}};
}

bool has_all_channels(const Dataset& dataset, const pr::Look& look) {
  try {
    pr::check_channels(look, dataset.manifest, dataset.hits.channels, "dataset");
  } catch (const InputError&) {
    return false;
  }
  return true;
}

}  // namespace

ordered_json spectra_of(const Dataset& dataset, const pr::Look& look, std::size_t first, std::size_t end) {
  ordered_json out = ordered_json::array();
  if (!has_all_channels(dataset, look)) return out;
  std::map<std::uint32_t, Wardrobe> wardrobes;
  for (std::size_t hit = first; hit < end && out.size() < kMostSpectra; ++hit) {
    const std::uint32_t id = dataset.hits.id[hit];
    if (id < 1 || id > dataset.manifest.objects.size()) continue;
    const ObjectEntry& entry = dataset.manifest.objects[id - 1];
    const auto object = look.objects.find(entry.name);
    if (object == look.objects.end() || object->second.surface != pr::SurfaceType::self_luminous) continue;
    const pr::Times times = times_of(dataset, entry.tau_origin, hit);
    const auto [place, first_time] = wardrobes.try_emplace(id);
    if (first_time) place->second = wardrobe_of(object->second, entry.tau_origin);
    const Emitted emitted = emitted_at(place->second, times, id, look.effects);
    if (!emitted.spectrum) continue;
    const std::vector<float>& shift = dataset.hits.shift;
    ordered_json one = {{"hit", hit - first}, {"object", entry.name}};
    one["g"] = shift.empty() ? ordered_json(nullptr) : ordered_json(shift[hit]);
    one.update(told(emitted, look, shift.empty() ? 1 : shift[hit]));
    out.push_back(one);
  }
  return out;
}

}  // namespace nullcone::view
