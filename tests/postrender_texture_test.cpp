// Textures: orientation, seam, filtering, footprints, and files that are not pictures.
#include <OpenImageIO/imageio.h>

#include <cmath>

#include "postrender/color.h"
#include "postrender/texture_file.h"
#include "tests/postrender_fixture.h"

namespace nullcone::postrender {
namespace {

template <class T>
void write_image(const std::string& path, const char* format, int width, int height, int channels,
                 const std::vector<T>& pixels, OIIO::TypeDesc type) {
  const auto out = OIIO::ImageOutput::create(format);
  ASSERT_TRUE(out);
  ASSERT_TRUE(out->open(path, OIIO::ImageSpec(width, height, channels, type)));
  ASSERT_TRUE(out->write_image(type, pixels.data()));
  out->close();
}

/// 4 x 2 texels whose red is 10 * (row * 4 + column), as encoded bytes.
std::vector<std::uint8_t> numbered() {
  std::vector<std::uint8_t> out;
  for (int i = 0; i < 8; ++i)
    out.insert(out.end(), {static_cast<std::uint8_t>(10 * i), static_cast<std::uint8_t>(255 - i), 7});
  return out;
}

class Textures : public testing::Test {
 protected:
  void SetUp() override {
    write_image(folder.file("map.png"), "png", 4, 2, 3, numbered(), OIIO::TypeDesc::UINT8);
  }
  static std::string look(const std::string& file, const std::string& rest = "") {
    return R"({"objects":{"earth":{"texture":{"type":"image","file":")" + file + "\"" + rest + "}}}}";
  }
  /// The red byte at (u, v) under a look.
  int red(float u, float v, const std::string& rest) {
    TestHit hit;
    hit.u = u;
    hit.v = v;
    return encode_srgb8(picture(one_pixel({hit}), look("map.png", rest), folder.path()).display)[0];
  }
  TestFolder folder;
};

TEST_F(Textures, north_is_up_and_u_runs_right) {
  for (const std::string filter : {R"(,"filter":"bilinear")", R"(,"filter":"mipmap")"}) {
    EXPECT_EQ(red(0.125f, 0.75f, filter), 0);   // top left texel
    EXPECT_EQ(red(0.875f, 0.75f, filter), 30);  // top right
    EXPECT_EQ(red(0.125f, 0.25f, filter), 40);  // bottom left
    EXPECT_EQ(red(0.875f, 0.25f, filter), 70);  // bottom right
  }
}

TEST_F(Textures, v_is_clamped_at_the_poles) {
  EXPECT_EQ(red(0.125f, 1.0f, ""), 0);
  EXPECT_EQ(red(0.125f, 0.0f, ""), 40);
}

TEST_F(Textures, the_seam_blends_the_last_column_with_the_first) {
  const auto linear = [](int code) { return srgb_decoded(code / 255.0); };
  const Rgb half{static_cast<float>(0.5 * (linear(30) + linear(0))), 0, 0};
  const int expected = encode_srgb8({&half, 1})[0];
  EXPECT_EQ(red(0.0f, 0.75f, ""), expected);
  EXPECT_EQ(red(1.0f, 0.75f, ""), expected);
  EXPECT_EQ(red(-3.0f, 0.75f, ""), expected);
}

TEST_F(Textures, offset_and_scale_act_before_wrapping) {
  EXPECT_EQ(red(0.125f, 0.75f, R"(,"offset":[0.25,0])"), 10);
  EXPECT_EQ(red(0.875f, 0.75f, R"(,"offset":[0.25,0])"), 0);  // wraps
  EXPECT_EQ(red(0.125f, 0.75f, R"(,"offset":[0,-0.5])"), 40);
  EXPECT_EQ(red(0.125f, 0.75f, R"(,"scale":[-1,1])"), 30);  // mirrored
  EXPECT_EQ(red(0.25f, 0.75f, R"(,"scale":[1.5,1])"), 10);
}

TEST_F(Textures, a_whole_map_lands_upright) {
  const Image image = picture(flat_map(4, 2), look("map.png", R"(,"filter":"bilinear")"), folder.path());
  EXPECT_EQ(encode_srgb8(image.display), numbered());
}

TEST_F(Textures, depth_of_colour_decides_on_decoding) {
  // 16 bit: sRGB; float: linear; grey: spread; alpha: ignored.
  write_image<std::uint16_t>(folder.file("deep.png"), "png", 1, 1, 3, {32768, 0, 65535},
                             OIIO::TypeDesc::UINT16);
  const Rgb deep = read_texture(folder.file("deep.png"), "/x").texels[0];
  expect_color(deep, {static_cast<float>(srgb_decoded(32768 / 65535.0)), 0, 1}, 1e-6f);
  write_image<float>(folder.file("linear.exr"), "openexr", 1, 1, 3, {0.25f, 40, -1}, OIIO::TypeDesc::FLOAT);
  EXPECT_EQ(read_texture(folder.file("linear.exr"), "/x").texels[0], (Rgb{0.25f, 40, -1}));
  write_image<std::uint8_t>(folder.file("grey.png"), "png", 1, 1, 1, {51}, OIIO::TypeDesc::UINT8);
  const auto grey = static_cast<float>(srgb_decoded(0.2));
  expect_color(read_texture(folder.file("grey.png"), "/x").texels[0], {grey, grey, grey}, 1e-6f);
  write_image<std::uint8_t>(folder.file("alpha.png"), "png", 1, 1, 4, {255, 51, 0, 0}, OIIO::TypeDesc::UINT8);
  expect_color(read_texture(folder.file("alpha.png"), "/x").texels[0], {1, grey, 0}, 1e-6f);
}

TEST_F(Textures, a_changed_file_is_read_again) {
  Renderer renderer(one_pixel({{}}));
  const Look look = look_of(Textures::look("one.png"), renderer.dataset().manifest, folder.path());
  write_image<std::uint8_t>(folder.file("one.png"), "png", 1, 1, 3, {255, 0, 0}, OIIO::TypeDesc::UINT8);
  EXPECT_EQ(renderer.render(look).display[0], (Rgb{1, 0, 0}));
  write_image<std::uint8_t>(folder.file("one.png"), "png", 2, 1, 3, {0, 0, 255, 0, 0, 255},
                            OIIO::TypeDesc::UINT8);
  EXPECT_EQ(renderer.render(look).display[0], (Rgb{0, 0, 1}));
}

/// Variance of the red channel of a fine checkerboard image seen at 48 x 24 pixels.
double variance_of_fine_checks(const std::string& filter) {
  TestFolder folder;
  std::vector<std::uint8_t> checks;
  for (int j = 0; j < 250; ++j)
    for (int i = 0; i < 500; ++i) checks.insert(checks.end(), 3, (i + j) % 2 == 0 ? 255 : 0);
  write_image(folder.file("checks.png"), "png", 500, 250, 3, checks, OIIO::TypeDesc::UINT8);
  const Image image = picture(
      flat_map(48, 24),
      R"({"objects":{"earth":{"texture":{"type":"image","file":"checks.png","filter":")" + filter + "\"}}}}",
      folder.path());
  double sum = 0, squares = 0;
  for (const Rgb c : image.display) {
    sum += static_cast<double>(c.r);
    squares += static_cast<double>(c.r * c.r);
  }
  const auto n = static_cast<double>(image.display.size());
  EXPECT_NEAR(sum / n, 0.5, filter == "mipmap" ? 0.01 : 0.1);
  return squares / n - sum * sum / (n * n);
}

