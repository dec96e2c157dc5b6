#include "postrender/reflection.h"

#include <array>
#include <cmath>
#include <cstdio>

namespace nullcone::postrender {

namespace {

/// What questions are told apart by.
std::string key_of(const LampSpectrum& lamp, const SpectrumLook& reflectance, const Effects& effects,
                   const Sensor& sensor, const std::array<ShiftRange, 3>& ranges) {
  char numbers[96];
  std::snprintf(numbers, sizeof numbers, "|%.17g|%.17g|", effects.power(), effects.light_power());
  std::string key = lamp.spectrum.key + "|" + reflectance.key + numbers;
  for (const ShiftRange& range : ranges) {
    std::snprintf(numbers, sizeof numbers, "%.9g|%.9g|", static_cast<double>(range.from),
                  static_cast<double>(range.to));
    key += numbers;
  }
  return key + sensor.name;
}

/// Lines are as narrow as before when they are reflected: at mu/g_light, with rho there.
std::vector<ReflectedLine> reflected_lines(LightTables& lights, const SpectrumLook& lamp,
                                           const AnySpectrum& reflectance, const Effects& effects,
                                           const Sensor& sensor, const LightShifts& from_lamp) {
  std::vector<ReflectedLine> out;
  const double power = effects.light_power() - effects.power();
  for (const SpectralLine& line : lamp.spectra[0]->lines()) {
    SpectrumLook one{SpectrumLook::Kind::filtered, true, {line_list({line})}, ""};
    char numbers[64];
    std::snprintf(numbers, sizeof numbers, "line %.17g %.17g", line.wavelength_nm, line.strength);
    one.key = numbers;
    const SpectralTable::Colors at_line = [&](double g_light) {
      const double x = std::pow(g_light, power) * reflectance->at(line.wavelength_nm / g_light);
      return std::array<double, 3>{x, x, x};
    };
    out.push_back({lights.get(one, effects, sensor, from_lamp.product).lines,
                   std::make_shared<SpectralTable>(std::vector{at_line}, from_lamp.light)});
  }
  return out;
}

/// A table serves all temperatures of a black body where it has the powers of Planck's law in it.
Reflection with_changing_temperature(const Effects& effects) {
  const double has = effects.doppler ? 5 : 0;
  return {{}, {}, effects.power() - has, effects.light_power() - has, effects.doppler};
}

}  // namespace

SpectrumLook reflected(const SpectrumLook& light, const SpectrumLook& reflectance) {
  return {SpectrumLook::Kind::filtered,
          true,
          {product(light.spectra[0], reflectance.spectra[0])},
          "(" + light.key + ")on(" + reflectance.key + ")"};
}

Reflection ReflectionTables::get(LightTables& lights, const LampSpectrum& lamp,
                                 const SpectrumLook* reflectance, const Effects& effects,
                                 const Sensor& sensor, ShiftRange shifts, const LightShifts& from_lamp) {
  Reflection out;
  if (lamp.temperature) {
    out = with_changing_temperature(effects);
  } else if (lamp.spectrum.kind == SpectrumLook::Kind::display) {
    out.light_power = effects.light_power_without_spectrum() - effects.power_without_spectrum();
  } else {
    out.light_power = effects.light_power() - effects.power();
  }
  out.doppler = effects.doppler;
  const Effects tabulated = lamp.temperature ? Effects{} : effects;
  // Step 1: one table by the product of the ratios will do where the reflectance sees nothing of g_light.
  if (reflectance == nullptr || (!effects.doppler && !lamp.temperature)) {
    const ShiftRange range =
        lamp.temperature ? reference_range(*lamp.temperature, from_lamp.product) : from_lamp.product;
    out.light = lights.get(reflectance == nullptr ? lamp.spectrum : reflected(lamp.spectrum, *reflectance),
                           tabulated, sensor, range);
    return out;
  }
  // Step 2: else it takes both.
  const ShiftRange along = effects.doppler ? shifts : ShiftRange{},
                   across = lamp.temperature ? reference_range(*lamp.temperature, from_lamp.light)
                                             : from_lamp.light;
  if (!lamp.temperature) out.light_power = 0;
  out.light.physical = true;
  auto& entry = entries_[key_of(lamp, *reflectance, tabulated, sensor, {along, across, from_lamp.product})];
  if (!entry)
    entry = std::make_shared<SpectralReflection>(SpectralReflection{
        LitTable(lamp.spectrum.spectra[0], reflectance->spectra[0], tabulated, sensor, along, across),
        reflected_lines(lights, lamp.spectrum, reflectance->spectra[0], tabulated, sensor, from_lamp)});
  out.spectral = entry;
  return out;
}

void ReflectionTables::prune(std::size_t most_bytes) {
  std::size_t sum = 0;
  for (const auto& [key, entry] : entries_) sum += entry->table.bytes();
  for (auto entry = entries_.begin(); entry != entries_.end() && sum > most_bytes;) {
    const bool unused = entry->second.use_count() == 1;
    if (unused) sum -= entry->second->table.bytes();
    entry = unused ? entries_.erase(entry) : std::next(entry);
  }
}

}  // namespace nullcone::postrender
