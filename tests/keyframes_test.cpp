// Numbers that change with time, frames and their files, and looks told in full.
#include "core/base/keyframes.h"

#include "postrender/frames.h"
#include "postrender/look_source.h"
#include "tests/postrender_fixture.h"

namespace nullcone::postrender {
namespace {

using nlohmann::json;

Keyframes keyframes(const std::string& text) { return parse_keyframes(json::parse(text), "look.json", "/x"); }

TEST(Keyframes, are_held_outside_and_linear_between) {
  const Keyframes keys = keyframes(R"({"keyframes":[[10,1],[20,3],[40,-1]]})");
  EXPECT_EQ(keys.at(-5), 1);
  EXPECT_EQ(keys.at(10), 1);
  EXPECT_EQ(keys.at(12.5), 1.5);
  EXPECT_EQ(keys.at(20), 3);
  EXPECT_EQ(keys.at(30), 1);
  EXPECT_EQ(keys.at(41), -1);
}

TEST(Keyframes, smooth_ones_pass_through_the_keys_without_corners_and_overshoot) {
  const Keyframes keys =
      keyframes(R"({"keyframes":[[0,0],[1,1],[2,10],[3,10],[7,2]],"interpolation":"smooth"})");
  for (std::size_t i = 0; i < keys.times.size(); ++i) EXPECT_EQ(keys.at(keys.times[i]), keys.values[i]);
  constexpr double kStep = 1e-4;
  for (double t = 0; t < 7; t += 0.01) {
    const auto next = static_cast<std::size_t>(std::ranges::upper_bound(keys.times, t) - keys.times.begin());
    const auto [low, high] = std::minmax(keys.values[next - 1], keys.values[next]);
    EXPECT_GE(keys.at(t), low - 1e-12) << t;
    EXPECT_LE(keys.at(t), high + 1e-12) << t;
  }
  // Slopes from both sides of a key agree: to second order in the step, so within some times the step.
  for (const double t : {1.0, 2.0, 3.0}) {
    const double before = (keys.at(t) - keys.at(t - kStep)) / kStep,
                 after = (keys.at(t + kStep) - keys.at(t)) / kStep;
    EXPECT_NEAR(before, after, 100 * kStep) << t;
  }
  EXPECT_NE(keys.at(0.5), 0.5) << "not linear";
}

TEST(Keyframes, that_make_no_sense_are_refused_with_their_place) {
  for (const auto& [text, place] : {std::pair{R"({"keyframes":[]})", "/x/keyframes"},
                                    {R"({"keyframes":5})", "/x/keyframes"},
                                    {R"({"keyframes":[[0,1],[0,2]]})", "/x/keyframes/1"},
                                    {R"({"keyframes":[[1,1],[0,2]]})", "/x/keyframes/1"},
                                    {R"({"keyframes":[[0,1,2]]})", "/x/keyframes/0"},
                                    {R"({"keyframes":[[0,"1"]]})", "/x/keyframes/0"},
                                    {R"({"keyframes":[[0,1]],"interpolation":"cubic"})", "/x/interpolation"},
                                    {R"({"keyframes":[[0,1]],"by":"mu"})", "/x/by"},
                                    {R"({"keyframes":[[0,1]],"key":1})", "/x/key"}})
    EXPECT_NE(complaint([&] { keyframes(text); }).find("look.json: " + std::string(place) + ":"),
              std::string::npos)
        << text << " -> " << complaint([&] { keyframes(text); });
}

TEST(Keyframes, stand_for_any_number_of_a_look_but_those_by_emission_stay) {
  const json look = json::parse(R"({
    "objects": {"earth": {"texture": {"type": "color", "rgb": [0, {"keyframes":[[0,0],[10,1]]}, 1]}}},
    "exposure": {"ev": {"keyframes":[[0,-2],[4,2]]}},
    "later": {"keyframes":[[0,1],[1,2]], "by": "tau"}})");
  const json now = at_frame(look, 3, "look.json", "");
  EXPECT_EQ(now["objects"]["earth"]["texture"]["rgb"], json::parse("[0,0.3,1]"));
  EXPECT_EQ(now["exposure"]["ev"], 1);
  EXPECT_EQ(now["later"], look["later"]);
}

TEST(Frames, are_read_from_lists_of_runs) {
  EXPECT_EQ(parse_frames("7"), (std::vector{7}));
  EXPECT_EQ(parse_frames("0-3"), (std::vector{0, 1, 2, 3}));
  EXPECT_EQ(parse_frames("0-11:5"), (std::vector{0, 5, 10}));
  EXPECT_EQ(parse_frames("3,7,9-12"), (std::vector{3, 7, 9, 10, 11, 12}));
  for (const char* text : {"", ",", "1,", "a", "-3", "3-", "5-3", "0-9:0", "0-9:", "3:2", "1-2-3", "1 ",
                           "1e3", "3,3", "0-5,2", "1000000000", "99999999999999999999", "0-1000000"})
    EXPECT_NE(complaint([&] { parse_frames(text); }), "") << text;
}

TEST(Frames, stand_in_names_padded_with_zeros) {
  EXPECT_EQ(numbered("a.png", 7, "-o"), "a.png");
  EXPECT_EQ(numbered("a.####.png", 7, "-o"), "a.0007.png");
  EXPECT_EQ(numbered("#", 7, "-o"), "7");
  EXPECT_EQ(numbered("a.##.png", 12345, "-o"), "a.12345.png");
  EXPECT_EQ(complaint([&] { numbered("##/#.png", 1, "-o"); }),
            "-o: '##/#.png' has # in two places; expected one run of them");
}

TEST(Frames, check_their_files_before_any_work) {
  const TestFolder folder;
  const auto path = [&](const char* name) { return folder.file(name); };
  for (const char* name : {"d.0.exr", "d.1.exr", "look.json"}) folder.write(name, "x");
  const auto files = files_of({path("d.#.exr"), {path("look.json")}, path("o.##.png")}, {0, 1});
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[1].frame, 1);
  EXPECT_EQ(files[1].data, path("d.1.exr"));
  EXPECT_EQ(files[1].picture, path("o.01.png"));
  const auto refused = [&](const FramePatterns& patterns, const std::vector<int>& frames, const char* words) {
    const std::string found = complaint([&] { files_of(patterns, frames); });
    EXPECT_NE(found.find(words), std::string::npos) << found;
  };
  refused({path("d.#.exr"), {}, path("o.png")}, {0, 1}, "several frames would be written");
  refused({path("d.#.exr"), {}, path("d.#.exr")}, {0, 1}, "is an input too");
  refused({path("d.#.exr"), {}, folder.path() + "/./d.1.exr"}, {1}, "is an input too");
  refused({path("d.#.exr"), {}, path("o.#.png")}, {0, 1, 2, 3}, "d.2.exr: is not there; nor are 1 more: ");
}

