#include "postrender/develop.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "postrender/color.h"

namespace nullcone::postrender {

namespace {

struct LinearCurve {
  Rgb operator()(Rgb c) const { return c; }
};

/// Y -> 1 - exp(-k Y)
struct ExponentialCurve {
  float k;
  Rgb operator()(Rgb c) const {
    const float Y = luminance(c);
    if (!(Y > 0)) return c;
    // Far beyond the shoulder the ratio alone would lose the colour to 0 * infinity.
    return std::isfinite(Y) ? (-std::expm1(-k * Y) / Y) * c : Rgb{1, 1, 1};
  }
};

struct HuePreserving {
  Rgb operator()(Rgb c) const { return desaturated_into_gamut(c); }
};
struct Clip {
  Rgb operator()(Rgb c) const { return clipped_into_gamut(c); }
};

float clipped(float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; }

std::variant<LinearCurve, ExponentialCurve> curve_of(const DevelopLook& look) {
  if (look.curve == DevelopLook::Curve::linear) return LinearCurve{};
  return ExponentialCurve{static_cast<float>(look.k)};
}

std::variant<HuePreserving, Clip> gamut_of(const DevelopLook& look) {
  if (look.gamut == DevelopLook::Gamut::hue_preserving) return HuePreserving{};
  return Clip{};
}

}  // namespace

Rgb clipped_into_gamut(Rgb c) { return {clipped(c.r), clipped(c.g), clipped(c.b)}; }

Rgb desaturated_into_gamut(Rgb c) {
  const float Y = luminance(c);
  if (!(Y > 0)) return {};
  if (Y >= 1) return {1, 1, 1};
  float kept = 1;  // of the colour's difference from grey
  for (const float component : {c.r, c.g, c.b}) {
    if (component < 0) kept = std::min(kept, Y / (Y - component));
    if (component > 1) kept = std::min(kept, (1 - Y) / (component - Y));
  }
  return clipped_into_gamut(mix({Y, Y, Y}, c, kept));  // rounding may leave the gamut by a bit
}

double auto_white_cd_m2(const Radiance& radiance) {
  std::vector<float> lit;
  for (const Rgb c : radiance.physical)
    if (const float Y = luminance(c); Y > 0 && std::isfinite(Y)) lit.push_back(Y);
  if (lit.empty()) return 1;
  const auto at = lit.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(lit.size() - 1));
  std::nth_element(lit.begin(), at, lit.end());
  return static_cast<double>(*at);
}

Image develop(const Radiance& radiance, int width, int height, const DevelopLook& look) {
  Image image{width, height, 1, std::vector<Rgb>(radiance.display.size()),
              std::vector<Rgb>(radiance.display.size())};
  const bool physical = !radiance.physical.empty();
  if (physical) image.white_cd_m2 = look.white_cd_m2 ? *look.white_cd_m2 : auto_white_cd_m2(radiance);
  const auto gain = static_cast<float>(std::exp2(look.ev));
  const auto physical_gain = static_cast<float>(std::exp2(look.ev) / image.white_cd_m2);

  std::visit(
      [&](const auto& curve, const auto& gamut) {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, image.display.size(), 4096),
                          [&](const auto& range) {
                            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                              Rgb c = gain * radiance.display[i];
                              if (physical) c = c + physical_gain * radiance.physical[i];
                              image.exposed[i] = c;
                              image.display[i] = gamut(curve(c));
                            }
                          });
      },
      curve_of(look), gamut_of(look));
  return image;
}

}  // namespace nullcone::postrender
