// Time slices that fade, and lamps that blink.
#include <cmath>
#include <limits>
#include <random>

#include "tests/postrender_times.h"

namespace nullcone::postrender {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

TEST(FadingSlices, mix_linearly_in_light_about_their_edges) {
  const json earth = json::parse(R"({"texture":{"type":"color","rgb":[0,0,1]},"time_slices":[
      {"channel":"t","from":-2,"to":1,"fade":[1,4],"texture":{"type":"color","rgb":[1,0,0]}}]})");
  const std::vector<Rgb> found = light(kTimes, earth);
  for (std::size_t i = 0; i < kTimes.size(); ++i) {
    const float t = kTimes[i], here = std::clamp(0.5f + (t + 2), 0.0f, 1.0f),
                left = std::clamp(0.5f - (t - 1) / 4, 0.0f, 1.0f), share = std::min(here, left);
    expect_color(found[i], {share, 0, 1 - share}, 1e-6f);
  }
}

TEST(FadingSlices, lie_over_those_that_follow) {
  // Half of the first, half of the rest by the second, which goes by the other clock (tau = 1001 at t = -1).
  const json earth = json::parse(R"({"texture":{"type":"color","rgb":[0,0,1]},"time_slices":[
      {"channel":"t","from":-1,"fade":1,"texture":{"type":"color","rgb":[1,0,0]}},
      {"channel":"tau","to":1001,"fade":1,"texture":{"type":"color","rgb":[0,1,0]}}]})");
  expect_color(light({-1}, earth)[0], {0.5f, 0.25f, 0.25f}, 1e-6f);
  expect_color(light({-5}, earth)[0], {0, 1, 0}, 0);
  expect_color(light({5}, earth)[0], {1, 0, 0}, 0);
}

TEST(FadingSlices, that_are_many_at_once_are_refused) {
  json slices = json::array();
  for (int i = 0; i < 17; ++i)
    slices.push_back({{"channel", "t"}, {"from", 0.001 * i}, {"fade", 1}, {"texture", color(1, 1, 1)}});
  const std::string found = complaint([&] { light({0}, {{"time_slices", slices}}); });
  EXPECT_NE(found.find("look.json: /objects/earth/time_slices: more than 16"), std::string::npos) << found;
  slices.erase(16);
  EXPECT_EQ(complaint([&] { light({0}, {{"time_slices", slices}}); }), "");
}

TEST(ManySlices, are_found_as_one_by_one) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-10, 10);
  for (const double longest_fade : {0.0, 0.2}) {
    std::vector<Slice> slices;
    for (std::size_t i = 0; i < 300; ++i) {
      const double from = any(random), length = 0.5 + std::abs(any(random)) / 100;
      slices.push_back({i % 3 == 0 ? Clock::tau : Clock::t,
                        i == 250 ? -kForever : from,
                        i % 100 == 99 ? kForever : from + length,
                        longest_fade,
                        longest_fade,
                        i + 1,
                        {}});
    }
    if (longest_fade > 0) slices.resize(40);
    const ObjectShading object = {0, 0, SliceTable(slices), {}};
    for (int k = 0; k < 3000; ++k) {
      // Also exactly at edges.
      const Slice& edge = slices[static_cast<std::size_t>(k) % slices.size()];
      const Times times = {k % 5 == 0 ? edge.from : any(random), k % 7 == 0 ? edge.to : any(random)};
      std::vector<double> expected(slices.size() + 1);
      double left = 1;
      for (const Slice& slice : slices) {
        const double time = times.at(slice.clock);
        const double share = left * slice.share(time);
        expected[slice.appearance] += share;
        left -= share;
      }
      expected[0] = left;
      Coats coats;
      const std::size_t count = find_coats(object, times, coats);
      if (longest_fade == 0) {
        ASSERT_EQ(count, 1u);
      }
      std::vector<double> found(expected.size());
      for (std::size_t i = 0; i < count; ++i)
        found[coats[i].appearance] += static_cast<double>(coats[i].share);
      for (std::size_t i = 0; i < found.size(); ++i) ASSERT_NEAR(found[i], expected[i], 1e-7) << i;
    }
  }
}

TEST(Blinking, is_lit_for_its_part_of_each_period) {
  const json lamp = {{"channel", "t"}, {"period", 2}, {"duty", 0.25}, {"phase", 0.125}};
  const std::vector<Rgb> found = light(kTimes, {{"texture", color(1, 1, 1)}, {"blink", lamp}});
  for (std::size_t i = 0; i < kTimes.size(); ++i) {
    double x = (static_cast<double>(kTimes[i]) - 0.25) / 2;
    x -= std::floor(x);
    EXPECT_EQ(found[i].r, x < 0.25 ? 1 : 0) << kTimes[i];
  }
}

TEST(Blinking, fades_linearly_about_its_edges) {
  const Blink lamp = {Clock::t, 4, Number{0.5}, Number{0}, 1, false};
  for (const auto& [t, expected] : {std::pair{0.0, 0.5},
                                    {0.25, 0.75},
                                    {0.5, 1.0},
                                    {1, 1},
                                    {1.75, 0.75},
                                    {2, 0.5},
                                    {2.25, 0.25},
                                    {3, 0},
                                    {3.75, 0.25},
                                    {4, 0.5},
                                    {-2, 0.5}})
    EXPECT_NEAR(lit(lamp, {t, 0}), expected, 1e-12) << t;
  EXPECT_EQ(lit({Clock::t, 1, Number{0}, Number{0}, 1, false}, {0, 0}), 0);
  EXPECT_EQ(lit({Clock::t, 1, Number{1}, Number{0}, 1, false}, {0, 0}), 1);
  for (const double t : {kForever, -kForever, std::nan("")}) EXPECT_EQ(lit(lamp, {t, 0}), 0);
}

TEST(Blinking, keeps_its_phase_at_large_times) {
  // 1e12 periods after the origin, where a float would not know the hour.
  const Blink lamp = {Clock::tau, 1, Number{0.5}, Number{0}, 0, false};
  for (int i = 0; i < 8; ++i) EXPECT_EQ(lit(lamp, {0, 1e12 + i / 8.0}), i < 4 ? 1 : 0) << i;
  Dataset data = make_dataset(8, 1, {{"earth", 1e12}}, [](int column, int) {
    TestHit hit;
    hit.tau = static_cast<float>(column) / 8;
    return std::vector{hit};
  });
  const Image image =
      picture(std::move(data), R"({"objects":{"earth":{"texture":{"type":"color","rgb":[1,1,1]},
      "blink":{"channel":"tau","period":1}}}})");
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(image.exposed[i].r, i < 4 ? 1 : 0) << i;
}

TEST(Blinking, is_black_or_transparent_when_off) {
  json lamp = {{"channel", "t"}, {"period", 1e9}, {"phase", 0.25}};
  const json rest = {{"background", {0, 1, 0}}};
  expect_color(light({-1}, {{"texture", color(1, 0, 0)}, {"blink", lamp}}, rest)[0], {0, 0, 0}, 0);
  lamp["off"] = "transparent";
  expect_color(light({-1}, {{"texture", color(1, 0, 0)}, {"blink", lamp}}, rest)[0], {0, 1, 0}, 0);
}

}  // namespace
}  // namespace nullcone::postrender
