// Output spaces and white points: what the components of a picture mean, and the matrices between them.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "postrender/color.h"
#include "postrender/image.h"

namespace nullcone::postrender {

/// CIE 1931 x, y.
struct Chromaticity {
  double x = 0, y = 0;
  bool operator==(const Chromaticity&) const = default;
};

inline constexpr Chromaticity kD65 = {0.3127, 0.3290}, kEqualEnergy = {1.0 / 3, 1.0 / 3};

/// An RGB space: its primaries, and the white that R = G = B = 1 shows.
struct Primaries {
  Chromaticity red, green, blue, white;
};

/// The names of output spaces in looks.
inline constexpr std::array<std::pair<std::string_view, OutputSpace>, 4> kOutputSpaces = {
    {{"srgb", OutputSpace::srgb},
     {"display_p3", OutputSpace::display_p3},
     {"linear_rec709", OutputSpace::linear_rec709},
     {"xyz", OutputSpace::xyz}}};
std::string_view name_of(OutputSpace space);

/// IEC 61966-2-1 (Rec. 709) and SMPTE EG 432-1 with D65. Those of XYZ are its axes and equal energy, as EXR
/// files have it.
Primaries primaries_of(OutputSpace space);

/// Linear components -> XYZ with Y = 1 for R = G = B = 1, from the chromaticities; the identity for XYZ.
Matrix3 to_xyz(OutputSpace space);

/// The luminance of linear components: the middle row of to_xyz(), rounded to float.
Rgb luminance_weights(OutputSpace space);

/// Chromatic adaptation in XYZ (Lam 1985, "Bradford"; linear, as in ICC.1): light of the colour `from`
/// becomes light of the colour `to`, and its luminance stays. Nothing where the cones of the model see too
/// little of either colour (below 1/1000 of its luminance) to be scaled by it.
std::optional<Matrix3> adaptation(const Chromaticity& from, const Chromaticity& to);

/// The colour of a black body.
Chromaticity black_body_chromaticity(double temperature_K);

/// From linear Rec. 709 to the components of `space`, with light of the colour `white` shown as the white of
/// the screen. Nothing where both leave everything as it is.
std::optional<Matrix3> output_matrix(OutputSpace space, const Chromaticity& white);

}  // namespace nullcone::postrender
