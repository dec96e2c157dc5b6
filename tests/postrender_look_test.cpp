// The look: strictness, defaults, inheritance, and overrides.
#include "postrender/color.h"
#include "postrender/look_source.h"
#include "tests/postrender_fixture.h"

namespace nullcone::postrender {
namespace {

using nlohmann::json;

Manifest two_objects() {
  Manifest manifest;
  manifest.objects = {{"earth"}, {"moon"}};
  return manifest;
}

struct BadLook {
  const char* text;
  const char* pointer;  ///< must stand in the complaint
};

class BadLooks : public testing::TestWithParam<BadLook> {};

TEST_P(BadLooks, are_refused_with_their_place) {
  const auto [text, pointer] = GetParam();
  const std::string found = complaint([&] { look_of(text, two_objects()); });
  EXPECT_NE(found.find("look.json: " + std::string(pointer) + ":"), std::string::npos)
      << text << "\n-> " << found;
}

INSTANTIATE_TEST_SUITE_P(
    List, BadLooks,
    testing::Values(
        BadLook{R"([])", "/"},
        BadLook{R"({"exposure":{"white_cd_m2":{"auto":"mean"}}})", "/exposure/white_cd_m2/auto"},
        BadLook{R"({"exposure":{"white_cd_m2":{"auto":"percentile","percentile":101}}})",
                "/exposure/white_cd_m2/percentile"},
        BadLook{R"({"exposure":{"white_cd_m2":{"auto":"percentile","key":1}}})", "/exposure/white_cd_m2/key"},
        BadLook{R"({"exposure":{"white_cd_m2":{"auto":"log_average","key":0}}})",
                "/exposure/white_cd_m2/key"},
        BadLook{R"({"exposure":{"white_cd_m2":[1]}})", "/exposure/white_cd_m2"},
        BadLook{R"({"tone":{"curve":"filmic","k":1}})", "/tone/k"},
        BadLook{R"({"tone":{"curve":"filmic","white":0}})", "/tone/white"},
        BadLook{R"({"tone":{"curve":"table"}})", "/tone/points"},
        BadLook{R"({"tone":{"curve":"table","points":[]}})", "/tone/points"},
        BadLook{R"({"tone":{"curve":"table","points":[[1,2,3]]}})", "/tone/points/0"},
        BadLook{R"({"tone":{"curve":"table","points":[[1,1],[1,1]]}})", "/tone/points"},
        BadLook{R"({"tone":{"curve":"table","points":[[-1,1]]}})", "/tone/points"},
        BadLook{R"({"tone":{"curve":"table","points":[[1,1.5]]}})", "/tone/points"},
        BadLook{R"({"tone":{"curve":"table","points":[[0,0.5],[1,1]]}})", "/tone/points"},
        BadLook{R"({"tone":{"curve":"table","points":[[0,0]]}})", "/tone/points"},
        BadLook{R"({"tone":{"curve":"table","points":[[1,1]],"file":"a.csv"}})", "/tone/file"},
        BadLook{R"({"white_point":"d65"})", "/white_point"}, BadLook{R"({"white_point":{}})", "/white_point"},
        BadLook{R"({"white_point":{"temperature_K":500}})", "/white_point/temperature_K"},
        BadLook{R"({"white_point":{"temperature_K":5000,"xy":[0.3,0.3]}})", "/white_point"},
        BadLook{R"({"white_point":{"xy":[0.735,0.265]}})", "/white_point/xy"},
        BadLook{R"({"white_point":{"xy":[0.3,0]}})", "/white_point/xy"},
        BadLook{R"({"white_point":{"xy":[0.6,0.6]}})", "/white_point/xy"},
        BadLook{R"({"output":{"space":"rec2020"}})", "/output/space"},
        BadLook{R"({"output":{"jpeg_quality":0}})", "/output/jpeg_quality"},
        BadLook{R"({"output":{"quality":90}})", "/output/quality"}, BadLook{R"({"object":{}})", "/object"},
        BadLook{R"({"objects":[]})", "/objects"}, BadLook{R"({"objects":{"mars":{}}})", "/objects/mars"},
        BadLook{R"({"objects":{"earth":{"textur":{}}}})", "/objects/earth/textur"},
        BadLook{R"({"objects":{"earth":{"texture":{}}}})", "/objects/earth/texture/type"},
        BadLook{R"({"objects":{"earth":{"texture":{"type":"marble"}}}})", "/objects/earth/texture/type"},
        BadLook{R"({"objects":{"earth":{"texture":{"type":"color","rgb":[1,2,0]}}}})",
                "/objects/earth/texture/rgb/1"},
        BadLook{R"({"objects":{"earth":{"texture":{"type":"color","rgb":[1,0]}}}})",
                "/objects/earth/texture/rgb"},
        BadLook{R"({"objects":{"earth":{"texture":{"type":"image"}}}})", "/objects/earth/texture/file"},
        BadLook{R"({"objects":{"earth":{"texture":{"type":"image","file":"a.png","filter":"cubic"}}}})",
                "/objects/earth/texture/filter"},
        BadLook{R"({"objects":{"earth":{"texture":{"type":"image","file":"a.png","offset":[0]}}}})",
                "/objects/earth/texture/offset"},
        BadLook{R"({"objects":{"earth":{"texture":{"type":"checkerboard","counts":[4,2]}}}})",
                "/objects/earth/texture"},
        BadLook{
            R"({"objects":{"earth":{"texture":{"type":"checkerboard","counts":[4,2.5],"colors":[[0,0,0],[1,1,1]]}}}})",
            "/objects/earth/texture/counts/1"},
        BadLook{
            R"({"objects":{"earth":{"texture":{"type":"checkerboard","counts":[4,2],"colors":[[0,0,0],[1,1,7]]}}}})",
            "/objects/earth/texture/colors/1"},
        BadLook{R"({"objects":{"earth":{"texture":{"type":"checkerboard","counts":[4,2],
                   "gradient":{"along":"w","from":[1,1,0],"to":[0,0,1]}}}}})",
                "/objects/earth/texture/gradient/along"},
        BadLook{R"({"objects":{"earth":{"spectrum":{"type":"black_body"}}}})",
                "/objects/earth/spectrum/temperature_K"},
        BadLook{R"({"objects":{"earth":{"spectrum":{"type":"black_body","temperature_K":-3}}}})",
                "/objects/earth/spectrum/temperature_K"},
        BadLook{R"({"objects":{"earth":{"spectrum":{"type":"display","temperature_K":300}}}})",
                "/objects/earth/spectrum/temperature_K"},
        BadLook{R"({"objects":{"earth":{"time_slices":{}}}})", "/objects/earth/time_slices"},
        BadLook{
            R"({"objects":{"earth":{"time_slices":[{"channel":"z","texture":{"type":"color","rgb":[1,1,1]}}]}}})",
            "/objects/earth/time_slices/0/channel"},
        BadLook{R"({"objects":{"earth":{"time_slices":[{"channel":"t","from":1,"to":1,
                   "texture":{"type":"color","rgb":[1,1,1]}}]}}})",
                "/objects/earth/time_slices/0/to"},
        BadLook{R"({"objects":{"earth":{"time_slices":[{"channel":"t","from":1}]}}})",
                "/objects/earth/time_slices/0"},
        BadLook{R"({"effects":{"doppler":1}})", "/effects/doppler"},
        BadLook{R"({"effects":{"dopler":true}})", "/effects/dopler"},
        BadLook{R"({"exposure":{"white_cd_m2":"bright"}})", "/exposure/white_cd_m2"},
        BadLook{R"({"exposure":{"white_cd_m2":0}})", "/exposure/white_cd_m2"},
        BadLook{R"({"exposure":{"ev":"1"}})", "/exposure/ev"},
        BadLook{R"({"tone":{"curve":"gamma"}})", "/tone/curve"},
        BadLook{R"({"tone":{"curve":"linear","k":2}})", "/tone/k"},
        BadLook{R"({"tone":{"curve":"exponential","k":0}})", "/tone/k"},
        BadLook{R"({"gamut":"none"})", "/gamut"}, BadLook{R"({"background":[0,0,0,1]})", "/background"},
        BadLook{R"({"background":"black"})", "/background"}));

