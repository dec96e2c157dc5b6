// Exposure, tone curve, gamut mapping, and pictures in files.
#include <algorithm>
#include <cmath>

#include <OpenImageIO/imageio.h>

#include "postrender/color.h"
#include "postrender/develop.h"
#include "postrender/picture_file.h"
#include "tests/postrender_fixture.h"

namespace nullcone::postrender {
namespace {

/// The direction of a colour from the grey of its luminance: what hue-preserving mapping must keep.
std::array<double, 3> hue(Rgb c) {
  const float Y = luminance(c);
  const std::array<double, 3> d = {static_cast<double>(c.r - Y), static_cast<double>(c.g - Y),
                                   static_cast<double>(c.b - Y)};
  const double length = std::hypot(d[0], d[1], d[2]);
  return {d[0] / length, d[1] / length, d[2] / length};
}

Rgb mapped_into_gamut(Rgb c) { return developed(c, {}).display[0]; }

TEST(Gamut, hue_preserving_keeps_hue_and_luminance) {
  int mapped = 0;
  for (const float r : {-0.3f, 0.0f, 0.4f, 1.5f})
    for (const float g : {-0.1f, 0.2f, 0.7f, 1.1f})
      for (const float b : {-0.5f, 0.1f, 0.9f, 4.0f}) {
        const Rgb in{r, g, b};
        const float Y = luminance(in);
        if (Y < 0.01f || Y > 0.99f) continue;  // black and white have no hue
        const Rgb out = mapped_into_gamut(in);
        ++mapped;
        for (const float x : {out.r, out.g, out.b})
          EXPECT_TRUE(x >= 0 && x <= 1) << r << " " << g << " " << b;
        EXPECT_NEAR(luminance(out), Y, 1e-6f);  // float rounding of a sum of three terms below 4
        // As little grey as is needed: a colour that moved stops at the border.
        const bool moved =
            out != in && std::max({std::abs(out.r - r), std::abs(out.g - g), std::abs(out.b - b)}) > 1e-5f;
        const float border = std::min(std::min({out.r, out.g, out.b}), 1 - std::max({out.r, out.g, out.b}));
        EXPECT_NEAR(moved ? border : 0, 0, 1e-6f) << r << " " << g << " " << b;
        const Rgb away{out.r - Y, out.g - Y, out.b - Y};
        if (std::hypot(away.r, away.g, away.b) < 1e-2f) continue;
        // Rounding of 1e-7 over a saturation of at least 1e-2.
        for (std::size_t i = 0; i < 3; ++i)
          EXPECT_NEAR(hue(out)[i], hue(in)[i], 1e-4) << r << " " << g << " " << b;
      }
  EXPECT_GT(mapped, 20);
}

TEST(Gamut, colors_inside_stay_and_extremes_end_at_black_and_white) {
  const Rgb inside{0.1f, 0.9f, 0.3f};
  expect_color(mapped_into_gamut(inside), inside, 1e-7f);
  EXPECT_EQ(mapped_into_gamut({3, 3, 3}), (Rgb{1, 1, 1}));
  EXPECT_EQ(mapped_into_gamut({INFINITY, INFINITY, INFINITY}), (Rgb{1, 1, 1}));
  EXPECT_EQ(mapped_into_gamut({-1, -1, 0}), Rgb{});
  EXPECT_EQ(mapped_into_gamut({NAN, 0, 0}), Rgb{});
  DevelopLook clip;
  clip.gamut = DevelopLook::Gamut::clip;
  EXPECT_EQ(developed({-1, 0.5f, NAN}, clip).display[0], (Rgb{0, 0.5f, 0}));
}

TEST(Tone, exponential_acts_on_the_luminance) {
  const Rgb color = {0.6f, 0.3f, 0.1f};
  DevelopLook look;
  look.curve = DevelopLook::Curve::exponential;
  look.k = 2;
  const Image image = developed(color, look);
  const float Y = luminance(color);
  EXPECT_NEAR(luminance(image.display[0]), 1 - std::exp(-2 * Y), 1e-6f);
  EXPECT_NEAR(image.display[0].r / image.display[0].g, 2, 1e-5);  // hue and saturation stay
  EXPECT_EQ(image.exposed[0], color);                             // untoned
}

TEST(Tone, exponential_is_right_from_the_faintest_to_the_brightest) {
  DevelopLook look;
  look.curve = DevelopLook::Curve::exponential;
  for (float Y = 1e-6f; Y < 50; Y *= 1.0137f) {
    const double expected = -std::expm1(-static_cast<double>(Y));
    // Relative: a luminance of three terms, a polynomial of seven and a ratio round by 1e-7 each.
    EXPECT_NEAR(static_cast<double>(developed({Y, Y, Y}, look).display[0].g), expected, 6e-7 * expected) << Y;
  }
}

TEST(Tone, extremes_do_not_break_the_exponential_curve) {
  DevelopLook look;
  look.curve = DevelopLook::Curve::exponential;
  EXPECT_EQ(developed({INFINITY, INFINITY, INFINITY}, look).display[0], (Rgb{1, 1, 1}));
  expect_color(developed({1e30f, 1e30f, 1e30f}, look).display[0], {1, 1, 1}, 1e-6f);
  EXPECT_EQ(developed({}, look).display[0], Rgb{});
  EXPECT_EQ(developed({NAN, 1, 1}, look).display[0], Rgb{});
}

TEST(Exposure, auto_white_is_the_99th_percentile_of_lit_pixels) {
  Radiance radiance;
  for (int i = 0; i <= 1000; ++i) {
    const auto Y =
        static_cast<float>((i * 617) % 1001);  // 0 to 1000, shuffled: 617 and 1001 have no common divisor
    radiance.physical.emplace_back(Y, Y, Y);
  }
  // 1000 lit pixels, 1 to 1000; position floor(0.99 * 999) = 989 holds 990.
  EXPECT_NEAR(auto_white_cd_m2(radiance), 990, 1e-3);
  EXPECT_EQ(auto_white_cd_m2({{}, std::vector<Rgbx>(2)}), 1);
}

class PictureFile : public testing::Test {
 protected:
  static Image ramp() {
    Image image{256, 2, 1, {}, {}, {}};
    for (int i = 0; i < 512; ++i) {
      const auto x = static_cast<float>(srgb_decoded((i % 256) / 255.0));
      image.display.push_back({x, 0.5f * x, i < 256 ? 1.0f : 0.0f});
      image.exposed.push_back({3 * x, -x, 1e6f});
    }
    return image;
  }
  template <class T>
  static std::vector<T> read(const std::string& path, OIIO::TypeDesc type) {
    const auto in = OIIO::ImageInput::open(path);
    EXPECT_TRUE(in) << path;
    if (!in) return {};
    EXPECT_EQ(in->spec().format, type);
    std::vector<T> out(static_cast<std::size_t>(in->spec().width * in->spec().height * 3));
    EXPECT_TRUE(in->read_image(0, 0, 0, 3, type, out.data()));
    return out;
  }
  TestFolder folder;
};

TEST_F(PictureFile, png_holds_the_encoded_picture_exactly) {
  const Image image = ramp();
  write_picture(folder.file("a.PNG"), image);
  EXPECT_EQ(read<std::uint8_t>(folder.file("a.PNG"), OIIO::TypeDesc::UINT8), encode_srgb8(image.display));
  write_picture(folder.file("b.png"), image, 16);
  EXPECT_EQ(read<std::uint16_t>(folder.file("b.png"), OIIO::TypeDesc::UINT16), encode_srgb16(image.display));
}

TEST_F(PictureFile, exr_holds_the_untoned_picture_exactly) {
  const Image image = ramp();
  write_picture(folder.file("a.exr"), image);
  const auto found = read<float>(folder.file("a.exr"), OIIO::TypeDesc::FLOAT);
  for (std::size_t i = 0; i < image.exposed.size(); ++i)
    EXPECT_EQ((Rgb{found[3 * i], found[3 * i + 1], found[3 * i + 2]}), image.exposed[i]);
}

TEST_F(PictureFile, jpeg_is_near) {
  const Image image = ramp();
  write_picture(folder.file("a.jpg"), image);
  const auto found = read<std::uint8_t>(folder.file("a.jpg"), OIIO::TypeDesc::UINT8);
  const auto expected = encode_srgb8(image.display);
  ASSERT_EQ(found.size(), expected.size());
  double sum = 0;
  for (std::size_t i = 0; i < found.size(); ++i) sum += std::abs(found[i] - expected[i]);
  EXPECT_LT(sum / static_cast<double>(found.size()), 6);  // quality 95, with a hard edge between the two rows
}

TEST_F(PictureFile, the_same_picture_makes_the_same_bytes) {
  const auto bytes = [&](const std::string& name) {
    write_picture(folder.file(name), ramp());
    std::ifstream in(folder.file(name), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  EXPECT_EQ(bytes("a.png"), bytes("b.png"));
}

TEST_F(PictureFile, unknown_endings_are_refused) {
  for (const char* name : {"a", "a.gif", "a.png.txt", ".png", "a.jpeg2"})
    EXPECT_NE(complaint([&] { write_picture(folder.file(name), ramp()); }).find("expected .png"),
              std::string::npos)
        << name;
  EXPECT_NE(complaint([&] { write_picture(folder.file("a.jpg"), ramp(), 16); }), "");
  EXPECT_TRUE(folder.names().empty());
}

TEST_F(PictureFile, failure_leaves_nothing_behind) {
  EXPECT_THROW(write_picture(folder.file("missing/a.png"), ramp()), WorkError);
  std::filesystem::create_directory(folder.file("taken.png"));
  EXPECT_THROW(write_picture(folder.file("taken.png"), ramp()), WorkError);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"taken.png"});
}

}  // namespace
}  // namespace nullcone::postrender
