// Colour and black bodies against the reference cases of docs/physics.md.
#include <cmath>

#include "postrender/black_body.h"
#include "postrender/cie1931.h"
#include "postrender/color.h"
#include "postrender/color_space.h"
#include "tests/postrender_fixture.h"

namespace nullcone::postrender {
namespace {

/// Within the case's own tolerance.
void expect_close(double found, double expected, const nlohmann::json& tolerance) {
  const double allowed = tolerance.value("rel", 0.0) * std::abs(expected) + tolerance.value("abs", 0.0);
  EXPECT_NEAR(found, expected, allowed);
}

TEST(Color, matrix_follows_from_primaries_and_white) {
  const auto one = reference_case("color.srgb_matrix");
  const auto& expected = one["expected"]["XYZ_to_linear_sRGB"];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) expect_close(xyz_to_srgb()[i][j], expected[i][j], one["tol"]);
}

TEST(Color, luminance_weights_are_the_middle_row_of_the_inverse) {
  // The XYZ of each primary, through the matrix, must give the primary back; its Y is the weight.
  const std::array<std::array<double, 2>, 3> primaries = {{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}};
  const std::array<float, 3> weights = {luminance({1, 0, 0}), luminance({0, 1, 0}), luminance({0, 0, 1})};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [x, y] = primaries[i];
    const double Y = static_cast<double>(weights[i]);
    EXPECT_NEAR(linear_srgb({Y * x / y, Y, Y * (1 - x - y) / y})[i], 1, 1e-6);  // weights are floats
  }
}

TEST(Color, matching_functions_have_the_sums_of_the_cie_table) {
  const auto one = reference_case("color.equal_energy");
  for (std::size_t j = 0; j < 3; ++j) {
    double sum = 0;
    for (const auto& sample : kCie1931) sum += kCmfStep_nm * sample[j];
    expect_close(sum, one["expected"]["sum_times_5nm"][j], one["tol"]);
  }
}

TEST(Color, eight_bit_encoding_rounds_the_exact_curve) {
  for (int i = 0; i <= 200000; ++i) {
    const float linear = static_cast<float>(i) / 200000;
    const double exact = 255 * srgb_encoded(static_cast<double>(linear));
    const Rgb c{linear, linear, linear};
    const int code = encode_srgb8({&c, 1})[0];
    EXPECT_LE(std::abs(code - exact), 0.5 + 1e-4) << linear;  // thresholds are floats: 1e-7 * 3295 codes
  }
  const Rgb wild{-1, 2, std::nanf("")};
  EXPECT_EQ(encode_srgb8({&wild, 1}), (std::vector<std::uint8_t>{0, 255, 0}));
}

TEST(Color, every_code_survives_decoding_and_encoding) {
  for (int code = 0; code < 256; ++code) {
    const auto linear = static_cast<float>(srgb_decoded(code / 255.0));
    const Rgb c{linear, linear, linear};
    EXPECT_EQ(encode_srgb8({&c, 1})[1], code);
    EXPECT_EQ(encode_srgb16({&c, 1})[2], code * 257);
  }
}

class BlackBodyColor : public testing::TestWithParam<int> {};

TEST_P(BlackBodyColor, is_the_exact_integral_with_linear_matching_functions) {
  const auto one = reference_case("color.blackbody." + std::to_string(GetParam()));
  const auto& expected = one["expected"]["cie1931_linear_interp_exact"];
  for (const Xyz& xyz : {black_body_xyz_integrated(GetParam()), black_body_xyz(GetParam())}) {
    const bool table = xyz == black_body_xyz(GetParam());
    const nlohmann::json tolerance = table ? nlohmann::json{{"rel", 1e-7}, {"abs", 1e-7}} : one["tol"];
    const double sum = xyz[0] + xyz[1] + xyz[2];
    expect_close(xyz[0] / sum, expected["xy"][0], tolerance);
    expect_close(xyz[1] / sum, expected["xy"][1], tolerance);
    const auto rgb = linear_srgb({xyz[0] / xyz[1], 1, xyz[2] / xyz[1]});
    for (std::size_t j = 0; j < 3; ++j) expect_close(rgb[j], expected["linear_sRGB_Y1"][j], tolerance);
    expect_close(xyz[1], one["expected"]["luminance_cd_m2_linear_interp_exact"], tolerance);
  }
}

TEST_P(BlackBodyColor, differs_from_the_5_nm_sum_as_the_references_do) {
  const auto one = reference_case("color.blackbody." + std::to_string(GetParam()));
  Xyz sum{};
  for (std::size_t i = 0; i < kCmfSamples; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      sum[j] += 683 * 5e-9 * kCie1931[i][j] *
                planck_W_m3_sr(1e-9 * (kCmfFirst_nm + kCmfStep_nm * static_cast<double>(i)), GetParam());
  expect_close(sum[1], one["expected"]["luminance_cd_m2_5nm_sum"], one["tol"]);
}
INSTANTIATE_TEST_SUITE_P(Cases, BlackBodyColor, testing::Values(1000, 2000, 5762, 10000, 26000));

class ShiftedPlanck : public testing::TestWithParam<int> {};

TEST_P(ShiftedPlanck, is_planck_of_the_shifted_temperature) {
  const auto one = reference_case("sr.blackbody." + std::to_string(GetParam()));
  const auto& in = one["inputs"];
  const auto& out = one["expected"];
  const double T = in["T_emit_K"], g = in["g"], seen_m = in["lambda_obs_m"];
  expect_close(planck_W_m3_sr(g * seen_m, T), out["B_emit_W_m3_sr"], one["tol"]);
  expect_close(planck_W_m3_sr(seen_m, g * T), out["B_obs_W_m3_sr"], one["tol"]);
  expect_close(std::pow(g, 5) * planck_W_m3_sr(g * seen_m, T), out["B_obs_W_m3_sr"], one["tol"]);
}
INSTANTIATE_TEST_SUITE_P(Cases, ShiftedPlanck, testing::Values(1, 2, 3));

void expect_matrix(const Matrix3& found, const Matrix3& expected, double tolerance) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(found[i][j], expected[i][j], tolerance) << i << j;
}