TEST(Mipmaps, take_the_noise_out_of_fine_checks) {
  const double sharp = variance_of_fine_checks("bilinear"), smooth = variance_of_fine_checks("mipmap");
  EXPECT_GT(sharp, 0.01);  // aliased: neighbouring pixels fall on unrelated texels
  EXPECT_LT(smooth, 0.01 * sharp);
}

TEST(Mipmaps, keep_the_mean_whatever_the_size) {
  TextureLevel full{7, 5, {}};
  float mean = 0;
  for (int i = 0; i < 35; ++i) {
    full.texels.push_back({static_cast<float>(i % 11), 1, 0});
    mean += static_cast<float>(i % 11) / 35;
  }
  const std::vector<TextureLevel> levels = halvings(full);
  ASSERT_EQ(levels.size(), 3u);  // 7 x 5, 3 x 2, 1 x 1
  expect_color(levels.back().texels[0], {mean, 1, 0}, 1e-5f);
  const Pyramid pyramid = make_pyramid(full);
  ASSERT_EQ(pyramid.levels.size(), 3u);
  expect_color(pyramid.texel(2, 0, 0), {mean, 1, 0}, mean / 2048);  // half floats
}

TEST(Mipmaps, hold_every_texel_where_it_is_looked_for) {
  TextureLevel full{13, 6, {}};
  for (int i = 0; i < 13 * 6; ++i) full.texels.push_back({static_cast<float>(i), -0.25f, 1e-3f});
  const Pyramid pyramid = make_pyramid(full);
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 13; ++i) {
      EXPECT_EQ(pyramid.texel(0, i, j).r, full.texel(i, j).r);
      EXPECT_EQ(pyramid.texel(0, i, j).g, -0.25f);
      EXPECT_NEAR(pyramid.texel(0, i, j).b, 1e-3f, 1e-3f / 2048);
    }
}

