// Colours without spectra, three spectra at once, materials, and surfaces under lamps.
#include <cmath>

#include "postrender/lit_table.h"
#include "postrender/rgb_basis.h"
#include "tests/postrender_fixture.h"
#include "tests/postrender_quadrature.h"

namespace nullcone::postrender {
namespace {

TEST(Spectrum, an_rgb_texture_shows_its_colours_at_rest) {
  for (const Rgb c : {Rgb{1, 0, 0}, Rgb{0, 1, 0}, Rgb{0, 0, 1}, Rgb{1, 1, 1}, Rgb{0.2f, 0.5f, 0.1f}})
    expect_color(seen(R"({"type":"rgb"})", c, 1.0f), c, 1e-6f);
  for (const AnySpectrum& primary : rgb_basis())
    for (double nm = 100; nm < 3000; nm += 1) EXPECT_GE(primary->at(nm), 0);
}

TEST(Spectrum, an_rgb_texture_is_as_bright_for_every_sensor) {
  for (const char* name : {"rods", "ccd", "infrared"}) {
    const auto sensor = find_sensor(name);
    const Light light = LightTables().get(spectrum_of(R"({"type":"rgb"})"), {}, *sensor, {0.5f, 2});
    EXPECT_NEAR(luminance(seen(light, {1, 1, 1}, 1)), 1, 1e-5f) << name;
  }
}

TEST(Spectrum, an_rgb_texture_turns_blue_when_it_approaches) {
  const std::string rgb = R"({"type":"rgb"})";
  const Effects doppler{true, false, {}, {}};
  const Rgb red{1, 0, 0}, approaching = seen(rgb, red, 1.25f, doppler),
                          receding = seen(rgb, red, 0.8f, doppler);
  EXPECT_GT(luminance(approaching), luminance(red));  // its infrared comes into sight
  EXPECT_LT(luminance(receding), luminance(red));
  const Rgb blue = seen(rgb, {0, 0, 1}, 0.75f, doppler);
  EXPECT_GT(blue.g, blue.b);  // blue at 450 nm is seen at 600 nm
}

TEST(Spectrum, three_channels_are_mixed_by_the_texture) {
  const std::string channels = R"({"type":"channels","spectra":[{"type":"lines","lines":[[611,1]]},
    {"type":"gaussian","centre_nm":545,"fwhm_nm":20},{"type":"black_body","temperature_K":4000}]})";
  const SpectrumLook look = spectrum_of(channels);
  (void)look;
  const std::string green = R"({"type":"gaussian","centre_nm":545,"fwhm_nm":20})",
                    body = R"({"type":"black_body","temperature_K":4000})";
  for (const float g : {0.9f, 1.0f, 1.2f}) {
    const Rgb found = seen(channels, {0, 0.5f, 0.25f}, g);
    const Rgb expected = 0.5f * seen(green, {1, 1, 1}, g) + 0.25f * seen(body, {1, 1, 1}, g);
    expect_color(found, expected, 2e-6f * std::max({std::abs(expected.r), expected.g, expected.b}));
  }
}

TEST(Spectrum, lines_in_three_channels_go_by_their_amounts) {
  const std::string channels = R"({"type":"channels","spectra":[{"type":"lines","lines":[[611,1]]},
    {"type":"lines","lines":[[545,2],[600,1]]},{"type":"constant","radiance":0.001}]})";
  for (const float g : {0.9f, 1.0f, 1.2f}) {
    const Rgb found = seen(channels, {0.5f, 0.25f, 0}, g);
    const Rgb expected = 0.5f * seen(R"({"type":"lines","lines":[[611,1]]})", {1, 1, 1}, g) +
                         0.25f * seen(R"({"type":"lines","lines":[[545,2],[600,1]]})", {1, 1, 1}, g);
    expect_color(found, expected, 2e-6f * std::max({std::abs(expected.r), expected.g, std::abs(expected.b)}));
  }
}

