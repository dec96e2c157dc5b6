// Surfaces under lamps against direct integration over wavelengths.
#include <numbers>

#include "postrender/black_body.h"
#include "tests/postrender_lamps.h"
#include "tests/postrender_quadrature.h"

namespace nullcone::postrender {
namespace {

/// Relative to the largest component.
void expect_near(Rgb found, const Color& expected, double tolerance, const std::string& what) {
  const double scale =
      tolerance * std::max({1e-30, std::abs(expected[0]), std::abs(expected[1]), std::abs(expected[2])});
  EXPECT_NEAR(static_cast<double>(found.r), expected[0], scale) << what;
  EXPECT_NEAR(static_cast<double>(found.g), expected[1], scale) << what;
  EXPECT_NEAR(static_cast<double>(found.b), expected[2], scale) << what;
}

/// Straight from the definition, in two steps as the light goes: E(l) = E_rec g_l^p I(g_l l) at the surface,
/// L(l) = rho(l) E(l)/pi, and g^q L(g l) at the observer.
Color observed(const AnySpectrum& lamp, const AnySpectrum& rho, const Effects& effects, double g,
               double g_light, double E) {
  const double a = effects.doppler ? g : 1, b = effects.doppler ? g_light : 1;
  Color out = standard_observer().rgb(simpson(
      [&](double l) { return rho->at(l) * lamp->at(b * l) / std::numbers::pi; }, standard_observer(), a));
  const double powers =
      !effects.searchlight ? 1
      : effects.doppler
          ? std::pow(g, effects.radiance.spectral) * std::pow(g_light, effects.irradiance.spectral)
          : std::pow(g, effects.radiance.integrated) * std::pow(g_light, effects.irradiance.integrated);
  for (double& x : out) x *= E * powers;
  return out;
}

std::string text_of(const Effects& effects) {
  const auto beaming = [](const Beaming& of) {
    return R"({"spectral":)" + std::to_string(of.spectral) + R"(,"integrated":)" +
           std::to_string(of.integrated) + "}";
  };
  return R"("effects":{"doppler":)" + std::string(effects.doppler ? "true" : "false") + R"(,"searchlight":)" +
         (effects.searchlight ? "true" : "false") + R"(,"radiance_exponents":)" + beaming(effects.radiance) +
         R"(,"irradiance_exponents":)" + beaming(effects.irradiance) + "}";
}

const std::vector<Effects> kEffects = {{},
                                       {true, false, {}, {}},
                                       {false, true, {}, {}},
                                       {false, false, {}, {}},
                                       {true, true, {4, 3}, {2, 1}},
                                       {false, true, {5, 4}, {3, 2}}};
const std::vector<std::pair<float, float>> kShifts = {{0.2f, 5.0f}, {5.0f, 0.2f},  {0.5f, 0.6f},
                                                      {1.0f, 1.0f}, {1.7f, 0.45f}, {1.3f, 1.4f}};

TEST(LitSurfaces, agree_with_direct_integration) {
  for (const std::string& spectrum : {std::string(R"({"type":"black_body","temperature_K":4000})"),
                                      std::string(R"({"type":"gaussian","centre_nm":560,"fwhm_nm":150})"),
                                      std::string(R"({"type":"power_law","index":-3})"),
                                      std::string(R"({"type":"equal_energy","radiance":2})")})
    for (const Effects& effects : kEffects)
      for (const auto& [g, g_light] : kShifts) {
        const Color expected = observed(spectrum_of(spectrum).spectra[0], constant(1), effects,
                                        static_cast<double>(g), static_cast<double>(g_light), 0.25);
        const Rgb found = light_of(under_sun(g, {{0.25f, g_light}}),
                                   lambertian("", sun(R"("spectrum":)" + spectrum) + "," + text_of(effects)));
        // 2e-6: single precision of product and power; Simpson's rule is better.
        expect_near(found, expected, 2e-6, spectrum + " " + text_of(effects) + " " + std::to_string(g));
      }
}

TEST(LitSurfaces, reflect_each_wavelength_as_their_spectrum_says) {
  const std::string green = R"({"type":"gaussian","centre_nm":540,"fwhm_nm":120,"radiance":0.8})";
  for (const Effects& effects : kEffects)
    for (const auto& [g, g_light] : kShifts) {
      const Color expected = observed(black_body(5762), spectrum_of(green).spectra[0], effects,
                                      static_cast<double>(g), static_cast<double>(g_light), 3);
      const Rgb found = light_of(under_sun(g, {{3, g_light}}),
                                 lambertian(R"("spectrum":)" + green, sun(kHot) + "," + text_of(effects)));
      expect_near(found, expected, 6e-5, text_of(effects) + " " + std::to_string(g));
    }
}

TEST(LitSurfaces, lines_keep_narrow_and_take_the_reflectance_where_they_fall) {
  const std::string lines = R"("spectrum":{"type":"lines","lines":[[500,1],[610,0.5]]})",
                    green = R"({"type":"gaussian","centre_nm":540,"fwhm_nm":120})";
  const AnySpectrum rho = spectrum_of(green).spectra[0];
  const Sensor& eye = standard_observer();
  for (const Effects& effects :
       {Effects{}, Effects{true, true, {4, 3}, {2, 1}}, Effects{false, true, {}, {}}})
    for (const auto& [g, g_light] : {std::pair{1.1, 0.95}, {0.8, 1.2}, {1.0, 1.0}}) {
      const double a = effects.doppler ? g : 1, b = effects.doppler ? g_light : 1;
      Color xyz{};
      for (const auto& [nm, strength] : {std::pair{500.0, 1.0}, {610.0, 0.5}})
        for (std::size_t c = 0; c < 3; ++c)
          xyz[c] += strength / (a * b) * rho->at(nm / b) * eye.at(nm / (a * b))[c] / std::numbers::pi *
                    std::pow(g, effects.power()) * std::pow(g_light, effects.light_power());
      const auto data = under_sun(static_cast<float>(g), {{1, static_cast<float>(g_light)}});
      const Rgb found =
          light_of(data, lambertian(R"("spectrum":)" + green, sun(lines) + "," + text_of(effects)));
      expect_near(found, eye.rgb(xyz), 2e-5, text_of(effects) + " " + std::to_string(g));  // curves are steep
    }
}

TEST(LitSurfaces, display_lamps_shine_by_the_fourth_powers) {
  const Rgb found =
      light_of(under_sun(2, {{0.5f, 0.75f}}),
               lambertian(R"("texture":{"type":"color","rgb":[1,0,1]})", sun(R"("intensity":3)")), false);
  const double level = 0.5 * 3 / std::numbers::pi * std::pow(2 * 0.75, 4);
  expect_near(found, {level, 0, level}, 1e-6, "");
  // Without searchlight the shifts count for nothing; with other powers each has its own.
  const auto with = [&](const Effects& effects) {
    return light_of(under_sun(2, {{1, 0.75f}}), lambertian("", text_of(effects)), false).r;
  };
  EXPECT_NEAR(static_cast<double>(with({true, false, {}, {}})), 1 / std::numbers::pi, 1e-7);
  EXPECT_NEAR(static_cast<double>(with({true, true, {5, 2}, {5, 3}})),
              4 * std::pow(0.75, 3) / std::numbers::pi, 1e-6);
}

/// A sphere of radius R and temperature T in the distance d: E = pi B (R/d)^2, so L = albedo B (R/d)^2.
TEST(LitSurfaces, the_sun_on_white_paper) {
  const double R = 0.1, d = 3;
  const auto E = static_cast<float>(1 / (d * d));
  const std::string look =
      lambertian(R"("texture":{"type":"color","rgb":[1,1,1]},"intensity":0.5)",
                 sun(kHot + R"(,"intensity":)" + std::to_string(std::numbers::pi * R * R)));
  const double found = static_cast<double>(luminance(light_of(under_sun(1, {{E}}), look)));
  EXPECT_NEAR(found / (0.5 * black_body_xyz(5762)[1] * R * R / (d * d)), 1, 2e-5);  // digits of to_string
}

TEST(LitSurfaces, lamps_and_paths_add_up) {
  const std::vector<TestLight> near_sun = {{0.5f, 1.1f}, {0.25f, 0.9f}}, near_fire = {{0.125f, 0.8f}, {0, 1}};
  const auto data = [&](const std::vector<ObjectEntry>& lamps,
                        const std::vector<std::vector<TestLight>>& light) {
    TestHit hit;
    hit.shift = 1.2f;
    return lit_by(one_pixel({hit}), lamps, light);
  };
  const std::string fire = R"("fire":{"spectrum":{"type":"black_body","temperature_K":3000},"intensity":5})";
  const auto lights = [&](const std::string& sun_too, const std::string& fire_too) {
    return lambertian("", R"("lights":{"sun":{)" + kHot + sun_too + "}," + fire.substr(0, fire.size() - 1) +
                              fire_too + "}}");
  };
  const Dataset both = data({{"sun"}, {"fire"}}, {near_sun, near_fire});
  const Rgb sum = light_of(both, lights("", ""));
  const Rgb only_sun = light_of(data({{"sun"}}, {near_sun}), lambertian("", sun(kHot))),
            only_fire = light_of(data({{"fire"}}, {near_fire}), lambertian("", R"("lights":{)" + fire + "}"));
  expect_color(sum, only_sun + only_fire, 1e-6f * sum.r);
  EXPECT_GT(only_fire.r, 1e-4f * sum.r);
  // Off, dimmed to nothing, and without paths is as good as not there.
  for (const char* off : {R"("on":false)", R"("intensity":0)", R"("paths":[])"})
    EXPECT_EQ(light_of(both, lambertian("", R"("lights":{"sun":{)" + kHot + R"(},"fire":{)" + off + "}}")),
              only_sun)
        << off;
  // Paths.
  const Rgb first = light_of(both, lights(R"(,"paths":[0])", R"(,"on":false)")),
            second = light_of(both, lights(R"(,"paths":[1])", R"(,"on":false)"));
  expect_color(first + second, only_sun, 1e-6f * only_sun.r);
  EXPECT_EQ(first, light_of(data({{"sun"}}, {{near_sun[0]}}), lambertian("", sun(kHot))));
}

TEST(LitSurfaces, the_temperature_of_a_lamp_may_change) {
  const auto hot = [](const std::string& more, const std::string& temperature, const Effects& effects,
                      float g, float g_light) {
    return light_of(
        under_sun(g, {{2, g_light, 0, 1}}),
        lambertian(more, sun(R"("spectrum":{"type":"black_body","temperature_K":)" + temperature + "}") +
                             "," + text_of(effects)));
  };
  const std::string keys = R"({"keyframes":[[100,4600],[102,5400]],"by":"tau"})";  // 5000 K at 101
  for (const char* more : {"", R"("spectrum":{"type":"gaussian","centre_nm":540,"fwhm_nm":120})"})
    for (const Effects& effects : kEffects)
      for (const auto& [g, g_light] : {std::pair{1.0f, 1.0f}, {1.3f, 0.7f}, {0.6f, 1.5f}}) {
        const Rgb expected = hot(more, "5000", effects, g, g_light);
        expect_color(hot(more, keys, effects, g, g_light), expected,
                     6e-5f * std::max(expected.r, expected.b));
      }
  // Other spectra change node by node.
  const std::string narrow = R"("spectrum":{"type":"gaussian","fwhm_nm":20,"centre_nm":)";
  const std::string sliding = R"({"keyframes":[[100,500],[102,600]],"by":"tau"})";
  const Dataset data = under_sun(1, {{2, 1, 0, 1}});
  const Rgb expected = light_of(data, lambertian("", sun(narrow + "550}")));
  expect_color(light_of(data, lambertian("", sun(narrow + sliding + "}"))), expected, 2e-5f * expected.g);
}

TEST(LitSurfaces, ambient_light_comes_from_everywhere) {
  const std::string ambient = R"("ambient":{"intensity":0.5,)" + kHot + "}";
  for (const float g : {0.4f, 1.0f, 2.5f}) {
    TestHit hit;
    hit.shift = g;
    const Dataset data = one_pixel({hit});
    const Rgb found = light_of(data, lambertian(R"("texture":{"type":"color","rgb":[1,1,0]})", ambient)),
              glowing = seen(R"({"type":"black_body","temperature_K":5762})", {0.5f, 0.5f, 0}, g);
    expect_color(found, glowing, 1e-6f * std::max(glowing.r, glowing.g));
    const Rgb green =
        light_of(data, lambertian(R"("spectrum":{"type":"gaussian","centre_nm":540,"fwhm_nm":90})", ambient));
    expect_near(green,
                observed(black_body(5762),
                         spectrum_of(R"({"type":"gaussian","centre_nm":540,"fwhm_nm":90})").spectra[0], {},
                         static_cast<double>(g), 1, 0.5 * std::numbers::pi),
                1e-6, "green");
  }
  EXPECT_EQ(light_of(one_pixel({{}}), lambertian("", R"("ambient":{"intensity":0.25})"), false),
            (Rgb{0.25f, 0.25f, 0.25f}));
  // With lamps as well, also in other units.
  const Dataset data = under_sun(1, {{1}});
  const std::string with = R"("ambient":{"intensity":0.25},)" + sun(kHot);
  EXPECT_EQ(light_of(data, lambertian("", with), false).r, 0.25f);
  EXPECT_EQ(light_of(data, lambertian("", with)), light_of(data, lambertian("", sun(kHot))));
}

}  // namespace
}  // namespace nullcone::postrender
