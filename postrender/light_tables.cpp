#include "postrender/light_tables.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace nullcone::postrender {

namespace {

using Color = std::array<double, 3>;

Color times(double factor, Color c) {
  for (double& x : c) x = x == 0 ? 0 : factor * x;
  return c;
}

SpectralTable::Colors power_of(double power) {
  return [power](double g) {
    const double x = std::pow(g, power);
    return Color{x, x, x};
  };
}

/// The luminance of the texture's colours, grey: by amounts of red, green and blue.
std::vector<SpectralTable::Colors> luminances(double power) {
  std::vector<SpectralTable::Colors> out;
  for (const float weight : {kLuminance.r, kLuminance.g, kLuminance.b})
    out.push_back([weight = static_cast<double>(weight), power](double g) {
      const double x = weight * std::pow(g, power);
      return Color{x, x, x};
    });
  return out;
}

/// The lines of one or three spectra; at rest they are part of the table.
std::shared_ptr<const LineTable> line_table(const std::vector<AnySpectrum>& spectra, const Effects& effects,
                                            const Sensor& sensor, ShiftRange range) {
  auto out = std::make_shared<LineTable>();
  for (std::size_t i = 0; i < spectra.size() && effects.doppler; ++i)
    for (const SpectralLine& line : spectra[i]->lines())
      out->lines.push_back({line.wavelength_nm, line.strength, static_cast<int>(i)});
  if (out->lines.empty()) return nullptr;
  out->first_nm = sensor.first_nm;
  out->step_nm = sensor.step_nm;
  for (const auto& sample : sensor.response) out->response.push_back(sensor.rgb(sample));
  // The shift compresses wavelengths: a line is seen with 1/g of its strength a nanometre.
  out->power = std::make_shared<SpectralTable>(std::vector{power_of(effects.power() - 1)}, range);
  return out;
}

/// The spectra as this sensor wants them: display colours stay as bright as white was, whatever sees them.
std::vector<AnySpectrum> spectra_for(const SpectrumLook& look, const Sensor& sensor) {
  std::vector<AnySpectrum> out = look.spectra;
  if (look.physical || out.empty() || &sensor == &standard_observer()) return out;
  const Color white = sensor.rgb(sum(out)->fold(sensor, 1));
  const double luminance = static_cast<double>(kLuminance.r) * white[0] +
                           static_cast<double>(kLuminance.g) * white[1] +
                           static_cast<double>(kLuminance.b) * white[2];
  for (AnySpectrum& one : out) one = scaled(one, luminance > 0 ? 1 / luminance : 0);
  return out;
}

Light make(const SpectrumLook& look, const Effects& effects, const Sensor& sensor, ShiftRange range) {
  using Kind = SpectrumLook::Kind;
  std::vector<SpectralTable::Colors> colors;
  const double power = effects.power_without_spectrum();
  if (look.kind == Kind::display && power == 0) return {};
  if (look.kind == Kind::display) colors = {power_of(power)};
  if (look.kind == Kind::total_radiance) colors = luminances(power);
  for (const AnySpectrum& spectrum : spectra_for(look, sensor))
    colors.push_back(continuous_colors(spectrum, effects, sensor));
  return {std::make_shared<SpectralTable>(colors, range), line_table(look.spectra, effects, sensor, range),
          look.physical};
}

std::size_t bytes_of(const Light& light) { return light.table ? light.table->bytes() : 0; }

}  // namespace

Color seen_color(const SpectralDistribution& spectrum, const Effects& effects, const Sensor& sensor,
                 double g) {
  return times(std::pow(g, effects.power()),
               sensor.rgb(fold_with_lines(spectrum, sensor, effects.doppler ? g : 1)));
}

SpectralTable::Colors continuous_colors(AnySpectrum spectrum, const Effects& effects, const Sensor& sensor) {
  const double power = effects.power();
  if (!effects.doppler)
    return [at_rest = sensor.rgb(fold_with_lines(*spectrum, sensor, 1)), power](double g) {
      return times(std::pow(g, power), at_rest);
    };
  return [spectrum = std::move(spectrum), &sensor, power](double g) {
    return times(std::pow(g, power), sensor.rgb(spectrum->fold(sensor, g)));
  };
}

Light LightTables::get(const SpectrumLook& look, const Effects& effects, const Sensor& sensor,
                       ShiftRange range) {
  char numbers[128];
  std::snprintf(numbers, sizeof numbers, "|%d|%.17g|%.17g|%.9g|%.9g|", effects.doppler, effects.power(),
                effects.power_without_spectrum(), static_cast<double>(range.from),
                static_cast<double>(range.to));
  const std::string key = look.key + numbers + sensor.name;
  if (const auto found = entries_.find(key); found != entries_.end()) return found->second;
  return entries_.emplace(key, make(look, effects, sensor, range)).first->second;
}

void LightTables::prune(std::size_t most_bytes) {
  std::size_t sum = 0;
  for (const auto& [key, light] : entries_) sum += bytes_of(light);
  for (auto entry = entries_.begin(); entry != entries_.end() && sum > most_bytes;) {
    const bool unused = entry->second.table.use_count() == 1;
    if (unused) sum -= bytes_of(entry->second);
    entry = unused ? entries_.erase(entry) : std::next(entry);
  }
}

std::string unknown_wavelengths(const SpectrumLook& look, const Effects& effects, const Sensor& sensor,
                                ShiftRange range) {
  const double least = effects.doppler ? static_cast<double>(range.from) : 1,
               most = effects.doppler ? static_cast<double>(range.to) : 1;
  const Band needed{least * sensor.first_nm, most * sensor.last_nm()};
  Band known;
  for (const AnySpectrum& spectrum : look.spectra) {
    known.from = std::max(known.from, spectrum->known().from);
    known.to = std::min(known.to, spectrum->known().to);
  }
  const auto interval = [](double from, double to) {
    char text[64];
    std::snprintf(text, sizeof text, "%.6g to %.6g nm", from, to);
    return std::string(text);
  };
  std::string missing;
  if (needed.from < known.from) missing = interval(needed.from, std::min(known.from, needed.to));
  if (needed.to > known.to)
    missing += (missing.empty() ? "" : " and ") + interval(std::max(known.to, needed.from), needed.to);
  if (missing.empty()) return "";
  return "the spectrum is known from " + interval(known.from, known.to) + "; with shifts from " +
         std::to_string(least) + " to " + std::to_string(most) + " the sensor also sees " + missing;
}

}  // namespace nullcone::postrender
