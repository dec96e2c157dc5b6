// What a surface radiates and what of it is seen: the four combinations of effects.
//
//   neither      L(lambda)           doppler alone  L(g lambda)
//   searchlight  g^4 L(lambda)       both           g^5 L(g lambda)   (PHYSICS.md section 9)
//
// g = observed / emitted frequency. Types are resolved outside the pixel loop (shade.cpp).
#pragma once

#include <cmath>

#include "postrender/black_body.h"

namespace nullcone::postrender {

struct Effects {
  bool doppler = true;      ///< wavelengths are shifted
  bool searchlight = true;  ///< radiance is beamed
  bool operator==(const Effects&) const = default;
};

constexpr float fourth_power(float g) { return (g * g) * (g * g); }

/// The texture's colours, whatever the shift: they have no spectrum that `doppler` could shift.
struct DisplaySpectrum {
  static constexpr bool kPhysical = false;
  Effects effects;

  Rgb operator()(Rgb texture, float g) const {
    return effects.searchlight ? fourth_power(g) * texture : texture;
  }
  bool operator==(const DisplaySpectrum&) const = default;
};

/// A black body in cd/m^2, seen through the texture's colours as a filter (componentwise in linear sRGB).
/// L(g lambda; T) = g^-5 B(lambda; g T), so that every combination is a look-up at T or g T.
struct BlackBodySpectrum {
  static constexpr bool kPhysical = true;
  Effects effects;
  double temperature_K;
  Rgb at_rest;  ///< seen with g = 1

  BlackBodySpectrum(double T_K, Effects which)
      : effects(which), temperature_K(T_K), at_rest(BlackBodyTable::instance().color_cd_m2(T_K)) {}

  Rgb operator()(Rgb texture, float g) const {
    if (!(g > 0) || !std::isfinite(g)) return {};
    if (!effects.doppler) return (effects.searchlight ? fourth_power(g) : 1.0f) * (texture * at_rest);
    const Rgb seen = BlackBodyTable::instance().color_cd_m2(static_cast<double>(g) * temperature_K);
    return (effects.searchlight ? 1.0f : 1.0f / (g * fourth_power(g))) * (texture * seen);
  }
  bool operator==(const BlackBodySpectrum&) const = default;
};

}  // namespace nullcone::postrender
