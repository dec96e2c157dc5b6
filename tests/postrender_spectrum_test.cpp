// Spectra, folded with sensors and shifted: against references, direct quadrature, and closed forms.
#include <cmath>
#include <random>

#include "postrender/black_body.h"
#include "postrender/light_tables.h"
#include "tests/postrender_fixture.h"
#include "tests/postrender_quadrature.h"

namespace nullcone::postrender {
namespace {

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

TEST(Spectrum, luminance_can_be_told) {
  for (const char* kind : {R"("type":"lines","lines":[[500,1]])", R"("type":"power_law","index":2)",
                           R"("type":"black_body","temperature_K":3000)"}) {
    const Rgb found = seen("{" + std::string(kind) + R"(,"luminance_cd_m2":250})", {1, 1, 1}, 1);
    EXPECT_NEAR(luminance(found), 250, 2e-4) << kind;
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