std::array<double, 3> times(const Matrix3& m, const std::array<double, 3>& v) {
  std::array<double, 3> out{};
  for (std::size_t i = 0; i < 3; ++i) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
  return out;
}

Xyz of_luminance_1(const Chromaticity& c) { return {c.x / c.y, 1, (1 - c.x - c.y) / c.y}; }

TEST(ColorSpace, primaries_have_the_xyz_that_is_published) {
  // SMPTE EG 432-1 primaries with D65, as Apple's profile and CSS Color 4 (section 17) have them.
  expect_matrix(to_xyz(OutputSpace::display_p3),
                {{{0.4865709486, 0.2656676932, 0.1982172852},
                  {0.2289745641, 0.6917385218, 0.0792869141},
                  {0, 0.0451133819, 1.0439443689}}},
                1e-9);
  for (std::size_t j = 0; j < 3; ++j) {  // the inverse of what color.cpp derives
    std::array<double, 3> one{};
    one[j] = 1;
    EXPECT_NEAR(linear_srgb(times(to_xyz(OutputSpace::srgb), one))[j], 1, 1e-14);
  }
  EXPECT_EQ(luminance_weights(OutputSpace::srgb), kLuminance);
  EXPECT_EQ(luminance_weights(OutputSpace::xyz), (Rgb{0, 1, 0}));
}

TEST(ColorSpace, rec_709_in_other_spaces) {
  EXPECT_FALSE(output_matrix(OutputSpace::srgb, kD65));
  EXPECT_FALSE(output_matrix(OutputSpace::linear_rec709, kD65));
  expect_matrix(*output_matrix(OutputSpace::display_p3, kD65),  // CSS Color 4
                {{{0.8224619687, 0.1775380313, 0},
                  {0.0331941989, 0.9668058011, 0},
                  {0.0170826307, 0.0723974407, 0.9105199286}}},
                1e-9);
  expect_matrix(*output_matrix(OutputSpace::xyz, kD65), to_xyz(OutputSpace::srgb), 1e-15);
}

TEST(ColorSpace, adaptation_is_bradfords) {
  // D65 -> D50 of B. Lindbloom's page, whose whites have five digits and not quite these chromaticities.
  const double sum = 0.96422 + 1 + 0.82521;
  expect_matrix(*adaptation(kD65, {0.96422 / sum, 1 / sum}),
                {{{1.0478112, 0.0228866, -0.0501270},
                  {0.0295424, 0.9904844, -0.0170491},
                  {-0.0092345, 0.0150436, 0.7521316}}},
                3e-4);
  EXPECT_FALSE(adaptation({0.735, 0.265}, kD65));  // spectral red: nothing for the short cones
}

TEST(ColorSpace, light_of_the_white_point_is_shown_as_white) {
  for (const Chromaticity& white :
       {kD65, kEqualEnergy, black_body_chromaticity(3000), Chromaticity{0.25, 0.25}})
    for (const OutputSpace space : {OutputSpace::srgb, OutputSpace::display_p3}) {
      const auto rgb = linear_srgb(of_luminance_1(white));
      const Rgb light = {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])};
      DevelopLook look;
      look.white_point = white;
      look.output.space = space;
      expect_color(developed(light, look).exposed[0], {1, 1, 1}, 1e-6f);  // floats of up to 3
    }
  DevelopLook look;
  look.white_point = kEqualEnergy;
  look.output.space = OutputSpace::xyz;  // the white of the screen stays D65
  const auto rgb = linear_srgb({1, 1, 1});
  const Rgb light = {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])};
  expect_color(developed(light, look).exposed[0], {0.9504559f, 1, 1.0890578f}, 1e-6f);
}

TEST(ColorSpace, the_gamut_is_that_of_the_output) {
  // Display P3's green at half its light: Rec. 709 cannot show it.
  DevelopLook p3;
  p3.output.space = OutputSpace::display_p3;
  const auto rgb = linear_srgb(times(to_xyz(OutputSpace::display_p3), {0, 0.5, 0}));
  const Rgb green = {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])};
  expect_color(developed(green, p3).display[0], {0, 0.5f, 0}, 1e-6f);
  EXPECT_LT(green.r, -0.1f);
  const Rgb mapped = developed(green, {}).display[0];
  EXPECT_NEAR(std::min({mapped.r, mapped.g, mapped.b}), 0, 1e-6f);  // at the border of its own gamut
  // Out of this gamut too, mapped in it: luminance stays.
  const Rgb out = developed({-1, 1.1f, -0.2f}, p3).display[0],
            weights = luminance_weights(OutputSpace::display_p3);
  EXPECT_NEAR(weights.r * out.r + weights.g * out.g + weights.b * out.b, luminance({-1, 1.1f, -0.2f}), 1e-6f);
}

TEST(Color, default_colors_differ) {
  for (std::uint32_t a = 1; a <= 12; ++a)
    for (std::uint32_t b = 1; b < a; ++b) {
      const Rgb d = default_color(a) - default_color(b);
      EXPECT_GT(d.r * d.r + d.g * d.g + d.b * d.b, 1e-3f) << a << " and " << b;
    }
}

}  // namespace
}  // namespace nullcone::postrender