TEST(Looks, unknown_objects_are_told_which_there_are) {
  const std::string found = complaint([] { look_of(R"({"objects":{"mars":{}}})", two_objects()); });
  EXPECT_NE(found.find("earth, moon"), std::string::npos) << found;
}

TEST(Looks, lamps_are_those_of_the_dataset) {
  Manifest manifest = two_objects();
  const std::string look =
      R"({"lights":{"sun":{"intensity":2.5,"spectrum":{"type":"black_body","temperature_K":5762},
    "blink":{"channel":"tau","period":3},"paths":[0,2]}}})";
  const std::string none = complaint([&] { look_of(look, manifest); });
  EXPECT_NE(none.find("/lights/sun: the dataset has no lamps"), std::string::npos) << none;
  manifest.lights = {{"sun", 0}};
  manifest.light_paths = 3;
  const LampLook sun = look_of(look, manifest).lights.at("sun");
  EXPECT_EQ(sun.light.intensity, Number{2.5});
  EXPECT_TRUE(sun.light.blink);
  EXPECT_EQ(sun.paths, (std::set<int>{0, 2}));
  for (const auto& [wrong, words] :
       {std::pair{R"({"lights":{"moon":{}}})", "no such lamp"},
        {R"({"lights":{"sun":{"paths":[-1]}}})", "/paths/0"},
        {R"({"lights":{"sun":{"paths":[2,3]}}})", "/paths/1: expected a whole number from 0 to 2"},
        {R"({"lights":{"sun":{"spectrum":{"type":"rgb"}}}})", "/spectrum/type"},
        {R"({"lights":{"sun":{"intensity":-1}}})", "/intensity"}}) {
    const std::string found = complaint([&] { look_of(wrong, manifest); });
    EXPECT_NE(found.find(words), std::string::npos) << wrong << ": " << found;
  }
}

