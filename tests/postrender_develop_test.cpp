// Exposure, tone curve, gamut mapping.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "postrender/color.h"
#include "postrender/develop.h"
#include "tests/postrender_fixture.h"

namespace nullcone::postrender {
namespace {

/// The direction of a colour from the grey of its luminance: what hue-preserving mapping must keep.
std::array<double, 3> hue(Rgb c) {
  const float Y = luminance(c);
  const std::array<double, 3> d = {static_cast<double>(c.r - Y), static_cast<double>(c.g - Y),
                                   static_cast<double>(c.b - Y)};
  const double length = std::hypot(d[0], d[1], d[2]);
  return {d[0] / length, d[1] / length, d[2] / length};
}

Rgb mapped_into_gamut(Rgb c) { return developed(c, {}).display[0]; }

TEST(Gamut, hue_preserving_keeps_hue_and_luminance) {
  int mapped = 0;
  for (const float r : {-0.3f, 0.0f, 0.4f, 1.5f})
    for (const float g : {-0.1f, 0.2f, 0.7f, 1.1f})
      for (const float b : {-0.5f, 0.1f, 0.9f, 4.0f}) {
        const Rgb in{r, g, b};
        const float Y = luminance(in);
        if (Y < 0.01f || Y > 0.99f) continue;  // black and white have no hue
        const Rgb out = mapped_into_gamut(in);
        ++mapped;
        for (const float x : {out.r, out.g, out.b})
          EXPECT_TRUE(x >= 0 && x <= 1) << r << " " << g << " " << b;
        EXPECT_NEAR(luminance(out), Y, 1e-6f);  // float rounding of a sum of three terms below 4
        // As little grey as is needed: a colour that moved stops at the border.
        const bool moved =
            out != in && std::max({std::abs(out.r - r), std::abs(out.g - g), std::abs(out.b - b)}) > 1e-5f;
        const float border = std::min(std::min({out.r, out.g, out.b}), 1 - std::max({out.r, out.g, out.b}));
        EXPECT_NEAR(moved ? border : 0, 0, 1e-6f) << r << " " << g << " " << b;
        const Rgb away{out.r - Y, out.g - Y, out.b - Y};
        if (std::hypot(away.r, away.g, away.b) < 1e-2f) continue;
        // Rounding of 1e-7 over a saturation of at least 1e-2.
        for (std::size_t i = 0; i < 3; ++i)
          EXPECT_NEAR(hue(out)[i], hue(in)[i], 1e-4) << r << " " << g << " " << b;
      }
  EXPECT_GT(mapped, 20);
}

TEST(Gamut, colors_inside_stay_and_extremes_end_at_black_and_white) {
  const Rgb inside{0.1f, 0.9f, 0.3f};
  expect_color(mapped_into_gamut(inside), inside, 1e-7f);
  EXPECT_EQ(mapped_into_gamut({3, 3, 3}), (Rgb{1, 1, 1}));
  EXPECT_EQ(mapped_into_gamut({INFINITY, INFINITY, INFINITY}), (Rgb{1, 1, 1}));
  EXPECT_EQ(mapped_into_gamut({-1, -1, 0}), Rgb{});
  EXPECT_EQ(mapped_into_gamut({NAN, 0, 0}), Rgb{});
  DevelopLook clip;
  clip.gamut = DevelopLook::Gamut::clip;
  EXPECT_EQ(developed({-1, 0.5f, 7}, clip).display[0], (Rgb{0, 0.5f, 1}));
}

TEST(Tone, exponential_acts_on_the_luminance) {
  const Rgb color = {0.6f, 0.3f, 0.1f};
  DevelopLook look;
  look.curve = DevelopLook::Curve::exponential;
  look.k = 2;
  const Image image = developed(color, look);
  const float Y = luminance(color);
  EXPECT_NEAR(luminance(image.display[0]), 1 - std::exp(-2 * Y), 1e-6f);
  EXPECT_NEAR(image.display[0].r / image.display[0].g, 2, 1e-5);  // hue and saturation stay
  EXPECT_EQ(image.exposed[0], color);                             // untoned
}

TEST(Tone, exponential_is_right_from_the_faintest_to_the_brightest) {
  DevelopLook look;
  look.curve = DevelopLook::Curve::exponential;
  for (float Y = 1e-6f; Y < 50; Y *= 1.0137f) {
    const double expected = -std::expm1(-static_cast<double>(Y));
    // Relative: a luminance of three terms, a polynomial of seven and a ratio round by 1e-7 each.
    EXPECT_NEAR(static_cast<double>(developed({Y, Y, Y}, look).display[0].g), expected, 6e-7 * expected) << Y;
  }
}

TEST(Tone, extremes_do_not_break_the_exponential_curve) {
  DevelopLook look;
  look.curve = DevelopLook::Curve::exponential;
  EXPECT_EQ(developed({INFINITY, INFINITY, INFINITY}, look).display[0], (Rgb{1, 1, 1}));
  expect_color(developed({1e30f, 1e30f, 1e30f}, look).display[0], {1, 1, 1}, 1e-6f);
  EXPECT_EQ(developed({}, look).display[0], Rgb{});
  EXPECT_EQ(developed({NAN, 1, 1}, look).display[0], Rgb{});
}

DevelopLook look_with(const std::string& text) { return look_of(text, {}).develop; }

/// All ways to develop that differ in code.
std::vector<DevelopLook> all_looks() {
  std::vector<DevelopLook> out;
  for (const char* tone :
       {R"({})", R"({"curve":"exponential","k":1e6})", R"({"curve":"exponential"})", R"({"curve":"filmic"})",
        R"({"curve":"table","points":[[1e-9,0],[1,0.5],[1e20,1]]})"})
    for (const char* gamut : {"hue_preserving", "clip"})
      for (const char* white : {R"("D65")", R"("equal_energy")", R"({"temperature_K":1500})"})
        for (const char* space : {"srgb", "display_p3", "xyz"})
          out.push_back(look_with(std::string(R"({"tone":)") + tone + R"(,"gamut":")" + gamut +
                                  R"(","white_point":)" + white + R"(,"output":{"space":")" + space +
                                  R"("}})"));
  return out;
}

/// A run of colours, developed with one instruction set.
Image developed_run(const std::vector<Rgbx>& display, const std::vector<Rgbx>& physical,
                    const DevelopLook& look, double white_cd_m2, const Kernel& kernel) {
  Image image;
  set_size(image, static_cast<int>(display.size()), 1, {true, true, true});
  image.white_cd_m2 = white_cd_m2;
  LineDeveloper(look, kernel).develop(display.data(), physical.data(), 0, display.size(), image);
  return image;
}

TEST(Development, shows_no_nonsense_for_any_radiance) {
  constexpr float kMost = std::numeric_limits<float>::max(), kTiny = std::numeric_limits<float>::denorm_min();
  std::vector<Rgbx> display, physical;
  const std::vector<float> values = {0,     -0.0f, 1,      kTiny,    -kTiny,    1e-38f,
                                     1e20f, kMost, -kMost, INFINITY, -INFINITY, NAN};
  for (const float r : values)
    for (const float g : values)
      for (const float b : values) {
        display.emplace_back(r, g, b);
        physical.emplace_back(b, r, 0.5f);
      }
  for (DevelopLook look : all_looks())
    for (const double ev : {0.0, 64.0, -64.0})
      for (const double white : {1.0, 1e-45, 1e38}) {
        look.ev = ev;
        Image first;
        for (const Kernel* kernel : kernels()) {
          const Image image = developed_run(display, physical, look, white, *kernel);
          if (kernel == kernels().front()) first = image;
          EXPECT_EQ(image.exposed, first.exposed) << kernel->isa;
          EXPECT_EQ(image.display, first.display) << kernel->isa;
          EXPECT_EQ(image.encoded, first.encoded) << kernel->isa;
        }
        const auto within = [](const std::vector<Rgb>& colors, float least, float most) {
          return std::ranges::all_of(colors, [&](Rgb c) {
            return std::min({c.r, c.g, c.b}) >= least && std::max({c.r, c.g, c.b}) <= most && c.r == c.r &&
                   c.g == c.g && c.b == c.b;
          });
        };
        EXPECT_TRUE(within(first.exposed, -kBrightest, kBrightest));
        EXPECT_TRUE(within(first.display, 0, 1));
      }
}

TEST(Development, finite_radiance_is_not_lost_to_infinity) {
  constexpr float kMost = std::numeric_limits<float>::max();
  DevelopLook look;
  look.ev = 10;
  const auto shown = [&](Rgb display, Rgb physical, double white) {
    return developed_run({display}, {physical}, look, white, *kernels().front());
  };
  // 2^10 (kMost - kMost): infinities would make no number of it.
  EXPECT_EQ(shown({kMost, 0, 0}, {-kMost, 1, 0}, 1).exposed[0], (Rgb{0, 1024, 0}));
  EXPECT_EQ(shown({kMost, kMost, kMost}, {}, 1).display[0], (Rgb{1, 1, 1}));
  EXPECT_EQ(shown({}, {NAN, 1, 1}, 1).exposed[0], Rgb{});
  EXPECT_EQ(shown({}, {kMost, 0, -kMost}, 1).exposed[0], (Rgb{kBrightest, 0, -kBrightest}));
}

TEST(Development, is_the_same_for_every_instruction_set) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  std::vector<Rgbx> display, physical;
  for (int i = 0; i < 1003; ++i) {  // several segments and an odd rest
    const float s = std::exp(3 * normal(random));
    display.emplace_back(s * normal(random), s * normal(random), s * normal(random));
    physical.emplace_back(s, s * (1 + normal(random)), s * (1 + normal(random)));
  }
  for (const DevelopLook& look : all_looks()) {
    Image first;
    for (const Kernel* kernel : kernels()) {
      const Image image = developed_run(display, physical, look, 2.5, *kernel);
      if (kernel == kernels().front()) first = image;
      EXPECT_EQ(image.exposed, first.exposed) << kernel->isa;
      EXPECT_EQ(image.display, first.display) << kernel->isa;
      EXPECT_EQ(image.encoded, encode_srgb8(first.display)) << kernel->isa;
    }
  }
}

}  // namespace
}  // namespace nullcone::postrender
