// The colour-matching functions of the CIE 1931 standard observer (2 degrees).
#pragma once

#include <array>

namespace nullcone::postrender {

inline constexpr std::size_t kCmfSamples = 95;
inline constexpr double kCmfFirst_nm = 360, kCmfStep_nm = 5;

/// x-bar, y-bar, z-bar at kCmfFirst_nm + i * kCmfStep_nm.
extern const std::array<std::array<double, 3>, kCmfSamples> kCie1931;

}  // namespace nullcone::postrender
