// Planck's law, and how the eye sees it.
#pragma once

#include "postrender/color.h"

namespace nullcone::postrender {

/// Planck's spectral radiance B_lambda in W m^-3 sr^-1, with the exact constants of the SI of 2019.
double planck_W_m3_sr(double wavelength_m, double temperature_K);

/// Tristimulus values in cd/m^2 of a black body (standard_observer()): tabulated between 256 K and 2^34 K and
/// interpolated to 1e-7, else integrated.
Xyz black_body_xyz(double temperature_K);
/// The same, always integrated.
Xyz black_body_xyz_integrated(double temperature_K);

}  // namespace nullcone::postrender
