// Spectra, folded with sensors and shifted: against references, direct quadrature, and closed forms.
#include <cmath>
#include <random>

#include "postrender/black_body.h"
#include "postrender/light_tables.h"
#include "postrender/lit_table.h"
#include "postrender/rgb_basis.h"
#include "tests/postrender_fixture.h"

namespace nullcone::postrender {
namespace {

using Color = std::array<double, 3>;

/// An independent quadrature: Simpson's rule, 64 steps in each interval between two samples of the sensor.
Color simpson(const std::function<double(double)>& L, const Sensor& sensor, double g) {
  Color sum{};
  for (std::size_t k = 0; k + 1 < sensor.response.size(); ++k) {
    constexpr int kSteps = 64;
    for (int i = 0; i <= kSteps; ++i) {
      const double s = static_cast<double>(i) / kSteps;
      const double nm = sensor.first_nm + sensor.step_nm * (static_cast<double>(k) + s);
      const double weight = (i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2) * sensor.step_nm / (3 * kSteps);
      for (std::size_t c = 0; c < 3; ++c)
        sum[c] += weight * std::lerp(sensor.response[k][c], sensor.response[k + 1][c], s) * L(g * nm);
    }
  }
  return sum;
}

TEST(Spectrum, black_bodies_from_500_to_1e9_K_shifted_from_1e_4_to_1e4) {
  double worst = 0;
  int compared = 0, black = 0;
  for (double T = 500; T < 1.1e9; T *= 7.3)
    for (double g = 1e-4; g < 1.1e4; g *= 2.37) {
      const Color found = black_body(T)->fold(standard_observer(), g);
      const Color exact =
          simpson([T](double nm) { return 1e-9 * planck_W_m3_sr(1e-9 * nm, T); }, standard_observer(), g);
      for (std::size_t c = 0; c < 3; ++c) {
        if (exact[c] > 1.0001e-290) {
          worst = std::max(worst, std::abs(found[c] / exact[c] - 1));
          ++compared;
        } else if (exact[c] < 0.9999e-290) {
          EXPECT_EQ(found[c], 0) << T << " " << g;
          ++black;
        }
        EXPECT_TRUE(std::isfinite(found[c]) && found[c] >= 0);
      }
    }
  RecordProperty("worst", std::to_string(worst));
  std::printf("worst relative error %.2g of %d, %d black\n", worst, compared, black);
  EXPECT_LT(worst, 1e-5);
  EXPECT_GT(compared, 300);
  EXPECT_GT(black, 10);
}

/// A bumpy table of 301 samples from 250 to 1000 nm.
AnySpectrum bumpy() {
  std::vector<double> nm, value;
  for (int i = 0; i <= 300; ++i) {
    nm.push_back(250 + 2.5 * i);
    value.push_back(0.02 + 0.01 * std::sin(0.9 * i) + (i % 37 == 0 ? 0.05 : 0));
  }
  return tabulated(nm, value, false);
}

TEST(Spectrum, every_kind_agrees_with_direct_quadrature) {
  const std::vector<AnySpectrum> kinds = {constant(3),
                                          power_law(2, 550, -3.5),
                                          gaussian(1, 600, 40),
                                          gaussian(1, 520, 8),
                                          sum({black_body(3000), gaussian(1e4, 520, 10)}),
                                          scaled(black_body(8000), 0.25),
                                          product(black_body(5000), gaussian(1, 560, 30))};
  for (const AnySpectrum& spectrum : kinds)
    for (const double g : {0.6, 0.93, 1.0, 1.3, 1.9})
      for (const char* name : {"cie1931", "rods", "ccd", "infrared"}) {
        const auto kept = find_sensor(name);
        const Sensor& sensor = *kept;
        const Color found = spectrum->fold(sensor, g),
                    exact = simpson([&](double nm) { return spectrum->at(nm); }, sensor, g);
        for (std::size_t c = 0; c < 3; ++c)
          EXPECT_NEAR(found[c], exact[c], 1e-5 * exact[c] + 1e-11) << name << g;
      }
}

TEST(Spectrum, tabulated_ones_are_exact_between_all_knots) {
  // Between two neighbouring knots of table and sensor the product is a parabola: Simpson's rule is exact
  // there.
  const AnySpectrum table = bumpy();
  for (const double g : {0.5, 0.7071, 1.0, 1.2345, 2.2}) {
    std::vector<double> borders;
    for (int i = 0; i < 95; ++i) borders.push_back(360 + 5 * i);
    for (const double knot : table->knots()) borders.push_back(std::clamp(knot / g, 360.0, 830.0));
    std::ranges::sort(borders);
    Color exact{};
    for (std::size_t i = 1; i < borders.size(); ++i) {
      const double a = borders[i - 1], b = borders[i];
      if (!(b > a)) continue;
      const double inside = 1e-9 * (b - a);  // at a jump the value within counts
      for (const auto& [nm, weight] : {std::pair{a + inside, 1.0}, {(a + b) / 2, 4.0}, {b - inside, 1.0}})
        for (std::size_t c = 0; c < 3; ++c)
          exact[c] += weight * (b - a) / 6 * standard_observer().at(nm)[c] * table->at(g * nm);
    }
    const Color found = table->fold(standard_observer(), g);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[c], exact[c], 1e-8 * exact[c]) << g;
  }
}

TEST(Spectrum, lines_are_seen_at_their_shifted_wavelength) {
  const AnySpectrum lines = line_list({{589.3, 2}, {900, 1}});
  const Color at_rest = fold_with_lines(*lines, standard_observer(), 1),
              blue = fold_with_lines(*lines, standard_observer(), 1.6);
  const Color sodium = standard_observer().at(589.3), shifted = standard_observer().at(589.3 / 1.6),
              infrared = standard_observer().at(900 / 1.6);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(at_rest[c], 2 * sodium[c], 1e-12 * sodium[c]);
    EXPECT_NEAR(blue[c], (2 * shifted[c] + infrared[c]) / 1.6, 1e-12 * blue[c]);
  }
}