TEST(LookInFull, gives_the_same_picture) {
  Manifest manifest = flat_map(8, 4).manifest;
  const auto document = [&](const json& look, const std::string& pointer) {
    return LookDocument{std::make_shared<const json>(look), {"look.json", pointer, ""}};
  };
  for (
      const char* text :
      {R"({})", R"({"exposure":{"ev":{"keyframes":[[0,0],[10,-5]]}},"effects":{"doppler":false}})",
       R"({"objects":{"earth":{"spectrum":{"type":"black_body","temperature_K":{"keyframes":[[0,3000],[10,9000]]}},
            "time_slices":[{"channel":"t","from":-2,"spectrum":{"type":"display"}}]}},"tone":{"curve":"exponential"}})",
       R"({"objects":{"earth":{"texture":{"type":"checkerboard","counts":[4,2],
            "gradient":{"along":"u","from":[1,1,0],"to":[0,0,1]}}}},"pixel_filter":{"type":"gaussian"},
            "background":[0.25,0.5,1],"legend":{"time":{"start":3,"step":0.5}}})"})
    for (const std::string pointer : {"", "/look"}) {
      LookInFull in_full, again;
      const Look look = look_at(document(json::parse(text), pointer), manifest, 7, &in_full);
      const json full = json::parse(in_full.text);
      for (const char* entry :
           {"objects", "effects", "pixel_filter", "exposure", "tone", "gamut", "background"})
        EXPECT_TRUE(full.contains(entry)) << entry << " of " << text;
      EXPECT_EQ(full["objects"]["earth"]["opacity"], 1);
      const Look same = look_at(document(full, ""), manifest, 0, &again);
      EXPECT_EQ(again.text, in_full.text) << "in full of in full";
      Renderer one(flat_map(8, 4)), two(flat_map(8, 4));
      EXPECT_EQ(one.render(look).display, two.render(same).display) << text;
      EXPECT_EQ(look.legend.lines, same.legend.lines);
    }
}