TEST(Looks, empty_look_is_the_default) {
  const Look look = look_of("{}", two_objects());
  EXPECT_EQ(look.effects, (Effects{true, true, {}, {}}));
  EXPECT_FALSE(look.develop.white_cd_m2);
  EXPECT_EQ(look.background, Rgb{});
  // Objects get flat colours by their numbers; where nothing is hit, the background shows.
  const Dataset data = make_dataset(3, 1, two_objects().objects, [](int column, int) {
    if (column == 2) return std::vector<TestHit>{};
    TestHit hit;
    hit.id = static_cast<std::uint32_t>(column) + 1;
    return std::vector{hit};
  });
  const Image image = picture(data, R"({"background":[0,0,1]})");
  expect_color(image.display[0], default_color(1), 1e-6f);
  expect_color(image.display[1], default_color(2), 1e-6f);
  EXPECT_EQ(image.display[2], (Rgb{0, 0, 1}));
}

TEST(Settings, override_entries) {
  json look = json::parse(R"({"objects":{"earth":{"spectrum":{"type":"black_body","temperature_K":5000}}}})");
  set_entry(look, "objects.earth.spectrum.temperature_K=6500");
  set_entry(look, "/objects/earth/texture/type=color");
  set_entry(look, "objects.earth.texture={\"rgb\":[1,0,0]}");  // merged, not replaced
  set_entry(look, "exposure.white_cd_m2=auto");
  set_entry(look, "effects/doppler=false");
  EXPECT_EQ(look, json::parse(R"({"objects":{"earth":{"spectrum":{"type":"black_body","temperature_K":6500},
    "texture":{"type":"color","rgb":[1,0,0]}}},"exposure":{"white_cd_m2":"auto"},"effects":{"doppler":false}})"));
  set_entry(look, "objects.earth=null");  // null removes
  EXPECT_EQ(look["objects"], json::object());
}

TEST(Settings, reach_into_lists) {
  json look = json::parse(R"({"objects":{"earth":{"time_slices":[{"from":0},{"from":1}]}}})");
  set_entry(look, "objects.earth.time_slices.1.from=7");
  EXPECT_EQ(look, json::parse(R"({"objects":{"earth":{"time_slices":[{"from":0},{"from":7}]}}})"));
  EXPECT_NE(complaint([&] { set_entry(look, "objects.earth.time_slices.2.from=7"); }).find("list of 2"),
            std::string::npos);
}

TEST(Settings, mistakes_are_refused) {
  json look = json::object();
  for (const char* bad :
       {"", "exposure", "=1", "a..b=1", "a.=1", "/=1", "a={\"b\":", "a=[1,", "a={\"b\":1,\"b\":2}"})
    EXPECT_NE(complaint([&] { set_entry(look, bad); }).find("--set"), std::string::npos) << bad;
  EXPECT_EQ(look, json::object());
}