TEST(Spectrum, a_narrow_gaussian_is_a_line) {
  // The whole power of a Gaussian is value * sigma * sqrt(2 pi).
  const double sigma = 1e-3, power = sigma * std::sqrt(2 * std::acos(-1.0));
  for (const double g : {0.81, 1.0, 1.21}) {
    const Color narrow = gaussian(1, 550, sigma)->fold(standard_observer(), g),
                line = fold_with_lines(*line_list({{550, power}}), standard_observer(), g);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(narrow[c], line[c], 3e-5 * line[c]) << g;
  }
}

/// CIELAB against equal-energy white of luminance `white`.
Color lab(const Color& xyz, double white) {
  Color f;
  for (std::size_t c = 0; c < 3; ++c) {
    const double x = xyz[c] / white;
    f[c] = x > 216.0 / 24389 ? std::cbrt(x) : (24389.0 / 27 * x + 16) / 116;
  }
  return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

Color xyz_of(const Color& c) {
  static const auto inverse = [] {  // of xyz_to_srgb(), by Cramer's rule
    const Matrix3& m = xyz_to_srgb();
    Matrix3 out{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        const std::size_t p = (i + 1) % 3, q = (i + 2) % 3, r = (j + 1) % 3, t = (j + 2) % 3;
        out[j][i] = m[p][r] * m[q][t] - m[p][t] * m[q][r];
      }
    const double det = m[0][0] * out[0][0] + m[0][1] * out[1][0] + m[0][2] * out[2][0];
    for (auto& row : out)
      for (double& x : row) x /= det;
    return out;
  }();
  Color out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) out[i] += inverse[i][j] * c[j];
  return out;
}

/// As the screen shows it: mixed with the grey of its own luminance until no component is negative.
Color displayed(Color rgb) {
  const double Y = 0.2126390058715102 * rgb[0] + 0.7151686787677559 * rgb[1] + 0.07219231536073371 * rgb[2];
  const double least = std::min({rgb[0], rgb[1], rgb[2]});
  const double kept = least < 0 ? Y / (Y - least) : 1;
  for (double& x : rgb) x = Y + kept * (x - Y);
  return rgb;
}

class TablesAgainstIntegration : public testing::TestWithParam<const char*> {};