/// A binary PPM would do, but textures are PNG, TIFF, ...: the smallest TIFF writer there is, 8 bits, rgb.
std::string tiff(int width, int height, const std::string& rgb) {
  std::string out("II*\0\x08\0\0\0", 8);
  const auto number = [](unsigned x, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += static_cast<char>(x >> (8 * i) & 0xff);
    return text;
  };
  const unsigned entries = 9, data = 8 + 2 + 12 * entries + 4 + 6;
  const auto entry = [&](unsigned tag, unsigned type, unsigned count, unsigned value) {
    out += number(tag, 2) + number(type, 2) + number(count, 4) + number(value, 4);
  };
  out += number(entries, 2);
  entry(256, 3, 1, static_cast<unsigned>(width));
  entry(257, 3, 1, static_cast<unsigned>(height));
  entry(258, 3, 3, data - 6);
  entry(259, 3, 1, 1);
  entry(262, 3, 1, 2);
  entry(273, 4, 1, data);
  entry(277, 3, 1, 3);
  entry(278, 3, 1, static_cast<unsigned>(height));
  entry(279, 4, 1, static_cast<unsigned>(rgb.size()));
  out += number(0, 4) + number(8, 2) + number(8, 2) + number(8, 2);
  return out + rgb;
}

TEST(Materials, each_texel_shows_its_own_spectrum) {
  // Five materials side by side, the last at half its amount: more than one group of three.
  const TestFolder folder;
  std::string texels;
  for (int i = 0; i < 5; ++i)
    texels += std::string{static_cast<char>(i), static_cast<char>(i == 4 ? 51 : 255), 0};
  folder.write("materials.tif", tiff(5, 1, texels));
  const std::array<std::string, 5> spectra = {
      R"({"type":"black_body","temperature_K":3000})", R"({"type":"lines","lines":[[550,10000]]})",
      R"({"type":"gaussian","centre_nm":600,"fwhm_nm":50,"radiance":100})",
      R"({"type":"power_law","index":-2,"radiance":50})", R"({"type":"black_body","temperature_K":6000})"};
  std::string list;
  for (const std::string& one : spectra) list += (list.empty() ? "" : ",") + one;
  const float g = 1.1f;
  const Dataset data = make_dataset(5, 1, {{"earth"}}, [&](int column, int) {
    TestHit hit;
    hit.u = (static_cast<float>(column) + 0.5f) / 5;
    hit.shift = g;
    return std::vector{hit};
  });
  const std::string look =
      R"({"objects":{"earth":{"texture":{"type":"materials","file":"materials.tif","filter":"bilinear"},
    "spectrum":{"type":"materials","spectra":[)" +
      list + R"(]}}},"exposure":{"white_cd_m2":1}})";
  const Image image = picture(data, look, folder.path());
  for (std::size_t i = 0; i < 5; ++i) {
    const Rgb expected = (i == 4 ? 0.2f : 1.0f) * seen(spectra[i], {1, 1, 1}, g);
    const float largest = std::max({std::abs(expected.r), expected.g, std::abs(expected.b)});
    expect_color(image.exposed[i], expected, 1e-3f * largest);  // half floats: 2^-11
  }
}

TEST(Materials, wrong_ones_are_refused) {
  const TestFolder folder;
  folder.write("materials.tif", tiff(2, 1, std::string("\x02\xff\0\x01\xff\0", 6)));
  const auto refused = [&](const std::string& earth) {
    return complaint(
        [&] { picture(flat_map(2, 1), R"({"objects":{"earth":{)" + earth + "}}}", folder.path()); });
  };
  const std::string
      texture = R"("texture":{"type":"materials","file":"materials.tif"})",
      two = R"("spectrum":{"type":"materials","spectra":[{"type":"constant"},{"type":"constant"}]})";
  EXPECT_NE(refused(texture + "," + two).find("names material 2; the spectrum has 2"), std::string::npos);
  EXPECT_NE(refused(texture).find("go together"), std::string::npos);
  EXPECT_NE(refused(two).find("go together"), std::string::npos);
  EXPECT_NE(
      refused(R"("texture":{"type":"materials","file":"materials.tif","alpha":true},)" + two).find("alpha"),
      std::string::npos);
}

TEST(Spectrum, total_radiance_is_grey_and_goes_with_the_fourth_power) {
  const std::string total = R"({"type":"total_radiance"})";
  const Rgb c{0.5f, 0.25f, 0.125f};
  const float Y = luminance(c);
  expect_color(seen(total, c, 1.7f), static_cast<float>(std::pow(1.7, 4)) * Rgb{Y, Y, Y}, 3e-6f);
  expect_color(seen(total, c, 1.7f, {true, false, {}, {}}), {Y, Y, Y}, 1e-6f);
  expect_color(seen(total, c, 1.7f, {true, true, {1, 1}, {}}), 1.7f * Rgb{Y, Y, Y},
               1e-6f);  // Chang et al. 1996
}

TEST(Spectrum, materials_that_look_alike_at_rest_differ_when_shifted) {
  // Borchers 2005, figures 2.4 and 2.5: the same green, with more infrared on aluminium than on wood.
  const auto paint = [](const std::string& file) {
    return R"({"type":"lit","light":{"type":"equal_energy","luminance_cd_m2":1},"reflectance":{"type":"tabulated","file":")" +
           file + R"("}})";
  };
  const auto at = [&](const std::string& file, float g) {
    const SpectrumLook look = spectrum_of(paint(file), NULLCONE_TEST_DATA);
    const Light light = LightTables().get(look, {true, false, {}, {}}, standard_observer(), {0.5f, 2.5f});
    return seen(light, {1, 1, 1}, g);
  };
  const Rgb wood = at("green_on_wood.csv", 1), metal = at("green_on_aluminium.csv", 1);
  expect_color(wood, metal, 0.01f);
  EXPECT_GT(wood.g, wood.r);
  EXPECT_GT(wood.g, wood.b);
  EXPECT_GT(std::abs(luminance(at("green_on_wood.csv", 2)) - luminance(at("green_on_aluminium.csv", 2))),
            0.1f);
}

