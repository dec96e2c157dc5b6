// Tone curves and automatic exposure.
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "postrender/color.h"
#include "postrender/develop.h"
#include "postrender/exposure.h"
#include "tests/postrender_fixture.h"

namespace nullcone::postrender {
namespace {

DevelopLook look_with(const std::string& text) { return look_of(text, {}).develop; }

TEST(Tone, filmic_is_hables_curve) {
  const auto hable = [](double x) {
    constexpr double A = 0.15, B = 0.50, C = 0.10, D = 0.20, E = 0.02, F = 0.30;
    return (x * (A * x + C * B) + D * E) / (x * (A * x + B) + D * F) - E / F;
  };
  for (const double white : {0.5, 1.0, 5.6, 40.0}) {
    DevelopLook look = look_with(R"({"tone":{"curve":"filmic","white":)" + std::to_string(white) + "}}");
    for (float Y = 1e-6f; static_cast<double>(Y) < white; Y *= 1.31f) {
      const double expected = hable(11.2 / white * static_cast<double>(Y)) / hable(11.2);
      // Float rounding; his formula loses eps/h of it in the dark, ours does not.
      EXPECT_NEAR(static_cast<double>(developed({Y, Y, Y}, look).display[0].g), expected,
                  2e-6 * expected + 1e-15)
          << Y;
    }
    const auto w = static_cast<float>(white);
    expect_color(developed({w, w, w}, look).display[0], {1, 1, 1}, 3e-7f);
  }
  // His own bias: an exposed luminance is doubled, and 11.2 is white.
  EXPECT_NEAR(developed({1, 1, 1}, look_with(R"({"tone":{"curve":"filmic"}})")).display[0].r,
              static_cast<float>(hable(2) / hable(11.2)), 1e-6f);
}

TEST(Tone, a_table_goes_through_its_points) {
  const std::string points = R"("points":[[0.01,0.02],[0.5,0.4],[2,0.9],[7,1]])";
  const DevelopLook straight = look_with(R"({"tone":{"curve":"table",)" + points + "}}"),
                    smooth =
                        look_with(R"({"tone":{"curve":"table","interpolation":"smooth",)" + points + "}}");
  for (const DevelopLook& look : {straight, smooth})
    for (const auto& [L, shown] :
         {std::pair{0.01f, 0.02f}, {0.5f, 0.4f}, {2.0f, 0.9f}, {7.0f, 1.0f}, {1e9f, 1.0f}})
      // Corners are cut by at most L/2048 times the change of slope, which is below 2.
      EXPECT_NEAR(developed({L, L, L}, look).display[0].g, shown, std::min(L, 7.0f) / 1024) << L;
  const auto shown = [](const DevelopLook& look, float L) { return developed({L, L, L}, look).display[0].g; };
  EXPECT_NEAR(shown(straight, 0.005f), 0.01f, 1e-6f);  // straight from (0, 0)
  EXPECT_NEAR(shown(straight, 1.25f), 0.65f, 1e-6f);
  EXPECT_NEAR(shown(straight, 1e-20f), 2e-20f, 1e-26f);
  EXPECT_NEAR(shown(straight, 1e-41f), 2e-41f, 1e-43f);  // denormal
  for (float L = 0.001f; L < 7; L *= 1.07f)
    EXPECT_NEAR(static_cast<double>(shown(smooth, L)), smooth.table.points().at(static_cast<double>(L)), 1e-5)
        << L;
}

TEST(Tone, a_table_is_read_from_csv) {
  const TestFolder folder;
  folder.write("curve.csv", "# L, shown\n0.5, 0.25\r\n\n 1 ,0.75 # knee\n");
  const std::string text = R"({"tone":{"curve":"table","file":"curve.csv"}})";
  EXPECT_EQ(look_of(text, {}, folder.path()).develop,
            look_with(R"({"tone":{"curve":"table","points":[[0.5,0.25],[1,0.75]]}})"));
  const auto found = [&](const std::string& content) {
    folder.write("curve.csv", content);
    return complaint([&] { look_of(text, {}, folder.path()); });
  };
  EXPECT_NE(found("1,1\n2,x\n").find("curve.csv: line 2: expected finite numbers"), std::string::npos);
  EXPECT_NE(found("1,1x\n").find("line 1"), std::string::npos);
  EXPECT_NE(found("nan,1\n").find("line 1"), std::string::npos);
  EXPECT_NE(found("").find("/tone/file: holds fewer than two lines"), std::string::npos);
  EXPECT_NE(complaint([&] { look_of(text, {}, folder.file("none")); }).find("no such file"),
            std::string::npos);
}

/// Shuffled luminances 0 to 1000: 617 and 1001 have no common divisor.
Radiance shuffled() {
  Radiance radiance;
  for (int i = 0; i <= 1000; ++i) {
    const auto Y = static_cast<float>((i * 617) % 1001);
    radiance.physical.emplace_back(Y, Y, Y);
  }
  return radiance;
}

TEST(Exposure, auto_white_is_the_99th_percentile_of_lit_pixels) {
  // 1000 lit pixels, 1 to 1000; position floor(0.99 * 999) = 989 holds 990.
  EXPECT_NEAR(auto_white_cd_m2(shuffled()), 990, 1e-3);
  for (const double percentile : {0.0, 50.0, 100.0})  // positions 0, 499, 999
    EXPECT_NEAR(auto_white_cd_m2(shuffled(), {.percentile = percentile}), 1 + std::floor(percentile * 9.99),
                1e-3);
  EXPECT_EQ(auto_white_cd_m2({{}, std::vector<Rgbx>(2)}), 1);
}

TEST(Exposure, percentiles_are_exact_among_neighbours) {
  std::mt19937 random(1);
  Radiance radiance;
  std::vector<float> sorted;
  for (int i = 0; i < 50000; ++i) {  // several blocks; all within one bin of the upper bits
    const float Y = 3 + 0.001f * std::uniform_real_distribution<float>()(random);
    radiance.physical.emplace_back(Y, Y, Y);
    sorted.push_back(luminance(radiance.physical.back()));
  }
  std::ranges::sort(sorted);
  for (const double percentile : {0.0, 12.5, 99.0, 100.0})
    EXPECT_EQ(auto_white_cd_m2(radiance, {.percentile = percentile}),
              static_cast<double>(sorted[static_cast<std::size_t>(percentile / 100 * 49999)]));
}

TEST(Exposure, log_average_shows_the_geometric_mean_as_the_key) {
  // Reinhard et al. 2002: of 2^-60 ... 2^60 alike the geometric mean is 1.
  Radiance radiance;
  for (int i = 0; i < 121 * 200; ++i) {
    const float Y = std::ldexp(1.0f, i % 121 - 60);
    radiance.physical.emplace_back(Y, Y, Y);
  }
  for (const float dark : {0.0f, -1.0f, std::nanf(""), INFINITY})
    radiance.physical.emplace_back(dark, dark, dark);
  const AutoWhite average{.mode = AutoWhite::Mode::log_average, .key = 0.25};
  EXPECT_NEAR(auto_white_cd_m2(radiance, average), 4, 1e-6);  // weights of luminance round to 1e-7
  EXPECT_EQ(auto_white_cd_m2({{}, std::vector<Rgbx>(2)}, average), 1);
  radiance.physical.assign(3, Rgbx{1e-45f, 1e-45f, 1e-45f});  // denormal
  EXPECT_NEAR(auto_white_cd_m2(radiance, average) / 4, 1.4e-45, 1e-46);
}

TEST(Exposure, does_not_depend_on_threads) {
  std::mt19937 random(2);
  Radiance radiance;
  for (int i = 0; i < 100000; ++i) {
    const float Y = std::exp(std::normal_distribution<float>(0, 5)(random));
    radiance.physical.emplace_back(Y, 2 * Y, 0.1f);
  }
  for (const AutoWhite& exposure : {AutoWhite{}, AutoWhite{.mode = AutoWhite::Mode::log_average}}) {
    const auto with = [&](std::size_t threads) {
      const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
      return auto_white_cd_m2(radiance, exposure);
    };
    EXPECT_EQ(with(1), with(2));
  }
}

}  // namespace
}  // namespace nullcone::postrender
