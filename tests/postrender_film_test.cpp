// Image sequences: which picture each crossing sees, which files are read, and how much memory they may take.
#include <OpenImageIO/imageio.h>

#include <cmath>
#include <limits>

#include "postrender/color.h"
#include "postrender/texture_maker.h"
#include "tests/postrender_fixture.h"

namespace nullcone::postrender {
namespace {

Timeline film(std::size_t count, double from, double rate, bool loop, bool blend) {
  Timeline out;
  out.count = count;
  out.from = from;
  out.rate = rate;
  out.loop = loop;
  out.blend = blend;
  return out;
}

using Place = Timeline::Place;

TEST(Timelines, hold_the_first_and_the_last_picture) {
  const Timeline held = film(4, 10, 2, false, false);
  for (const auto& [time, picture] : {std::pair{-1e300, 0u},
                                      {9.9, 0u},
                                      {10, 0u},
                                      {10.49, 0u},
                                      {10.5, 1u},
                                      {11.9, 3u},
                                      {12, 3u},
                                      {1e300, 3u}})
    EXPECT_EQ(held.at({time, 0}), (Place{picture, picture, 0})) << time;
  const Timeline blended = film(4, 10, 2, false, true);
  EXPECT_EQ(blended.at({10.125, 0}), (Place{0, 1, 0.25f}));
  EXPECT_EQ(blended.at({11.5, 0}), (Place{3, 3, 0}));
  EXPECT_EQ(blended.at({11.75, 0}), (Place{3, 3, 0}));
}

TEST(Timelines, loop_and_blend_the_last_into_the_first) {
  const Timeline loop = film(4, 0, 1, true, true);
  EXPECT_EQ(loop.at({3.25, 0}), (Place{3, 0, 0.25f}));
  EXPECT_EQ(loop.at({-0.5, 0}), (Place{3, 0, 0.5f}));
  EXPECT_EQ(loop.at({4e9 + 1, 0}), (Place{1, 1, 0}));
  EXPECT_EQ(loop.at({-1e-30, 0}).share, 0);  // rounds to the beginning
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double time : {infinity, -infinity, std::nan("")})
    EXPECT_EQ(loop.at({time, 0}), (Place{0, 0, 0}));
}

TEST(Timelines, of_nodes_are_held_and_linear_between) {
  Timeline nodes;
  nodes.nodes = {-1, 0, 4};
  nodes.count = 3;
  nodes.clock = Clock::tau;
  EXPECT_EQ(nodes.at({5, 1}), (Place{1, 2, 0.25f}));
  EXPECT_EQ(nodes.at({5, -2}), (Place{0, 0, 0}));
  EXPECT_EQ(nodes.at({5, 4}), (Place{2, 2, 0}));
  EXPECT_EQ(nodes.at({5, std::numeric_limits<double>::infinity()}), (Place{2, 2, 0}));
  EXPECT_EQ(nodes.at({5, std::nan("")}), (Place{0, 0, 0}));
}

class Films : public testing::Test {
 protected:
  /// Grey pictures of their numbers.
  void write(int number, int side = 4) {
    const std::vector<std::uint8_t> bytes(static_cast<std::size_t>(side * side),
                                          static_cast<std::uint8_t>(number));
    std::string name = std::to_string(number);
    name = "f_" + std::string(4 - name.size(), '0') + name + ".png";
    const auto out = OIIO::ImageOutput::create("png");
    ASSERT_TRUE(out->open(folder.file(name), OIIO::ImageSpec(side, side, 1, OIIO::TypeDesc::UINT8)));
    ASSERT_TRUE(out->write_image(OIIO::TypeDesc::UINT8, bytes.data()));
    out->close();
  }
  static std::string look(const std::string& sequence, const std::string& rest = "") {
    return R"({"objects":{"earth":{"texture":{"type":"image","file":"f_####.png","sequence":{)" + sequence +
           "}" + rest + "}}}}";
  }
  /// Times of emission from -3 on in steps of 1/4, and a clock that runs twice as fast, from its origin 100
  /// on.
  static Dataset times(int count) {
    return make_dataset(count, 1, {{"earth", 100}}, [](int column, int) {
      TestHit hit;
      hit.t = -3 + static_cast<float>(column) / 4;
      hit.tau = 2 * (hit.t + 3);
      return std::vector{hit};
    });
  }
  static int code(Rgb c) { return encode_srgb8({&c, 1})[0]; }
  TestFolder folder;
};

TEST_F(Films, show_each_crossing_the_picture_of_its_time) {
  for (int i = 20; i < 30; ++i) write(i);
  const Image by_t = picture(times(12), look(R"("frames":[20,29],"rate":2,"from":-3)"), folder.path());
  const Image by_tau = picture(
      times(12), look(R"("frames":[20,29],"rate":2,"clock":"tau","from":100,"loop":true)"), folder.path());
  for (int i = 0; i < 12; ++i) {
    EXPECT_EQ(code(by_t.display[static_cast<std::size_t>(i)]), 20 + i / 2);
    EXPECT_EQ(code(by_tau.display[static_cast<std::size_t>(i)]), 20 + i % 10);
  }
}

TEST_F(Films, blend_linearly_in_light) {
  write(0), write(1), write(2);
  const Image image = picture(times(9), look(R"("frames":[0,2],"from":-3,"blend":true)"), folder.path());
  for (std::size_t i = 0; i < 9; ++i) {
    const auto light = [](std::size_t number) { return srgb_decoded(static_cast<double>(number) / 255); };
    const double share = static_cast<double>(i % 4) / 4,
                 expected = light(i / 4) * (1 - share) + light(i / 4 + 1) * share;
    EXPECT_NEAR(static_cast<double>(image.display[i].r), i == 8 ? light(2) : expected, 1e-6);
  }
}

TEST_F(Films, are_read_only_where_crossings_see_them) {
  for (const int number : {7, 8, 9}) write(number);  // of a hundred thousand
  const std::string all = R"("frames":[0,99999],"from":-10)";
  EXPECT_EQ(code(picture(times(12), look(all), folder.path()).display[0]), 7);
  const std::string found = complaint([&] { picture(times(13), look(all), folder.path()); });
  EXPECT_NE(found.find("f_0010.png: /objects/earth/texture/file: no such file"), std::string::npos) << found;
  // A slice hides the rest.
  const std::string sliced =
      R"({"objects":{"earth":{"time_slices":[{"channel":"t","from":-3,"to":-1,"texture":{"type":"image",
      "file":"f_####.png","sequence":{"frames":[0,99],"from":-10}}}]}}})";
  EXPECT_EQ(code(picture(times(40), sliced, folder.path()).display[7]), 8);
}