TEST(LitSurface, two_shifts_are_as_in_the_integral) {
  const AnySpectrum sun = black_body(5762),
                    paint =
                        spectrum_of(R"({"type":"tabulated","file":"green_on_wood.csv"})", NULLCONE_TEST_DATA)
                            .spectra[0];
  for (const Effects& effects :
       {Effects{}, Effects{true, false, {}, {}}, Effects{true, true, {1, 1}, {1, 1}}}) {
    const LitTable table(sun, paint, effects, standard_observer(), {0.8f, 1.5f}, {0.7f, 1.5f});
    std::printf("lit: error %.2g, %zu bytes\n", table.error(), table.bytes());
    EXPECT_LT(table.error(), 3e-5);
    for (const auto& [g, g_light] : {std::pair{0.81f, 1.45f}, {1.0f, 1.0f}, {1.43f, 0.733f}}) {
      const double a = static_cast<double>(g), b = static_cast<double>(g_light);
      // Straight from the definition: L_obs(lambda) = g^5 rho(g lambda) E(g lambda), E(l) = g_light^5
      // I(g_light l).
      Color expected =
          simpson([&](double nm) { return paint->at(nm) * sun->at(b * nm); }, standard_observer(), a);
      expected = standard_observer().rgb(expected);
      const double factor = std::pow(a * b, effects.power());
      const Rgb found = table.color(g, g_light);
      const double scale = factor * std::max({std::abs(expected[0]), expected[1], expected[2]});
      EXPECT_NEAR(static_cast<double>(found.r), factor * expected[0], 6e-5 * scale);
      EXPECT_NEAR(static_cast<double>(found.g), factor * expected[1], 6e-5 * scale);
      EXPECT_NEAR(static_cast<double>(found.b), factor * expected[2], 6e-5 * scale);
    }
    EXPECT_EQ(table.color(std::nanf(""), 1), Rgb{});
    EXPECT_EQ(table.color(1, 0), Rgb{});
  }
}

TEST(LitSurface, a_white_one_under_a_black_body_is_the_black_body_of_both_shifts) {
  const LitTable table(black_body(5762), constant(1), {}, standard_observer(), {0.6f, 1.8f}, {0.5f, 2.0f});
  EXPECT_LT(table.error(), 3e-5);
  for (const float g_light : {0.6f, 1.1f, 1.7f}) {
    const float g = 1.21f;
    const Rgb expected = seen(R"({"type":"black_body","temperature_K":5762})", {1, 1, 1}, g * g_light);
    expect_color(table.color(g, g_light), expected, 6e-5f * std::max(expected.r, expected.b));
  }
}

}  // namespace
}  // namespace nullcone::postrender