TEST_P(TablesAgainstIntegration, within_1e_4_delta_E) {
  const SpectrumLook look = spectrum_of(GetParam(), NULLCONE_TEST_DATA);
  std::mt19937 random(5);
  for (const Effects& effects : {Effects{}, Effects{true, false, {}, {}}, Effects{false, true, {}, {}},
                                 Effects{true, true, {1, 1}, {}}}) {
    const ShiftRange range{0.26f, 3.8f};
    const Light light = LightTables().get(look, effects, standard_observer(), range);
    const auto exact = [&](double g) {
      return seen_color(*look.spectra[0], effects, standard_observer(), g);
    };
    double worst = 0;
    for (int i = 0; i < 400; ++i) {
      const float g = std::uniform_real_distribution<float>(range.from, range.to)(random);
      // White is the pixel itself, or a hundredth of what is brightest nearby.
      const Color rgb = exact(static_cast<double>(g));
      double white = xyz_of(rgb)[1];
      for (double near = 0.71; near < 1.41; near += 0.05)
        white = std::max(white, 0.01 * xyz_of(exact(near * static_cast<double>(g)))[1]);
      if (!(white > 0)) continue;
      const Rgb found = seen(light, {1, 1, 1}, g);
      const Color shown = {static_cast<double>(found.r), static_cast<double>(found.g),
                           static_cast<double>(found.b)};
      const Color a = lab(xyz_of(displayed(rgb)), white), b = lab(xyz_of(displayed(shown)), white);
      worst = std::max(worst, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
    }
    std::printf("%s: %.3g Delta E, table %.2g, %zu bytes\n", GetParam(), worst, light.table->error(),
                light.table->bytes());
    EXPECT_LT(worst, 1e-4);
  }
}
INSTANTIATE_TEST_SUITE_P(Kinds, TablesAgainstIntegration,
                         testing::Values(R"({"type":"black_body","temperature_K":5762})",
                                         R"({"type":"black_body","temperature_K":1200})",
                                         R"({"type":"black_body","temperature_K":1e9})",
                                         R"({"type":"power_law","index":-4})",
                                         R"({"type":"equal_energy","luminance_cd_m2":100})",
                                         R"({"type":"gaussian","centre_nm":600,"fwhm_nm":30})",
                                         R"({"type":"constant","from_nm":400,"to_nm":700})",
                                         R"({"type":"lines","lines":[[435.8,2],[546.1,3],[578,1],[1014,5]]})",
                                         R"({"type":"dominant_wavelength","wavelength_nm":520,"purity":0.5})",
                                         R"({"type":"tabulated","file":"green_on_wood.csv"})"));

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

TEST(Spectrum, tables_that_are_none_are_refused) {
  const TestFolder folder;
  const auto refused = [&](const std::string& csv) {
    folder.write("s.csv", csv);
    return complaint([&] { spectrum_of(R"({"type":"tabulated","file":"s.csv"})", folder.path()); });
  };
  EXPECT_EQ(refused("wavelength_nm,value\n400,1\n500,2\n"), "");
  EXPECT_EQ(refused("\xef\xbb\xbf"
                    "400;1\r\n500;2\r\n"),
            "");  // a byte order mark, Windows line ends
  for (const auto& [csv, words] : {std::pair{"4oo,1\n500,1\n600,1\n", "line 1: expected finite numbers"},
                                   {"+400,1\n500,1\n", "line 1"},
                                   {"400,nan\n500,1\n600,1\n", "line 1"},
                                   {"400,1\n500,x\n", "line 2"},
                                   {"500,1\n400,1\n", "line 2"},
                                   {"400,1\n500,1,2\n", "line 2: holds 3"},
                                   {"400,1\n500,-1\n", "line 2: expected values from 0"},
                                   {"400,1\n", "fewer than two"},
                                   {"", "fewer than two"}})
    EXPECT_NE(refused(csv).find(words), std::string::npos) << csv << ": " << refused(csv);
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

TEST(Spectrum, luminance_can_be_told) {
  for (const char* kind : {R"("type":"lines","lines":[[500,1]])", R"("type":"power_law","index":2)",
                           R"("type":"black_body","temperature_K":3000)"}) {
    const Rgb found = seen("{" + std::string(kind) + R"(,"luminance_cd_m2":250})", {1, 1, 1}, 1);
    EXPECT_NEAR(luminance(found), 250, 2e-4) << kind;
  }
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
    const LitTable table(sun, paint, effects, standard_observer(), {0.6f, 1.8f}, {0.5f, 2.0f});
    std::printf("lit: error %.2g, %zu bytes\n", table.error(), table.bytes());
    EXPECT_LT(table.error(), 2e-4);
    for (const auto& [g, g_light] : {std::pair{0.71f, 1.9f}, {1.0f, 1.0f}, {1.63f, 0.533f}}) {
      const double a = static_cast<double>(g), b = static_cast<double>(g_light);
      // Straight from the definition: L_obs(lambda) = g^5 rho(g lambda) E(g lambda), E(l) = g_light^5
      // I(g_light l).
      Color expected =
          simpson([&](double nm) { return paint->at(nm) * sun->at(b * nm); }, standard_observer(), a);
      expected = standard_observer().rgb(expected);
      const double factor = std::pow(a * b, effects.power());
      const Rgb found = table.color(g, g_light);
      const double scale = factor * std::max({std::abs(expected[0]), expected[1], expected[2]});
      EXPECT_NEAR(static_cast<double>(found.r), factor * expected[0], 2e-4 * scale);
      EXPECT_NEAR(static_cast<double>(found.g), factor * expected[1], 2e-4 * scale);
      EXPECT_NEAR(static_cast<double>(found.b), factor * expected[2], 2e-4 * scale);
    }
    EXPECT_EQ(table.color(std::nanf(""), 1), Rgb{});
    EXPECT_EQ(table.color(1, 0), Rgb{});
  }
}

TEST(LitSurface, a_white_one_under_a_black_body_is_the_black_body_of_both_shifts) {
  const LitTable table(black_body(5762), constant(1), {}, standard_observer(), {0.6f, 1.8f}, {0.5f, 2.0f});
  EXPECT_LT(table.error(), 2e-6);
  for (const float g_light : {0.6f, 1.1f, 1.7f}) {
    const float g = 1.21f;
    const Rgb expected = seen(R"({"type":"black_body","temperature_K":5762})", {1, 1, 1}, g * g_light);
    expect_color(table.color(g, g_light), expected, 4e-6f * std::max(expected.r, expected.b));
  }
}

TEST(Spectrum, missing_wavelengths_are_named) {
  const SpectrumLook look =
      spectrum_of(R"({"type":"tabulated","file":"green_on_wood.csv"})", NULLCONE_TEST_DATA);
  EXPECT_EQ(unknown_wavelengths(look, {}, standard_observer(), {1, 1.5f}), "");
  const std::string missing = unknown_wavelengths(look, {}, standard_observer(), {0.5f, 4});
  EXPECT_NE(missing.find("also sees 180 to 300 nm and 2500 to 3320 nm"), std::string::npos) << missing;
  EXPECT_EQ(unknown_wavelengths(look, {false, true, {}, {}}, standard_observer(), {0.5f, 4}), "");
}

TEST(Spectrum, no_overflow_up_to_extreme_speeds) {
  const float gamma2 = 1.4142e6f;  // beta = 1 - 1e-12, head on
  for (const char* spectrum :
       {R"({"type":"black_body","temperature_K":1e9})", R"({"type":"black_body","temperature_K":1})",
        R"({"type":"power_law","index":-20,"radiance":1e20})",
        R"({"type":"lines","lines":[[1e-3,1e20],[1e14,1e20]]})", R"({"type":"constant","radiance":1e20})",
        R"({"type":"total_radiance"})", R"({"type":"rgb"})"})
    for (const Effects& effects : {Effects{}, Effects{true, false, {}, {}}, Effects{false, true, {}, {}}}) {
      const Light light =
          LightTables().get(spectrum_of(spectrum), effects, standard_observer(), {1 / gamma2, gamma2});
      for (const float g : {gamma2, 1 / gamma2, 1.0f, 1e-38f, 3e38f, 1e-45f}) {
        const Rgb c = seen(light, {1, 1, 1}, g);
        const float largest = std::max({std::abs(c.r), std::abs(c.g), std::abs(c.b)});
        EXPECT_TRUE(std::isfinite(largest)) << spectrum << g;
        EXPECT_GE(luminance(c), -1e-6f * largest) << spectrum << g;
      }
    }
}

TEST(Spectrum, the_same_question_gets_the_same_table) {
  LightTables tables;
  const SpectrumLook sun = spectrum_of(R"({"type":"black_body","temperature_K":5762})"),
                     star = spectrum_of(R"({"type":"black_body","temperature_K":5763})");
  const Light first = tables.get(sun, {}, standard_observer(), {1, 2});
  EXPECT_EQ(tables.get(sun, {}, standard_observer(), {1, 2}), first);
  EXPECT_NE(tables.get(star, {}, standard_observer(), {1, 2}), first);
  EXPECT_NE(tables.get(sun, {}, standard_observer(), {1, 3}), first);
  EXPECT_NE(tables.get(sun, {}, *find_sensor("rods"), {1, 2}), first);
}

}  // namespace
}  // namespace nullcone::postrender
