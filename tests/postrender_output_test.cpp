// Pictures in files: their kinds, and what they say about their colours.
#include <OpenImageIO/imageio.h>
#include <lcms2.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "postrender/color.h"
#include "postrender/color_space.h"
#include "postrender/develop.h"
#include "postrender/picture_file.h"
#include "postrender/stack.h"
#include "tests/postrender_fixture.h"

namespace nullcone::postrender {
namespace {

class PictureFile : public testing::Test {
 protected:
  static Image ramp() {
    Image image{256, 2, 1, {}, {}, {}, {}};
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

TEST_F(PictureFile, tiff_holds_8_and_16_encoded_and_32_linear_bits) {
  const Image image = ramp();
  write_picture(folder.file("a.tif"), image);
  EXPECT_EQ(read<std::uint8_t>(folder.file("a.tif"), OIIO::TypeDesc::UINT8), encode_srgb8(image.display));
  write_picture(folder.file("b.tiff"), image, 16);
  EXPECT_EQ(read<std::uint16_t>(folder.file("b.tiff"), OIIO::TypeDesc::UINT16), encode_srgb16(image.display));
  write_picture(folder.file("c.tif"), image, 32);
  const auto found = read<float>(folder.file("c.tif"), OIIO::TypeDesc::FLOAT);
  for (std::size_t i = 0; i < image.exposed.size(); ++i)
    EXPECT_EQ((Rgb{found[3 * i], found[3 * i + 1], found[3 * i + 2]}), image.exposed[i]);
}

TEST_F(PictureFile, half_exr_is_limited_and_within_2_to_the_minus_11) {
  const Image image = ramp();
  write_picture(folder.file("a.exr"), image, 16);
  const auto in = OIIO::ImageInput::open(folder.file("a.exr"));
  ASSERT_EQ(in->spec().format, OIIO::TypeDesc::HALF);
  std::vector<float> found(256 * 2 * 3);
  ASSERT_TRUE(in->read_image(0, 0, 0, 3, OIIO::TypeDesc::FLOAT, found.data()));
  for (std::size_t i = 0; i < image.exposed.size(); ++i) {
    EXPECT_NEAR(found[3 * i], image.exposed[i].r, 5e-4f * image.exposed[i].r);
    EXPECT_EQ(found[3 * i + 2], 65504);
  }
}

TEST_F(PictureFile, jpeg_quality_is_that_of_the_output) {
  Image image = ramp();
  const auto size = [&](int quality) {
    image.output.jpeg_quality = quality;
    write_picture(folder.file("a.jpg"), image);
    return std::filesystem::file_size(folder.file("a.jpg"));
  };
  EXPECT_LT(size(30), size(80));
  EXPECT_LT(size(80), size(100));
}

TEST_F(PictureFile, what_is_encoded_already_is_written_as_it_is) {
  Image image = ramp();
  image.encoded = encode_srgb8(image.display);
  image.display.clear();
  write_picture(folder.file("a.png"), image);
  EXPECT_EQ(read<std::uint8_t>(folder.file("a.png"), OIIO::TypeDesc::UINT8), image.encoded);
  EXPECT_NE(complaint([&] {
              image.exposed.clear();
              write_picture(folder.file("a.exr"), image);
            }),
            "");
}

/// The profile that a file holds.
struct OpenProfile {
  explicit OpenProfile(const std::string& path) {
    const auto in = OIIO::ImageInput::open(path);
    const OIIO::ParamValue* bytes = in ? in->spec().find_attribute("ICCProfile") : nullptr;
    if (bytes != nullptr)
      profile = cmsOpenProfileFromMem(bytes->data(), static_cast<cmsUInt32Number>(bytes->datasize()));
  }
  ~OpenProfile() {
    if (profile != nullptr) cmsCloseProfile(profile);
  }
  OpenProfile(const OpenProfile&) = delete;
  OpenProfile& operator=(const OpenProfile&) = delete;

  /// Of encoded components, by what a colour-managed program does with the file.
  Xyz xyz(const std::array<double, 3>& rgb) const {
    cmsHPROFILE connection = cmsCreateXYZProfile();
    cmsHTRANSFORM transform = cmsCreateTransform(profile, TYPE_RGB_DBL, connection, TYPE_XYZ_DBL,
                                                 INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOOPTIMIZE);
    Xyz out{};
    cmsDoTransform(transform, rgb.data(), out.data(), 1);
    cmsDeleteTransform(transform);
    cmsCloseProfile(connection);
    return out;
  }
  cmsHPROFILE profile = nullptr;
};

/// Linear components as ICC profiles have them: their XYZ, adapted to D50.
Xyz in_profile(OutputSpace space, const std::array<double, 3>& linear) {
  const Xyz d50 = {0.9642, 1, 0.8249};
  const double sum = d50[0] + d50[1] + d50[2];
  const Matrix3 adapted = *adaptation(kD65, {d50[0] / sum, d50[1] / sum}), from = to_xyz(space);
  Xyz out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) out[i] += adapted[i][j] * from[j][k] * linear[k];
  return out;
}

TEST_F(PictureFile, holds_a_profile_that_says_what_its_numbers_mean) {
  Image image = ramp();
  for (const OutputSpace space : {OutputSpace::srgb, OutputSpace::display_p3})
    for (const auto& [name, bits] :
         {std::pair{"a.png", 8}, {"b.png", 16}, {"a.jpg", 8}, {"a.tif", 8}, {"b.tif", 16}, {"c.tif", 32}}) {
      image.output.space = space;
      write_picture(folder.file(name), image, bits);
      const OpenProfile found(folder.file(name));
      if (space == OutputSpace::srgb && std::string(name).ends_with(".png")) {  // a chunk of its own
        EXPECT_EQ(OIIO::ImageInput::open(folder.file(name))->spec().get_string_attribute("oiio:ColorSpace"),
                  "sRGB");
        continue;
      }
      ASSERT_TRUE(found.profile != nullptr) << name;
      for (const std::array<double, 3>& rgb :
           {std::array{1.0, 1.0, 1.0}, {1.0, 0.0, 0.0}, {0.02, 0.5, 0.8}}) {
        std::array<double, 3> linear = rgb;
        if (bits != 32)
          for (double& x : linear) x = srgb_decoded(x);
        const Xyz xyz = found.xyz(rgb), expected = in_profile(space, linear);
        for (std::size_t i = 0; i < 3; ++i)  // profiles hold 16 bits behind the point, D50 four digits
          EXPECT_NEAR(xyz[i], expected[i], 2e-4) << name << " " << name_of(space);
      }
    }
}

TEST_F(PictureFile, exr_holds_the_chromaticities) {
  Image image = ramp();
  for (const auto& [name, space] : kOutputSpaces) {
    image.output.space = space;
    write_picture(folder.file("a.exr"), image);
    std::array<float, 8> xy{};
    const auto in = OIIO::ImageInput::open(folder.file("a.exr"));
    ASSERT_TRUE(
        in->spec().getattribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), xy.data()))
        << name;
    const Primaries p = primaries_of(space);
    const std::array<double, 8> expected = {p.red.x,  p.red.y,  p.green.x, p.green.y,
                                            p.blue.x, p.blue.y, p.white.x, p.white.y};
    for (std::size_t i = 0; i < 8; ++i) EXPECT_FLOAT_EQ(xy[i], static_cast<float>(expected[i])) << name;
  }
}

TEST_F(PictureFile, linear_spaces_need_float_files) {
  Image image = ramp();
  for (const OutputSpace space : {OutputSpace::linear_rec709, OutputSpace::xyz}) {
    image.output.space = space;
    for (const auto& [name, bits] :
         {std::pair{"a.png", 0}, {"a.png", 16}, {"a.jpg", 0}, {"a.tif", 0}, {"a.tif", 16}})
      EXPECT_NE(complaint([&] {
                  write_picture(folder.file(name), image, bits);
                }).find("is linear; expected .exr, or .tif with --bits 32"),
                std::string::npos)
          << name;
    EXPECT_TRUE(folder.names().empty());
    write_picture(folder.file("b.tif"), image, 32);
    write_picture(folder.file("b.exr"), image, 16);
    std::filesystem::remove(folder.file("b.tif"));
    std::filesystem::remove(folder.file("b.exr"));
  }
}

TEST_F(PictureFile, bits_must_fit_the_kind) {
  for (const auto& [name, bits] :
       {std::pair{"a.png", 32}, {"a.jpg", 16}, {"a.exr", 8}, {"a.tif", 12}, {"a.tif", -1}, {"a.png", 1}})
    EXPECT_NE(complaint([&] { check_picture_name(name, bits); }).find("--bits: expected "), std::string::npos)
        << name;
}

TEST_F(PictureFile, the_parts_that_it_asks_for_are_those_that_it_needs) {
  const Dataset data = flat_map(40, 30);
  const auto bytes = [&](const std::string& name) {
    std::ifstream in(folder.file(name), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  Renderer renderer(data);
  const Look look = look_of(R"({"objects":{"earth":{"texture":{"type":"checkerboard","counts":[4,3],
      "colors":[[1,0.2,0],[0,0.1,0.7]]}}}})",
                            data.manifest);
  for (const auto& [name, bits] : {std::pair{"a.png", 0},
                                   {"a.png", 16},
                                   {"a.jpg", 0},
                                   {"a.tif", 0},
                                   {"a.tif", 32},
                                   {"a.exr", 0},
                                   {"a.exr", 16}}) {
    Image image;
    renderer.render(look, parts_in(name, bits), image);
    write_picture(folder.file(name), image, bits);
    const std::string lean = bytes(name);
    write_picture(folder.file(name), renderer.render(look), bits);
    EXPECT_TRUE(lean == bytes(name)) << name << " " << bits;
  }
}

TEST_F(PictureFile, the_same_picture_makes_the_same_bytes) {
  Image image = ramp();
  const auto bytes = [&](const std::string& name) {
    write_picture(folder.file(name), image);
    std::ifstream in(folder.file(name), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  image.output.space = OutputSpace::display_p3;
  std::vector<std::string> first;
  const std::vector<std::string> names = {"a.png", "a.jpg", "a.tif", "a.exr"};
  for (const std::string& name : names) first.push_back(bytes(name));
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // another second, for dates
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_TRUE(bytes(names[i]) == first[i]) << names[i];
}

TEST(Stack, keeps_what_pictures_are) {
  Image image{1, 1, 1, {}, {}, {1, 2, 3}, {}};
  const Image both = stack(std::vector{image, image});
  EXPECT_EQ(both.encoded.size(), 3U * 4U);
  EXPECT_TRUE(both.display.empty());
  Image other = image;
  other.output.space = OutputSpace::display_p3;
  EXPECT_NE(complaint([&] { stack(std::vector{image, other}); }), "");
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
