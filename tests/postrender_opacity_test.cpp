// Transparency: opacities of objects, and alpha of textures.
#include <OpenImageIO/imageio.h>

#include <cmath>

#include "postrender/color.h"
#include "postrender/texture_file.h"
#include "tests/postrender_fixture.h"

namespace nullcone::postrender {
namespace {

void write_image(const std::string& path, const char* format, int width, int channels,
                 const std::vector<float>& pixels, OIIO::TypeDesc type) {
  OIIO::ImageSpec spec(width, static_cast<int>(pixels.size()) / width / channels, channels, type);
  spec.alpha_channel = channels == 4 ? 3 : channels == 2 ? 1 : -1;
  spec.attribute("oiio:UnassociatedAlpha", 1);  // as they are
  const auto out = OIIO::ImageOutput::create(format);
  ASSERT_TRUE(out->open(path, spec));
  ASSERT_TRUE(out->write_image(OIIO::TypeDesc::FLOAT, pixels.data())) << out->geterror();
  out->close();
}

const std::vector<ObjectEntry> kTwo = {{"glass"}, {"wall"}};

/// The glass in front of the wall, each opaque as recorded.
Dataset glass_and_wall(int width = 1, float u = 0.5f) {
  return make_dataset(width, 1, kTwo, [=](int, int) {
    TestHit glass, wall;
    glass.u = u;
    wall.id = 2;
    return std::vector{glass, wall};
  });
}

std::string look_with(const std::string& glass) {
  return R"({"objects":{"glass":{)" + glass + R"(},"wall":{"texture":{"type":"color","rgb":[0,0,1]}}}})";
}
const std::string kRed = R"("texture":{"type":"color","rgb":[1,0,0]})";

TEST(Opacity, of_an_object_mixes_it_with_what_is_behind) {
  for (const float opacity : {1.0f, 0.75f, 0.25f}) {
    const std::string entry = R"("opacity":)" + std::to_string(opacity) + ",";
    EXPECT_EQ(picture(glass_and_wall(), look_with(entry + kRed)).exposed[0], (Rgb{opacity, 0, 1 - opacity}));
  }
}

TEST(Opacity, of_nothing_hides_an_object) {
  const std::string hidden = R"("opacity":0,)" + kRed;
  EXPECT_EQ(picture(glass_and_wall(), look_with(hidden)).exposed[0], (Rgb{0, 0, 1}));
  // Also with slices, and whatever its records hold: nothing times infinity would be no number.
  const std::string sliced =
      hidden + R"(,"time_slices":[{"channel":"t","texture":{"type":"color","rgb":[0,1,0]}}])";
  Dataset data = glass_and_wall();
  data.hits.shift[0] = INFINITY;
  EXPECT_EQ(picture(data, look_with(hidden)).exposed[0], (Rgb{0, 0, 1}));
  EXPECT_EQ(picture(data, look_with(sliced)).exposed[0], (Rgb{0, 0, 1}));
  EXPECT_EQ(
      picture(one_pixel({{}}), R"({"objects":{"earth":{"opacity":0}},"background":[1,0,1]})").exposed[0],
      (Rgb{1, 0, 1}));
}

TEST(Opacity, multiplies_what_is_recorded) {
  Dataset data = glass_and_wall();
  data.hits.A[0] = 0.5f;
  EXPECT_EQ(picture(std::move(data), look_with(R"("opacity":0.5,)" + kRed)).exposed[0],
            (Rgb{0.25f, 0, 0.75f}));
}

TEST(Opacity, acts_on_physical_light_and_in_time_slices) {
  const std::string text = R"({"objects":{"glass":{"opacity":0.5,"time_slices":[{"channel":"t","from":-2,
    "spectrum":{"type":"black_body","temperature_K":5000}}]},"wall":{"texture":{"type":"color","rgb":[0,0,0]}}},
    "exposure":{"white_cd_m2":WHITE}})";
  const auto seen_with = [&](const std::string& white) {
    std::string look = text;
    look.replace(look.find("WHITE"), 5, white);
    return picture(glass_and_wall(), look).exposed[0].r;
  };
  std::string opaque = text;
  opaque.replace(opaque.find("0.5"), 3, "1.0");
  opaque.replace(opaque.find("WHITE"), 5, "1e9");
  EXPECT_EQ(seen_with("1e9"), 0.5f * picture(glass_and_wall(), opaque).exposed[0].r);
}

class Alpha : public testing::Test {
 protected:
  static std::string image(const std::string& file, const std::string& rest = R"(,"alpha":true)") {
    return look_with(R"("texture":{"type":"image","file":")" + file + "\"" + rest + "}");
  }
  TestFolder folder;
};

TEST_F(Alpha, lets_through_what_is_behind_where_the_look_says_so) {
  write_image(folder.file("half.png"), "png", 1, 4, {1, 0, 0, 0.2f}, OIIO::TypeDesc::UINT8);
  const Image clear = picture(glass_and_wall(), image("half.png"), folder.path());
  expect_color(clear.exposed[0], {0.2f, 0, 0.8f}, 1e-3f);  // half floats
  const Image ignored = picture(glass_and_wall(), image("half.png", ""), folder.path());
  EXPECT_EQ(ignored.exposed[0], (Rgb{1, 0, 0}));
  // Times the object's opacity.
  nlohmann::json both = nlohmann::json::parse(image("half.png"));
  both["objects"]["glass"]["opacity"] = 0.5;
  expect_color(picture(glass_and_wall(), both.dump(), folder.path()).exposed[0], {0.1f, 0, 0.9f}, 1e-3f);
}

