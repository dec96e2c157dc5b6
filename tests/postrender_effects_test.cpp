// The four combinations of effects against direct integration over wavelengths, and time slices.
#include <cmath>

#include "postrender/black_body.h"
#include "postrender/cie1931.h"
#include "tests/postrender_fixture.h"

namespace nullcone::postrender {
namespace {

/// Linear sRGB in cd/m^2 of what is seen of a black body, straight from the definition: no g T anywhere.
std::array<double, 3> integrated(double T, double g, bool doppler, bool searchlight) {
  const double power = doppler && searchlight ? std::pow(g, 5) : searchlight ? std::pow(g, 4) : 1.0;
  constexpr int kParts = 100;  // midpoints within each 5 nm
  Xyz sum{};
  for (int i = 0; i < kParts * static_cast<int>(kCmfSamples - 1); ++i) {
    const double nm = kCmfFirst_nm + (i + 0.5) * kCmfStep_nm / kParts;
    const auto k = static_cast<std::size_t>(i / kParts);
    const double L = power * planck_W_m3_sr(1e-9 * (doppler ? g * nm : nm), T);
    for (std::size_t j = 0; j < 3; ++j) {
      const double cmf = std::lerp(kCie1931[k][j], kCie1931[k + 1][j], (i % kParts + 0.5) / kParts);
      sum[j] += 683 * 5e-9 / kParts * cmf * L;
    }
  }
  return linear_srgb(sum);
}

TEST(Effects, agree_with_direct_integration) {
  for (const double T : {1500.0, 5762.0, 20000.0})
    for (const float g : {0.3f, 0.8f, 1.0f, 1.7f, 6.0f})
      for (const bool doppler : {false, true})
        for (const bool searchlight : {false, true}) {
          const auto expected = integrated(T, static_cast<double>(g), doppler, searchlight);
          const Rgb found = seen(R"({"type":"black_body","temperature_K":)" + std::to_string(T) + "}",
                                 {1, 1, 1}, g, {doppler, searchlight, {}, {}});
          const double scale = std::max({std::abs(expected[0]), expected[1], expected[2]});
          // 3e-6: the midpoint rule at 450 K (1500 K, g = 0.3); everything else is below 5e-7.
          EXPECT_NEAR(static_cast<double>(found.r), expected[0], 3e-6 * scale)
              << T << " " << g << doppler << searchlight;
          EXPECT_NEAR(static_cast<double>(found.g), expected[1], 3e-6 * scale)
              << T << " " << g << doppler << searchlight;
          EXPECT_NEAR(static_cast<double>(found.b), expected[2], 3e-6 * scale)
              << T << " " << g << doppler << searchlight;
        }
}

TEST(Effects, display_colors_are_beamed_but_not_shifted) {
  const Rgb c{0.5f, 0.25f, 0.125f};
  const std::string display = R"({"type":"display"})";
  EXPECT_EQ(seen(display, c, 2.0f, {true, false, {}, {}}), c);
  EXPECT_EQ(seen(display, c, 2.0f, {false, false, {}, {}}), c);
  expect_color(seen(display, c, 2.0f, {false, true, {}, {}}), 16.0f * c, 1e-6f * 8);
  expect_color(seen(display, c, 0.5f, {true, true, {}, {}}), 0.0625f * c, 1e-6f * 0.03f);
}

TEST(Effects, senseless_shifts_are_black) {
  for (const float g : {0.0f, -1.0f, std::nanf(""), INFINITY})
    for (const char* spectrum : {R"({"type":"black_body","temperature_K":5000})", R"({"type":"rgb"})",
                                 R"({"type":"lines","lines":[[500,1]]})", R"({"type":"total_radiance"})"})
      EXPECT_EQ(seen(spectrum, {1, 1, 1}, g), Rgb{}) << spectrum;
}

TEST(Effects, a_texture_filters_a_black_body) {
  const std::string sun = R"({"type":"black_body","temperature_K":5762})";
  const Rgb bare = seen(sun, {1, 1, 1}, 1), filtered = seen(sun, {0.5f, 0, 1}, 1);
  EXPECT_EQ(filtered, (Rgb{0.5f * bare.r, 0, bare.b}));
}

TEST(Effects, white_is_the_luminance_shown_as_one) {
  const double luminance_cd_m2 = black_body_xyz(5762)[1];
  const std::string look = R"({"objects":{"earth":{"spectrum":{"type":"black_body","temperature_K":5762}}},)"
                           R"("exposure":{"white_cd_m2":)" +
                           std::to_string(2 * luminance_cd_m2) + "}}";
  const Image image = picture(one_pixel({{}}), look);
  EXPECT_NEAR(luminance(image.exposed[0]), 0.5f, 3e-5f);
  // One stop up is twice as bright.
  nlohmann::json up = nlohmann::json::parse(look);
  up["exposure"]["ev"] = 1;
  EXPECT_NEAR(luminance(picture(one_pixel({{}}), up.dump()).exposed[0]), 1.0f, 6e-5f);
}

/// The colours of two slices and of the object itself, by the clock that is looked at.
Rgb at_time(const std::string& channel, float t, float tau, double tau_origin) {
  TestHit hit;
  hit.t = t;
  hit.tau = tau;
  const std::string look = R"({"objects":{"earth":{"texture":{"type":"color","rgb":[1,0,0]},"time_slices":[
    {"channel":")" + channel +
                           R"(","from":-3,"to":-2,"texture":{"type":"color","rgb":[0,1,0]}},
    {"channel":")" + channel +
                           R"(","from":-2.5,"to":1,"texture":{"type":"color","rgb":[0,0,1]}}]}}})";
  return picture(one_pixel({hit}, {{"earth", tau_origin}}), look).display[0];
}

TEST(TimeSlices, hold_from_their_start_up_to_their_end) {
  const Rgb red{1, 0, 0}, green{0, 1, 0}, blue{0, 0, 1};
  EXPECT_EQ(at_time("t", std::nextafter(-3.0f, -4.0f), 0, 0), red);
  EXPECT_EQ(at_time("t", -3, 0, 0), green);      // the start belongs to the slice
  EXPECT_EQ(at_time("t", -2.25f, 0, 0), green);  // the first slice that holds wins
  EXPECT_EQ(at_time("t", -2, 0, 0), blue);       // the end does not
  EXPECT_EQ(at_time("t", std::nextafter(1.0f, 0.0f), 0, 0), blue);
  EXPECT_EQ(at_time("t", 1, 0, 0), red);
}

TEST(TimeSlices, tau_is_the_clock_of_the_object) {
  EXPECT_EQ(at_time("tau", 5, -102, 100), (Rgb{0, 0, 1}));  // -102 + 100 = -2
  EXPECT_EQ(at_time("tau", -3, 0, 100), (Rgb{1, 0, 0}));
}

TEST(TimeSlices, inherit_what_they_leave_out) {
  const std::string look = R"({"objects":{"earth":{"texture":{"type":"color","rgb":[1,0,0]},
    "time_slices":[{"channel":"t","spectrum":{"type":"black_body","temperature_K":5000}}]}}})";
  const Image image = picture(one_pixel({{}}), look);
  EXPECT_GT(image.white_cd_m2, 1e6);
  EXPECT_EQ(image.exposed[0].b, 0);  // the red texture filters the black body
}

}  // namespace
}  // namespace nullcone::postrender
