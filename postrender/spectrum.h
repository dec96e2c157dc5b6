// What a surface radiates and what of it is seen: the four combinations of effects.
//
//   neither      L(lambda)           doppler alone  L(g lambda)
//   searchlight  g^4 L(lambda)       both           g^5 L(g lambda)   (docs/physics.md)
//
// g = observed / emitted frequency. The pixel loops are in kernel_spectrum.h.
#pragma once

namespace nullcone::postrender {

struct Effects {
  bool doppler = true;      ///< wavelengths are shifted
  bool searchlight = true;  ///< radiance is beamed
  bool operator==(const Effects&) const = default;
};

/// The texture's colours, whatever the shift: they have no spectrum that `doppler` could shift.
struct DisplaySpectrum {
  static constexpr bool kPhysical = false;
  Effects effects;
  bool operator==(const DisplaySpectrum&) const = default;
};

/// A black body in cd/m^2, seen through the texture's colours as a filter (componentwise in linear sRGB).
/// L(g lambda; T) = g^-5 B(lambda; g T), so that every combination is a look-up at T or g T. Black where g is
/// not positive and finite.
struct BlackBodySpectrum {
  static constexpr bool kPhysical = true;
  Effects effects;
  double temperature_K;

  bool operator==(const BlackBodySpectrum&) const = default;
};

}  // namespace nullcone::postrender