TEST_F(Alpha, is_read_of_all_kinds_of_pictures) {
  // Straight in PNG and TIFF, also of grey pictures; OpenEXR's colours are multiplied by it.
  const auto level = [&](const char* file) { return read_texture(folder.file(file), "/x", true); };
  write_image(folder.file("grey.png"), "png", 1, 2, {1, 0.6f}, OIIO::TypeDesc::UINT8);
  write_image(folder.file("deep.png"), "png", 1, 4, {1, 0, 0, 0.25f}, OIIO::TypeDesc::UINT16);
  write_image(folder.file("a.tif"), "tiff", 1, 4, {1, 0, 0, 0.25f}, OIIO::TypeDesc::FLOAT);
  write_image(folder.file("a.exr"), "openexr", 1, 4, {0.25f, 0, 0, 0.25f}, OIIO::TypeDesc::FLOAT);
  EXPECT_NEAR(level("grey.png").alpha[0], 0.6f, 1e-6f);
  expect_color(level("grey.png").texels[0], {0.6f, 0.6f, 0.6f}, 1e-6f);
  for (const char* file : {"deep.png", "a.tif", "a.exr"}) {
    EXPECT_NEAR(level(file).alpha[0], 0.25f, 1e-4f) << file;  // 16 bits
    expect_color(level(file).texels[0], {0.25f, 0, 0}, 1e-4f);
  }
  EXPECT_TRUE(read_texture(folder.file("grey.png"), "/x").alpha.empty());
}

TEST_F(Alpha, that_a_picture_does_not_have_is_refused) {
  write_image(folder.file("plain.png"), "png", 1, 3, {1, 0, 0}, OIIO::TypeDesc::UINT8);
  const std::string found = complaint([&] { picture(glass_and_wall(), image("plain.png"), folder.path()); });
  EXPECT_NE(found.find("plain.png: /objects/glass/texture/file: has no alpha channel"), std::string::npos)
      << found;
}

TEST_F(Alpha, edges_do_not_bleed) {
  // Opaque red beside transparent green: averages of both are half transparent red, at every level.
  std::vector<float> pixels;
  for (int i = 0; i < 64; ++i) {
    const bool red = i % 16 < 8;
    pixels.insert(pixels.end(), {red ? 1.0f : 0.0f, red ? 0.0f : 1.0f, 0, red ? 1.0f : 0.0f});
  }
  write_image(folder.file("edge.png"), "png", 16, 4, pixels, OIIO::TypeDesc::UINT8);
  // At the edge itself, by bilinear look-up.
  const Image edge = picture(glass_and_wall(1, 0.5f),
                             image("edge.png", R"(,"alpha":true,"filter":"bilinear")"), folder.path());
  expect_color(edge.exposed[0], {0.5f, 0, 0.5f}, 1e-3f);
  // The whole texture in one pixel.
  Dataset data = glass_and_wall();
  data.hits.channels = data.manifest.channels = data.hits.channels | ChannelSet::of("duv");
  for (auto& steps : data.hits.duv) steps = {INFINITY, INFINITY};
  expect_color(picture(std::move(data), image("edge.png"), folder.path()).exposed[0], {0.5f, 0, 0.5f}, 1e-3f);
}

TEST_F(Alpha, of_zero_and_of_one_are_exact) {
  write_image(folder.file("ends.png"), "png", 2, 4, {1, 0, 0, 1, 1, 0, 0, 0}, OIIO::TypeDesc::UINT8);
  for (const Kernel* kernel : kernels()) {
    const auto seen_at = [&](float u) {
      Renderer renderer(glass_and_wall(1, u), *kernel);
      return renderer.render(look_of(image("ends.png"), renderer.manifest(), folder.path())).exposed[0];
    };
    EXPECT_EQ(seen_at(0.25f), (Rgb{1, 0, 0})) << kernel->isa;
    EXPECT_EQ(seen_at(0.75f), (Rgb{0, 0, 1})) << kernel->isa;
  }
}

TEST_F(Alpha, can_be_switched_on_and_off) {
  // A renderer keeps textures, with their alpha and without it apart.
  write_image(folder.file("half.png"), "png", 1, 4, {1, 0, 0, 0.2f}, OIIO::TypeDesc::UINT8);
  Renderer renderer(glass_and_wall());
  for (const bool alpha : {false, true, false})
    expect_color(renderer
                     .render(look_of(image("half.png", alpha ? R"(,"alpha":true)" : ""), renderer.manifest(),
                                     folder.path()))
                     .exposed[0],
                 alpha ? Rgb{0.2f, 0, 0.8f} : Rgb{1, 0, 0}, 1e-3f);
}

TEST_F(Alpha, filters_a_black_body_as_it_filters_colors) {
  write_image(folder.file("half.png"), "png", 1, 4, {1, 1, 1, 0.2f}, OIIO::TypeDesc::UINT8);
  const std::string body = R"(,"spectrum":{"type":"black_body","temperature_K":6000})";
  const auto seen_with = [&](const std::string& rest) {
    const std::string text =
        R"({"objects":{"glass":{"texture":{"type":"image","file":"half.png")" + rest + "}" + body +
        R"(},"wall":{"texture":{"type":"color","rgb":[0,0,0]}}},"exposure":{"white_cd_m2":1e9}})";
    return picture(glass_and_wall(), text, folder.path()).exposed[0].g;
  };
  EXPECT_NEAR(seen_with(R"(,"alpha":true)"), 0.2f * seen_with(""), 1e-3f * seen_with(""));
}

}  // namespace
}  // namespace nullcone::postrender
