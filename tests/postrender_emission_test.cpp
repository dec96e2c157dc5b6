// Numbers with keyframes by the time of emission, and what looks may say of time.
#include <tbb/global_control.h>

#include <cmath>
#include <random>

#include "postrender/color.h"
#include "postrender/needed_channels.h"
#include "tests/postrender_times.h"

namespace nullcone::postrender {
namespace {

TEST(Keyframed, opacity_and_intensity_are_exact) {
  const json keys = json::parse("[[-2,0.25],[0,0.75]]");
  const auto expected = [](float t) { return std::clamp(0.25f + 0.25f * (t + 2), 0.25f, 0.75f); };
  const json green = {{"background", {0, 1, 0}}};
  const std::vector<Rgb> clear =
                             light(kTimes, {{"texture", color(1, 0, 0)}, {"opacity", by("t", keys)}}, green),
                         dim = light(kTimes, {{"texture", color(1, 0, 0)}, {"intensity", by("t", keys)}},
                                     green);
  for (std::size_t i = 0; i < kTimes.size(); ++i) {
    const float a = expected(kTimes[i]);
    expect_color(clear[i], {a, 1 - a, 0}, 1e-6f);
    expect_color(dim[i], {a, 0, 0}, 1e-6f);
  }
  expect_color(light({0}, {{"texture", color(1, 0, 0)}, {"intensity", 3}})[0], {3, 0, 0}, 0);
}

TEST(Keyframed, temperature_is_that_of_its_time_with_all_effects) {
  for (const bool doppler : {false, true})
    for (const bool searchlight : {false, true}) {
      const json rest = {{"effects", {{"doppler", doppler}, {"searchlight", searchlight}}},
                         {"exposure", {{"white_cd_m2", 1e9}}}};
      const auto seen_at = [&](const json& temperature, float t) {
        Dataset data = line_of_times({t});
        data.hits.shift[0] = 0.8f;
        json look = {{"objects",
                      {{"earth", {{"spectrum", {{"type", "black_body"}, {"temperature_K", temperature}}}}}}}};
        look.update(rest);
        return picture(std::move(data), look.dump()).exposed[0];
      };
      for (const float t : {-2.0f, -1.5f, -0.3f, 5.0f}) {
        const double T = 2000 + 6000 * std::clamp((static_cast<double>(t) + 2) / 2, 0.0, 1.0);
        const Rgb found = seen_at(by("t", {{-2, 2000}, {0, 8000}}), t), expected = seen_at(T, t);
        expect_color(found, expected, 1e-4f * expected.r);  // twice the error of the table
      }
    }
}

TEST(Keyframed, colors_are_within_half_a_code) {
  std::vector<float> times;
  for (int i = 0; i <= 1000; ++i) times.push_back(static_cast<float>(i) / 1000);
  const json keys = json::parse("[[0,0],[1,1]]");
  const json look = {{"texture", {{"type", "color"}, {"rgb", {by("t", keys), 0.5, 1}}}}};
  const std::vector<Rgb> found = light(times, look);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double code = 255 * srgb_encoded(static_cast<double>(found[i].r));
    EXPECT_NEAR(code, 255 * static_cast<double>(times[i]), 0.5) << times[i];
    EXPECT_EQ(found[i].b, 1);
  }
}

TEST(Keyframed, places_move_exactly_and_by_the_clock_that_they_name) {
  const json board = json::parse(R"({"type":"checkerboard","counts":[4,2],"colors":[[1,1,1],[0,0,0]]})");
  for (const char* clock : {"t", "tau"})
    for (const char* key : {"offset", "scale"}) {
      const bool tau = std::string(clock) == "tau";
      json moving = board;
      moving[key] = {by(clock, {{-1000, -1001}, {2000, 1999}}), 1};
      for (const float t : kTimes) {
        json still = board;  // value = time - 1
        still[key] = {(tau ? 2 * static_cast<double>(t) + 1003 : static_cast<double>(t)) - 1, 1};
        EXPECT_EQ(light({t}, {{"texture", moving}})[0], light({t}, {{"texture", still}})[0])
            << clock << key << t;
      }
    }
  // A clock's hand: a turn in four units of its own time.
  json turning = board;
  turning["rotate_deg"] = {0, 0, by("tau", {{0, 0}, {4000, 360000}})};
  for (const float t : kTimes) {
    json still = board;
    still["rotate_deg"] = {0, 0, 90 * (2 * static_cast<double>(t) + 1003)};
    EXPECT_EQ(light({t}, {{"texture", turning}})[0], light({t}, {{"texture", still}})[0]);
  }
}

TEST(Keyframed, counts_of_squares_are_whole) {
  json board = json::parse(R"({"type":"checkerboard","colors":[[1,1,1],[0,0,0]]})");
  board["counts"] = {by("t", {{0, 2}, {10, 12}}), 1};
  for (const int t : {0, 3, 10}) {
    json still = board;
    still["counts"] = {t + 2, 1};
    EXPECT_NEAR(light({static_cast<float>(t)}, {{"texture", board}})[0].r,
                light({static_cast<float>(t)}, {{"texture", still}})[0].r, 0.51f);
  }
  board["counts"] = {by("t", {{0, 0}}), 1};
  EXPECT_NE(complaint([&] {
              light({0}, {{"texture", board}});
            }).find("/objects/earth/texture/counts"),
            std::string::npos);
}

TEST(TimeLooks, that_make_no_sense_are_refused) {
  const auto refused = [](const std::string& earth, const std::string& place) {
    const std::string found = complaint([&] { light({0}, json::parse(earth)); });
    EXPECT_NE(found.find("look.json: /objects/earth/" + place), std::string::npos)
        << earth << " -> " << found;
  };
  refused(R"({"blink":{"channel":"t"}})", "blink/period:");
  refused(R"({"blink":{"period":1}})", "blink/channel:");
  refused(R"({"blink":{"channel":"t","period":0}})", "blink/period:");
  refused(R"({"blink":{"channel":"t","period":1,"duty":1.5}})", "blink/duty:");
  refused(R"({"blink":{"channel":"t","period":1,"fade":-1}})", "blink/fade:");
  refused(R"({"blink":{"channel":"t","period":1,"off":"grey"}})", "blink/off:");
  refused(R"({"intensity":-1})", "intensity:");
  refused(R"({"intensity":{"keyframes":[[0,1],[1,-1]],"by":"t"}})", "intensity/keyframes/1:");
  refused(R"({"intensity":{"keyframes":[[0,1],[0,1]],"by":"t"}})", "intensity/keyframes/1:");
  refused(R"({"opacity":{"keyframes":[[0,2]],"by":"tau"}})", "opacity/keyframes/0:");
  refused(R"({"opacity":{"keyframes":[[0,1]]}})", "opacity/by:");
  refused(R"({"spectrum":{"type":"black_body","temperature_K":{"keyframes":[[0,0.5]],"by":"t"}}})",
          "spectrum/temperature_K/keyframes/0:");
  refused(R"({"texture":{"type":"color","rgb":[{"keyframes":[[0,0],[1,2]],"by":"t"},0,0]}})",
          "texture/rgb/0:");
  refused(
      R"({"texture":{"type":"color","rgb":[{"keyframes":[[0,0]],"by":"t"},{"keyframes":[[0,0]],"by":"tau"},0]}})",
      "texture:");
  refused(R"({"time_slices":[{"channel":"t","from":0,"fade":-1,"intensity":1}]})", "time_slices/0/fade:");
  refused(R"({"time_slices":[{"channel":"t","from":0,"fade":[1],"intensity":1}]})", "time_slices/0/fade:");
}

TEST(TimeLooks, need_the_clocks_that_they_go_by) {
  Manifest manifest;
  manifest.objects = {{"earth"}};
  const auto missing = [&](const std::string& earth, const char* channel) {
    const Look look = look_of(R"({"objects":{"earth":)" + earth + "}}", manifest);
    EXPECT_TRUE(needed_channels(look, manifest).has(channel)) << earth;
    const char* other = std::string(channel) == "t" ? "tau" : "t";
    EXPECT_FALSE(needed_channels(look, manifest).has(other)) << earth;
    ChannelSet there = kAllChannels;
    there.bits &= ~ChannelSet::of(channel).bits;
    return complaint([&] { check_channels(look, manifest, there, "a.exr"); });
  };
  const std::string keys = R"({"keyframes":[[0,0.1],[1,0.2]],"by":"tau"})";
  for (const auto& [entry, place] :
       {std::pair{R"("opacity":)" + keys, "/opacity;"},
        {R"("intensity":)" + keys, "/intensity;"},
        {R"("blink":{"channel":"tau","period":1})", "/blink;"},
        {R"("blink":{"channel":"tau","period":1,"duty":)" + keys + "}", "/blink;"},
        {R"("texture":{"type":"color","rgb":[)" + keys + ",0,0]}", "/texture;"},
        {R"("texture":{"type":"image","file":"a.png","offset":[)" + keys + ",0]}", "/texture;"},
        {R"("texture":{"type":"image","file":"a#.png","sequence":{"frames":[0,3],"clock":"tau"}})",
         "/texture;"},
        {R"("time_slices":[{"channel":"tau","blink":{"channel":"tau","period":1}}])", "/time_slices/0;"},
        {R"("spectrum":{"type":"black_body","temperature_K":{"keyframes":[[0,10],[1,20]],"by":"tau"}})",
         "/spectrum;"}})
    EXPECT_NE(missing("{" + entry + "}", "tau")
                  .find("'tau', which the look needs for /objects/earth" + std::string(place)),
              std::string::npos)
        << entry;
}

/// Everything at once, over times and places of all kinds.
TEST(TimeLooks, give_numbers_everywhere_and_the_same_with_all_kernels_and_threads) {
  const std::vector<float> odd = {NAN, INFINITY, -INFINITY, 3e38f, -3e38f, 1e-42f, 0, -1.25f, 2, 1e7f};
  std::mt19937 random(5);
  const auto any = [&] { return odd[random() % odd.size()]; };
  const Dataset data = make_dataset(90, 40, {{"earth", 1e15}, {"moon"}}, [&](int column, int row) {
    TestHit near, far;
    near.t = any(), near.tau = any(), near.u = any(), near.v = any();
    near.id = (column / 7 + row) % 2 == 0 ? 1 : 2;
    near.shift = column % 5 == 0 ? any() : 0.7f;
    far.id = 2;
    far.t = any(), far.u = 0.01f * static_cast<float>(column), far.v = 0.4f;
    return std::vector{near, far};
  });
  const std::string text =
      R"({"background":[0.2,0.2,0.2],"exposure":{"white_cd_m2":1e9},"effects":{"searchlight":false},"objects":{
    "earth":{"opacity":{"keyframes":[[-1e100,1],[0,0.2],[1e100,1]],"by":"tau","interpolation":"smooth"},
      "intensity":{"keyframes":[[-2,0],[2,1e12]],"by":"t"},
      "blink":{"channel":"tau","period":PERIOD,"duty":0.3,"fade":1e-308,"off":"transparent"},
      "texture":{"type":"checkerboard","counts":[9,4],"colors":[[1,1,1],[0,0,0.5]],
        "rotate_deg":[{"keyframes":[[-1,-1e9],[1,1e9]],"by":"t"},20,5],"offset":[{"keyframes":[[0,-1e4],[1e-300,1e4]],"by":"t"},0]},
      "spectrum":{"type":"black_body","temperature_K":{"keyframes":[[-1,1],[1,1e9]],"by":"t"}}},
    "moon":{"texture":{"type":"color","rgb":[{"keyframes":[[-1e100,0],[1e100,1]],"by":"t"},1,1]},
      "time_slices":[{"channel":"t","from":-1.7e308,"to":1.7e308,"fade":[1.7e308,1e-308],"texture":{"type":"color","rgb":[1,0,0]}},
                     {"channel":"tau","from":0,"fade":3,"blink":{"channel":"t","period":1.7e308}}]}}})";
  for (const char* period : {"1e-300", "7", "1e300"}) {
    std::string look = text;
    look.replace(look.find("PERIOD"), 6, period);
    Image first;
    for (const Kernel* kernel : kernels())
      for (const std::size_t threads : {1u, 2u}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        Renderer renderer(data, *kernel);
        const Image image = renderer.render(look_of(look, renderer.manifest()));
        for (const Rgb c : image.exposed)
          ASSERT_TRUE(std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b)) << c.r << " " << c.b;
        if (first.exposed.empty()) first = image;
        EXPECT_EQ(image.exposed, first.exposed) << kernel->isa << threads;
      }
    // Short periods at 1e15 are not counted any more; of others the lamp is seen.
    const bool dark = std::ranges::all_of(first.exposed, [](const Rgb& c) { return c.b <= 1; });
    EXPECT_EQ(dark, std::string(period) == "1e-300");
  }
}

}  // namespace
}  // namespace nullcone::postrender