TEST(LookInFull, knows_keys_words_and_files) {
  const Manifest manifest = flat_map(2, 2).manifest;
  LookInFull in_full;
  look_at({std::make_shared<const json>(
               json::parse(R"({"objects":{"earth":{"texture":{"type":"image","file":"a.png"}}}})")),
           {"d.exr", "/look", "maps"}},
          manifest, 0, &in_full);
  EXPECT_EQ(in_full.files.named, (std::set<std::string>{"maps/a.png"}));
  EXPECT_TRUE(in_full.survey.keys["/look/objects/earth"].contains("time_slices"));
  EXPECT_EQ(in_full.survey.words["/look/gamut"], (std::vector<std::string>{"hue_preserving", "clip"}));
  const json full = json::parse(in_full.text);
  EXPECT_TRUE(std::filesystem::path(full["objects"]["earth"]["texture"]["file"]).is_absolute());
}

TEST(LookInFull, knows_the_pictures_of_films_but_not_their_pattern) {
  LookInFull in_full;
  look_at({std::make_shared<const json>(json::parse(R"({"objects":{"earth":{"texture":{"type":"image",
               "file":"f_##.png","sequence":{"frames":[9,10]}}}}})")),
           {"d.exr", "/look", "maps"}},
          flat_map(2, 2).manifest, 0, &in_full);
  EXPECT_EQ(in_full.files.named, std::set<std::string>{});
  EXPECT_EQ(in_full.files.numbered, (std::set<std::string>{"maps/f_09.png", "maps/f_10.png"}));
}

TEST(Legend, tells_time_and_temperature_of_the_frame) {
  const Manifest manifest = flat_map(2, 2).manifest;
  const auto lines = [&](const std::string& legend, int frame) {
    const json look = json::parse(
        R"({"objects":{"earth":{"spectrum":{"type":"black_body","temperature_K":{"keyframes":[[0,1000],[10,2000]]}}}},
            "legend":)" +
        legend + "}");
    return look_at({std::make_shared<const json>(look), {"look.json", "", ""}}, manifest, frame).legend.lines;
  };
  EXPECT_EQ(lines(R"({"time":true,"temperature":"earth"})", 5),
            (std::vector<std::string>{"t = 5.00", "T = 1500 K"}));
  EXPECT_EQ(lines(R"({"time":{"start":-1,"step":0.25,"unit":"s","label":"","digits":1}})", 2),
            (std::vector<std::string>{"-0.5 s"}));
  EXPECT_EQ(lines(R"({"temperature":"objects.earth.spectrum.temperature_K"})", 0),
            lines(R"({"temperature":"earth"})", 0));
  for (const auto& [legend, place] : {std::pair{R"({"temperature":"moon"})", "/legend/temperature"},
                                      {R"({"temperature":"/objects/earth"})", "/legend/temperature"},
                                      {R"({"time":{"stop":1}})", "/legend/time/stop"},
                                      {R"({"time":{"unit":"µs"}})", "/legend/time/unit"},
                                      {R"({"scale":{"object":"moon"}})", "/legend/scale/object"},
                                      {R"({"scale":{"object":"earth","from":2,"to":1}})", "/legend/scale/to"},
                                      {R"({"corner":"middle"})", "/legend/corner"}})
    EXPECT_NE(complaint([&] { lines(legend, 0); }).find("look.json: " + std::string(place) + ":"),
              std::string::npos)
        << legend << " -> " << complaint([&] { lines(legend, 0); });
}

TEST(Renderer, siblings_give_the_same_pictures) {
  Renderer first(flat_map(40, 20));
  Renderer second = first.sibling();
  const Look look = look_of(R"({"objects":{"earth":{"texture":{"type":"checkerboard","counts":[4,2],
      "colors":[[1,0,0],[0,1,1]]}}}})",
                            first.manifest());
  EXPECT_EQ(first.render(look).display, second.render(look).display);
  EXPECT_EQ(&first.dataset(), &second.dataset());
}

}  // namespace
}  // namespace nullcone::postrender