TEST(Mipmaps, range_from_very_bright_to_very_dark) {
  for (const float brightest : {1e-12f, 1.0f, 65504.0f, 1e9f}) {
    const Pyramid pyramid =
        make_pyramid({2, 1, {{brightest, brightest / 1e6f, 0}, {NAN, INFINITY, -brightest}}});
    expect_color(pyramid.texel(0, 0, 0), {brightest, brightest / 1e6f, 0}, brightest / 2048);
    EXPECT_NEAR(pyramid.texel(0, 0, 0).g, brightest / 1e6f, brightest / 1e6f / 2048);
    EXPECT_EQ(pyramid.texel(0, 1, 0).r, 0);
    EXPECT_GE(pyramid.texel(0, 1, 0).g, brightest);
    EXPECT_NEAR(pyramid.texel(0, 1, 0).b, -brightest, brightest / 2048);
  }
}

TEST(Footprints, cross_the_seam_but_not_the_edge_between_images) {
  // u: 0.95, 0.99, 0.03 (across the seam), then another image of the same object.
  const std::vector<float> u = {0.95f, 0.99f, 0.03f, 0.5f};
  const Dataset data = make_dataset(4, 1, {{"earth"}}, [&](int column, int) {
    TestHit hit;
    hit.u = u[static_cast<std::size_t>(column)];
    hit.order = column == 3 ? 1 : 0;
    return std::vector{hit};
  });
  const Hits& hits = data.hits;
  const Layer line = {hits.id.data(), hits.order.data(), hits.u.data(),
                      hits.v.data(),  hits.shift.data(), hits.A.data()};
  const std::vector<std::uint32_t> nothing(4);
  Layer outside = line;
  outside.id = nothing.data();
  for (const Kernel* kernel : kernels()) {
    std::vector<float> u_right(4), v_right(4), u_down(4, 1.0f), v_down(4, 1.0f);
    kernel->footprints({outside, line, outside}, 4, 0, 4,
                       {u_right.data(), v_right.data(), u_down.data(), v_down.data()});
    EXPECT_NEAR(std::abs(u_right[1]), 0.04f, 1e-6f);
    EXPECT_NEAR(std::abs(u_right[2]), 0.04f, 1e-6f);
    EXPECT_EQ(u_right[3], 0);  // no neighbour counts
    EXPECT_EQ(u_down, std::vector<float>(4));
  }
}

std::string board(const std::string& rest) {
  return R"({"objects":{"earth":{"texture":{"type":"checkerboard",)" + rest + "}}}}";
}

TEST(Checkerboard, alternates_from_the_lower_left) {
  const Image image = picture(flat_map(4, 2), board(R"("counts":[4,2],"colors":[[1,1,1],[0,0,0]])"));
  for (std::size_t row = 0; row < 2; ++row)
    for (std::size_t column = 0; column < 4; ++column) {
      const float expected = (column + (1 - row)) % 2 == 0 ? 1.0f : 0.0f;
      EXPECT_NEAR(image.display[row * 4 + column].g, expected, 1e-6f) << row << " " << column;
    }
}

TEST(Checkerboard, gradient_runs_from_yellow_to_blue) {
  const Image image =
      picture(flat_map(8, 1),
              board(R"("counts":[8,1],"gradient":{"along":"u","from":[1,1,0],"to":[0,0,1],"dark":0.5})"));
  for (std::size_t i = 0; i < 8; ++i) {
    const float s = (static_cast<float>(i) + 0.5f) / 8, bright = i % 2 == 0 ? 1.0f : 0.5f;
    expect_color(image.display[i], {bright * (1 - s), bright * (1 - s), bright * s}, 1e-5f);
  }
}