TEST(LookSources, follow_one_another) {
  TestFolder folder;
  Manifest manifest = two_objects();
  manifest.scene = R"({"objects":[],"look":{"background":[1,0,0],"exposure":{"ev":3}}})";
  EXPECT_EQ(read_look(manifest, "d.exr", "", {}).background, (Rgb{1, 0, 0}));
  const std::string file = folder.write("look.json", R"({"background":[0,1,0]})");
  const Look replaced = read_look(manifest, "d.exr", file, {"gamut=clip"});
  EXPECT_EQ(replaced.background, (Rgb{0, 1, 0}));
  EXPECT_EQ(replaced.develop.ev, 0);  // replaced, not merged
  EXPECT_EQ(replaced.develop.gamut, DevelopLook::Gamut::clip);
  manifest.scene = R"({"objects":[]})";
  EXPECT_EQ(read_look(manifest, "d.exr", "", {}).background, Rgb{});
}

TEST(LookSources, complaints_name_the_place) {
  TestFolder folder;
  Manifest manifest = two_objects();
  manifest.scene = R"({"look":{"tone":{"curve":"x"}}})";
  EXPECT_NE(complaint([&] { read_look(manifest, "d.exr", "", {}); }).find("d.exr: /look/tone/curve"),
            std::string::npos);
  const std::string file = folder.write("look.json", "{\n  \"gamut\": }");
  EXPECT_NE(complaint([&] { read_look(manifest, "d.exr", file, {}); }).find(file + ": line 2"),
            std::string::npos);
  EXPECT_NE(complaint([&] { read_look(manifest, "d.exr", folder.file("no.json"), {}); }), "");
}

TEST(LookSources, files_include_others) {
  TestFolder folder;
  const Manifest manifest = two_objects();
  folder.write("moon.json", R"({"$schema": "x", "opacity": 0.5, "intensity": -1} // of the moon)");
  const std::string file = folder.write("look.json", R"({"$schema": "look.schema.json", "gamut": "clip",
      "objects": {"moon": {"include": "moon.json", "intensity": 2}}})");
  const Look look = read_look(manifest, "d.exr", file, {});
  EXPECT_EQ(look.objects.at("moon").opacity.constant, 0.5);
  EXPECT_EQ(look.objects.at("moon").appearance.intensity->constant, 2);
  const std::string found = complaint([&] {
    read_look(manifest, "d.exr", file, {"objects.moon.intensity=null", "objects.moon.intensity=-1"});
  });
  EXPECT_NE(found.find(file + ": /objects/moon/intensity"), std::string::npos) << found;
  const std::string wrong = folder.write("wrong.json", R"({"objects": {"moon": {"include": "moon.json"}}})"),
                    theirs = complaint([&] { read_look(manifest, "d.exr", wrong, {}); });
  EXPECT_EQ(theirs.find(folder.file("moon.json") + ": /intensity: "), 0u) << theirs;
  // The look of a dataset, and one that is sent, include nothing.
  Manifest stranger = two_objects();
  stranger.scene = R"({"look": {"objects": {"moon": {"include": "moon.json"}}}})";
  EXPECT_NE(complaint([&] {
              read_look(stranger, folder.file("d.exr"), "", {});
            }).find("/look/objects/moon/include"),
            std::string::npos);
}

TEST(LookSources, a_single_keyframe_of_a_spectrum_is_one_spectrum) {
  const auto spectrum = [](const char* radiance) {
    return look_of(R"({"objects":{"earth":{"spectrum":{"type":"equal_energy","radiance":)" +
                       std::string(radiance) + "}}}}",
                   two_objects())
        .objects.at("earth")
        .appearance.spectrum->key;
  };
  EXPECT_EQ(spectrum(R"({"keyframes":[[3,2]],"by":"tau"})"), spectrum("2.0"));
}

TEST(LookSources, textures_are_found_beside_the_look) {
  Manifest manifest = two_objects();
  TestFolder folder;
  const std::string file =
      folder.write("look.json", R"({"objects":{"earth":{"texture":{"type":"image","file":"maps/a.jpg"}},
                                  "moon":{"texture":{"type":"image","file":"/maps/b.jpg"}}}})");
  const Look look = read_look(manifest, "elsewhere/d.exr", file, {});
  EXPECT_EQ(std::get<ImageLook>(*look.objects.at("earth").appearance.texture).file,
            folder.file("maps/a.jpg"));
  EXPECT_EQ(std::get<ImageLook>(*look.objects.at("moon").appearance.texture).file, "/maps/b.jpg");
}

}  // namespace
}  // namespace nullcone::postrender