TEST_F(Films, go_by_the_number_of_the_picture) {
  for (const int number : {4, 5}) write(number);
  const Dataset data = times(2);
  const nlohmann::json document =
      nlohmann::json::parse(look(R"("frames":[0,99],"from":10,"rate":0.5,"clock":"frame","blend":true)"));
  const auto seen_at = [&](double frame) {
    const Look parsed = parse_look(document, {"look.json", "", folder.path(), frame}, data.manifest);
    return Renderer(data).render(parsed).display[1];
  };
  EXPECT_EQ(code(seen_at(18)), 4);
  EXPECT_EQ(code(seen_at(20)), 5);
  EXPECT_EQ(seen_at(19), mix(seen_at(18), seen_at(20), 0.5f));
}

TEST_F(Films, are_placed_and_filtered_as_still_pictures_are) {
  write(3), write(4);
  for (const char* rest :
       {R"(,"rotate_deg":[90,0,0])", R"(,"filter":"anisotropic")", R"(,"filter":"bilinear")",
        R"(,"offset":[{"keyframes":[[0,0],[1,1]],"by":"t"},0])"})
    EXPECT_EQ(code(picture(times(4), look(R"("frames":[3,4],"from":-3)", rest), folder.path()).display[3]), 3)
        << rest;
}

TEST_F(Films, take_no_more_memory_than_they_may) {
  for (int i = 0; i < 4; ++i) write(i, 64);
  const Dataset data = times(16);
  const Look parsed = look_of(look(R"("frames":[0,3],"from":-3)"), data.manifest, folder.path());
  TextureCache cache;
  const auto read_with = [&](std::size_t most) {
    TextureMaker maker(cache, most);
    Shading shading;
    shading.appearances.push_back({maker.make(*parsed.objects.at("earth").appearance.texture), Light{}});
    shading.objects.push_back({100, 0});
    maker.read_films(data, shading);
    return std::get<MovingTexture>(shading.appearances[0].texture);
  };
  const std::size_t each =
      std::get<ImageTexture>(read_with(std::size_t{1} << 30).parts->frames[0]).image->bytes();
  EXPECT_EQ(complaint([&] { read_with(4 * each); }), "");
  const std::string found = complaint([&] { read_with(4 * each - 1); });
  EXPECT_NE(found.find("/objects/earth/texture/file: the film needs 4 frames at once"), std::string::npos)
      << found;
}

TEST_F(Films, that_make_no_sense_are_refused) {
  for (const auto& [sequence, place] : {std::pair{R"("rate":1)", "frames:"},
                                        {R"("frames":[3,1])", "frames:"},
                                        {R"("frames":[0,1e6])", "frames:"},
                                        {R"("frames":[0,1.5])", "frames/1:"},
                                        {R"("frames":[0,1],"rate":0)", "rate:"},
                                        {R"("frames":[0,1],"clock":"u")", "clock:"},
                                        {R"("frames":[0,1],"loop":1)", "loop:"},
                                        {R"("frames":[0,1],"speed":1)", "speed:"}}) {
    const std::string found = complaint([&] { picture(times(1), look(sequence), folder.path()); });
    EXPECT_NE(found.find("/objects/earth/texture/sequence/" + std::string(place)), std::string::npos)
        << sequence << " -> " << found;
  }
  const std::string plain =
      R"({"objects":{"earth":{"texture":{"type":"image","file":"f.png","sequence":{"frames":[0,1]}}}}})";
  EXPECT_NE(complaint([&] { picture(times(1), plain, folder.path()); }).find("/texture/file:"),
            std::string::npos);
}

}  // namespace
}  // namespace nullcone::postrender