TEST(Checkerboard, squares_below_a_pixel_turn_grey) {
  const Image image = picture(flat_map(20, 10), board(R"("counts":[5000,3000],"colors":[[1,1,1],[0,0,0]])"));
  for (const Rgb c : image.display) EXPECT_NEAR(c.r, 0.5f, 0.01f);
}

class BadTextures : public Textures {
 protected:
  /// The complaint about `file`, which must name the file and where in the look it stands.
  std::string about(const std::string& file) {
    const std::string text = complaint([&] { picture(one_pixel({{}}), look(file), folder.path()); });
    EXPECT_NE(text.find(folder.file(file)), std::string::npos) << file << " -> " << text;
    EXPECT_NE(text.find("/objects/earth/texture/file"), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    return text;
  }
};

TEST_F(BadTextures, are_refused_with_file_and_place) {
  folder.write("text.jpg", "Hello, this is not a picture.\n");
  folder.write("empty.png", "");
  folder.write("archive.jpg", std::string("PK\x03\x04\x14\x00\x00\x00\x08\x00", 10) + std::string(200, 'x'));
  folder.write("noise.png", std::string("\x89PNG\r\n\x1a\n") + std::string(300, '\x5a'));
  folder.write("noise.jpg", "\xff\xd8\xff" + std::string(300, '\x5a') + "\xff\xd9");
  folder.write("noise.exr", "\x76\x2f\x31\x01" + std::string(300, '\x5a'));
  folder.write("noise.tif", std::string("II*\0", 4) + std::string(300, '\x5a'));
  std::filesystem::create_directory(folder.file("folder.png"));
  EXPECT_NE(about("missing.jpg").find("no such file"), std::string::npos);
  EXPECT_NE(about("text.jpg").find("expected JPEG"), std::string::npos);
  EXPECT_NE(about("archive.jpg").find("expected JPEG"), std::string::npos);
  EXPECT_NE(about("folder.png").find("not a file"), std::string::npos);
  for (const char* file : {"empty.png", "noise.png", "noise.jpg", "noise.exr", "noise.tif"}) about(file);
}

TEST_F(BadTextures, cut_off_files_are_refused) {
  std::vector<std::uint8_t> noise(64 * 64 * 3);
  for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = static_cast<std::uint8_t>(i * i * 31 + i * 7);
  for (const auto& [name, format] :
       {std::pair{"a.png", "png"}, {"a.jpg", "jpeg"}, {"a.exr", "openexr"}, {"a.tif", "tiff"}}) {
    write_image(folder.file(name), format, 64, 64, 3, noise, OIIO::TypeDesc::UINT8);
    EXPECT_EQ(complaint([&] { picture(one_pixel({{}}), look(name), folder.path()); }), "") << name;
    std::filesystem::resize_file(folder.file(name), std::filesystem::file_size(folder.file(name)) / 2);
    about(name);
  }
}

TEST_F(BadTextures, absurd_sizes_are_refused_before_anything_is_decoded) {
  // A PNG header of 40000 x 20 with a right checksum, and nothing behind it.
  const std::string header = std::string("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR", 16);
  const auto with_size = [&](std::uint32_t width, std::uint32_t height) {
    std::string chunk = "IHDR";
    for (const std::uint32_t number : {width, height})
      for (int shift = 24; shift >= 0; shift -= 8) chunk += static_cast<char>((number >> shift) & 255u);
    chunk += std::string("\x08\x02\0\0\0", 5);
    std::uint32_t crc = 0xffffffffu;
    for (const char c : chunk) {
      crc ^= static_cast<unsigned char>(c);
      for (int k = 0; k < 8; ++k) crc = (crc & 1u) != 0 ? 0xedb88320u ^ (crc >> 1) : crc >> 1;
    }
    crc = ~crc;
    std::string out = header.substr(0, 12) + chunk;
    for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>((crc >> shift) & 255u);
    return out + std::string("\0\0\0\x04IDAT\0\0\0\0\0\0\0\0\0\0\0\0IEND\xae\x42\x60\x82", 28);
  };
  folder.write("wide.png", with_size(40000, 20));
  EXPECT_NE(about("wide.png").find("32768"), std::string::npos);
  folder.write("large.png", with_size(30000, 30000));
  EXPECT_NE(about("large.png").find("1 GiB"), std::string::npos);
}

}  // namespace
}  // namespace nullcone::postrender
