// Pictures in memory: linear colours, row by row from the top left.
#pragma once

#include <cstdint>
#include <vector>

namespace nullcone::postrender {

/// A colour in linear sRGB (Rec. 709 primaries, D65 white). May leave [0, 1] until it is developed.
struct Rgb {
  float r = 0, g = 0, b = 0;
  bool operator==(const Rgb&) const = default;
};

constexpr Rgb operator+(Rgb a, Rgb b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
constexpr Rgb operator-(Rgb a, Rgb b) { return {a.r - b.r, a.g - b.g, a.b - b.b}; }
constexpr Rgb operator*(Rgb a, Rgb b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
constexpr Rgb operator*(float s, Rgb a) { return {s * a.r, s * a.g, s * a.b}; }
constexpr Rgb mix(Rgb a, Rgb b, float s) { return a + s * (b - a); }

/// A colour on its way through the pixel loops: one register, the fourth lane idle.
struct alignas(16) Rgbx {
  float r = 0, g = 0, b = 0, idle = 0;
  constexpr Rgbx() = default;
  constexpr Rgbx(Rgb c) : r(c.r), g(c.g), b(c.b) {}
  constexpr Rgbx(float red, float green, float blue) : r(red), g(green), b(blue) {}
  constexpr operator Rgb() const { return {r, g, b}; }
};

/// What shading yields, before exposure. Its two parts add up once the white is known:
/// colour = display + physical / white_cd_m2.
struct Radiance {
  std::vector<Rgbx> display;   ///< relative: 1 is white by definition
  std::vector<Rgbx> physical;  ///< cd/m^2; empty when nothing in the look is physical
};

/// What the components of a developed picture mean. The first two are encoded with the sRGB transfer curve
/// for screens, and linear in float files; the last two are for float files only.
enum class OutputSpace { srgb, display_p3, linear_rec709, xyz };

struct Output {
  OutputSpace space = OutputSpace::srgb;
  int jpeg_quality = 95;
  bool operator==(const Output&) const = default;
};

/// A developed picture.
struct Image {
  int width = 0, height = 0;
  double white_cd_m2 = 1;             ///< the luminance shown as 1 at ev = 0; 1 when nothing is physical
  std::vector<Rgb> exposed;           ///< after exposure, before tone curve and gamut mapping: for EXR files
  std::vector<Rgb> display;           ///< linear, within [0, 1]: for screens, PNG and JPEG
  std::vector<std::uint8_t> encoded;  ///< `display` as encode_srgb8() makes it, where it was asked for
  Output output = {};                 ///< what the components of all three mean
};

/// Which of its parts a picture shall have; the others are left empty.
struct ImageParts {
  bool exposed = true, display = true, encoded = false;
};

}  // namespace nullcone::postrender
