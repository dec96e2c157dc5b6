// False colours: which number a pixel shows, scales, legends, and channels as numbers in a file.
#include <OpenImageIO/imageio.h>

#include <cmath>

#include "postrender/bitmap_font.h"
#include "postrender/channel_values.h"
#include "postrender/color.h"
#include "postrender/legend.h"
#include "postrender/picture_file.h"
#include "tests/postrender_fixture.h"

namespace nullcone::postrender {
namespace {

const ChannelInfo& info(std::string_view name) {
  for (const ChannelInfo& channel : kRayChannelInfo)
    if (channel.name == name) return channel;
  return *std::ranges::find(kHitChannelInfo, name, &ChannelInfo::name);
}

/// Two crossings in the first pixel, one in the second, none in the third.
Dataset three_pixels() {
  return make_dataset(3, 1, {{"earth"}, {"moon"}}, [](int column, int) {
    TestHit near, far;
    near.shift = 0.5f;
    far.id = 2;
    far.shift = 3;
    if (column == 0) return std::vector{near, far};
    return std::vector<TestHit>(column == 1 ? 1 : 0, far);
  });
}

std::vector<float> values_of(const std::string& name, const Dataset& data) {
  return channel_values(find_channel(name, data.manifest, "a.exr"), data);
}

TEST(ChannelValues, are_those_of_the_nearest_crossing) {
  const std::vector<float> shift = values_of("shift", three_pixels()), id = values_of("id", three_pixels());
  EXPECT_EQ(shift[0], 0.5f);
  EXPECT_EQ(shift[1], 3.0f);
  EXPECT_TRUE(std::isnan(shift[2]));
  EXPECT_EQ(id[0], 1.0f);
  EXPECT_EQ(id[1], 2.0f);
  EXPECT_TRUE(std::isnan(id[2]));
}

TEST(ChannelValues, of_rays_are_the_worst_of_the_samples) {
  Dataset data;
  data.manifest.set_size(2, 2);
  data.manifest.samples = 2;
  for (std::uint32_t ray = 0; ray < 16; ++ray) {
    data.rays.status.push_back(ray == 9 ? 6 : 1);  // row 2, column 1: the first pixel of the second line
    data.rays.steps.push_back(ray);
    data.rays.error.push_back(ray == 15 ? NAN : ray == 3 ? INFINITY : 0.5f);
    data.rays.drift.push_back(0);
  }
  EXPECT_EQ(values_of("status", data), (std::vector<float>{1, 1, 6, 1}));
  EXPECT_EQ(values_of("steps", data), (std::vector<float>{5, 7, 13, 15}));
  const std::vector<float> error = values_of("error", data);
  EXPECT_EQ(error[0], 0.5f);
  EXPECT_EQ(error[1], INFINITY);
  EXPECT_TRUE(std::isnan(error[3]));
}

TEST(ChannelValues, of_every_channel_can_be_had) {
  Dataset data = one_pixel({{}});
  data.hits.channels = data.manifest.channels = kAllChannels;
  data.hits.sample.push_back(0);
  for (auto* group : {&data.hits.N, &data.hits.K, &data.hits.P})
    for (auto& column : *group) column.push_back(0.25f);
  for (auto& column : data.hits.duv) column.push_back(0.125f);
  for (const ChannelInfo& channel : kHitChannelInfo)
    EXPECT_EQ(values_of(std::string(channel.name), data).size(), 1u) << channel.name;
  for (const ChannelInfo& channel : kRayChannelInfo)
    EXPECT_EQ(values_of(std::string(channel.name), data).size(), 1u) << channel.name;
  EXPECT_EQ(values_of("K.Z", data)[0], 0.25f);
  EXPECT_EQ(values_of("duv.Vy", data)[0], 0.125f);
}

TEST(ChannelValues, that_there_are_not_are_refused) {
  const Manifest manifest = one_pixel({{}}).manifest;
  const auto about = [&](const char* name) {
    return complaint([&] { find_channel(name, manifest, "a.exr"); });
  };
  EXPECT_EQ(about("N.X"), "a.exr: has no channel 'N.X'; trace with records.channels that include it");
  for (const char* name : {"uv", "colour", ""})
    EXPECT_NE(about(name).find("expected one of status, steps"), std::string::npos) << about(name);
}

/// Two pixels; light of the lamp "sun" reaches the first along one of two paths, the second not at all.
Dataset two_lit_pixels() {
  Dataset data = make_dataset(2, 1, {{"earth"}}, [](int, int) { return std::vector<TestHit>(1); });
  data.manifest.set_lights({{"sun", 0}}, 2);
  set_lamps(data.hits, {"sun"}, 2);
  data.hits.light[0] = {data.hits.light[0].prefix, {3, 0}, {0.5f, 1}, {-2, 0}, {-1, 0}};
  data.hits.light[1] = {data.hits.light[1].prefix, {0, 0}, {1, 1}, {0, 0}, {0, 0}};
  return data;
}

TEST(ChannelValues, of_light_are_those_of_lamp_and_path) {
  const Dataset data = two_lit_pixels();
  EXPECT_EQ(values_of("light.sun.0.E", data), (std::vector<float>{3, 0}));
  EXPECT_EQ(values_of("light.sun.1.E", data), (std::vector<float>{0, 0}));
  const std::vector<float> shift = values_of("light.sun.0.shift", data), t = values_of("light.sun.0.t", data);
  EXPECT_EQ(shift[0], 0.5f);
  EXPECT_TRUE(std::isnan(shift[1]));  // no light that it could be the shift of
  EXPECT_EQ(t[0], -2.0f);
  EXPECT_TRUE(std::isnan(values_of("light.sun.1.tau", data)[0]));
  const ChannelChoice choice = find_channel("light.sun.1.tau", data.manifest, "a.exr");
  EXPECT_EQ(choice.wanted(), ChannelSet::of("light"));
  EXPECT_EQ(choice.name, "light.sun.1.tau");
  EXPECT_EQ(choice.info.name, "tau");
}

TEST(ChannelValues, of_light_that_there_are_not_are_refused) {
  const Manifest lit = two_lit_pixels().manifest, dark = one_pixel({{}}).manifest;
  const auto about = [](const char* name, const Manifest& manifest) {
    return complaint([&] { find_channel(name, manifest, "a.exr"); });
  };
  for (const char* name : {"light.sun.2.E", "light.sun.0.F", "light.moon.0.E", "light", "light.sun.0.", "E"})
    EXPECT_NE(about(name, lit).find("light.sun.<0 to 1>.E, light.sun.<0 to 1>.shift"), std::string::npos)
        << name;
  EXPECT_NE(about("light.sun.0.E", dark).find("expected one of status, steps"), std::string::npos);
  EXPECT_EQ(about("light.sun.0.E", dark).find("light.sun.<"), std::string::npos);
}

TEST(ColorScales, of_light_are_logarithmic_or_those_of_the_channel) {
  EXPECT_EQ(scale_kind(kLightChannelInfo[0]), ScaleKind::logarithmic);
  EXPECT_EQ(scale_kind(kLightChannelInfo[1]), ScaleKind::shift);
  EXPECT_EQ(scale_kind(kLightChannelInfo[2]), ScaleKind::linear);
}

ColorScale scale_of(const char* channel, const std::vector<float>& values, std::optional<Range> range = {}) {
  return choose_scale(info(channel), values, range);
}

TEST(ColorScales, run_from_the_least_to_the_greatest_finite_number) {
  const ColorScale t = scale_of("t", {-4, NAN, -INFINITY, 2, -1});
  EXPECT_EQ(t.range, (Range{-4, 2}));
  EXPECT_EQ(t.color(-4), sequential_color(0));
  EXPECT_EQ(t.color(-1), sequential_color(0.5));
  EXPECT_EQ(t.color(99), sequential_color(1));  // beyond
  EXPECT_EQ(t.color(NAN), kMissing);
  EXPECT_EQ(t.color(-INFINITY), kInfinite);
  EXPECT_EQ(scale_of("t", {-4, 2}, Range{0, 10}).range, (Range{0, 10}));
  const ColorScale constant = scale_of("t", {7, 7});
  EXPECT_LT(constant.range.first, 7);
  EXPECT_GT(constant.range.second, 7);
}

TEST(ColorScales, of_errors_are_logarithmic_between_percentiles) {
  std::vector<float> errors(1000, 0.0f);  // those that are 0 do not count
  for (std::size_t i = 0; i <= 100; ++i) errors[7 * i] = std::pow(10.0f, -0.1f * static_cast<float>(i));
  const ColorScale error = scale_of("error", errors);
  EXPECT_NEAR(std::log10(error.range.first), -9.9, 1e-5);
  EXPECT_NEAR(std::log10(error.range.second), -0.1, 1e-5);
  EXPECT_EQ(error.color(0), kZero);
  const ColorScale given = scale_of("error", errors, Range{1e-8, 1e-4});
  EXPECT_NEAR(given.place(1e-6), 0.5, 1e-12);
  EXPECT_EQ(scale_of("drift", {0, 0}).color(0), kZero);
}

TEST(ColorScales, of_the_shift_are_white_at_one) {
  const ColorScale shift = scale_of("shift", {0.25f, 1, 2});
  EXPECT_EQ(shift.range, (Range{0.25, 2}));
  const Rgb white = shift.color(1), red = shift.color(0.5f), blue = shift.color(2);
  EXPECT_EQ(white, (Rgb{1, 1, 1}));
  EXPECT_GT(red.r, 2 * red.b);
  EXPECT_GT(blue.b, 2 * blue.r);
  EXPECT_EQ(scale_of("shift", {1.2f, 1.5f}).range.first, 1);  // 1 is always on the scale
  EXPECT_EQ(shift.color(0), diverging_color(-1));
}

TEST(ColorScales, of_names_have_a_colour_each) {
  const ColorScale id = scale_of("id", {1, 2});
  EXPECT_EQ(id.color(2), default_color(2));  // as without a look
  std::vector<Rgb> seen;
  for (std::uint32_t i = 0; i < kStatusNames.size(); ++i) {
    const Rgb color = scale_of("status", {}).color(static_cast<float>(i));
    EXPECT_EQ(std::ranges::find(seen, color), seen.end()) << i;
    seen.push_back(color);
  }
}

TEST(ColorScales, get_lighter_all_along) {
  for (int i = 0; i < 100; ++i)
    EXPECT_LT(luminance(sequential_color(i / 100.0)), luminance(sequential_color((i + 1) / 100.0))) << i;
  for (int i = 0; i < 100; ++i)
    for (const double side : {-1.0, 1.0})
      EXPECT_GT(luminance(diverging_color(side * i / 100)), luminance(diverging_color(side * (i + 1) / 100)));
}

TEST(ColorScales, ranges_that_make_no_sense_are_refused) {
  EXPECT_EQ(parse_range("-3,2.5"), (Range{-3, 2.5}));
  EXPECT_EQ(parse_range("1e-9,1"), (Range{1e-9, 1}));
  for (const char* bad : {"", "1", "1,", ",1", "2,1", "1,1", "1,2,3", "a,b", "1;2", "nan,1", "0,inf"})
    EXPECT_NE(complaint([&] { parse_range(bad); }).find("--range"), std::string::npos) << bad;
  EXPECT_NE(complaint([] { scale_of("id", {}, Range{1, 2}); }), "");
  EXPECT_NE(complaint([] { scale_of("shift", {}, Range{0, 2}); }), "");
  EXPECT_EQ(complaint([] { scale_of("t", {}, Range{-1, 2}); }), "");
}

TEST(Legends, have_ticks_at_round_numbers) {
  const auto about = [](ScaleKind kind, Range range, int most) {
    std::string out;
    for (const double tick : ticks({kind, range, ""}, most)) out += tick_text(tick) + " ";
    return out;
  };
  EXPECT_EQ(about(ScaleKind::linear, {0, 1}, 5), "0 0.2 0.4 0.6 0.8 1 ");
  EXPECT_EQ(about(ScaleKind::linear, {-88, -14}, 4), "-80 -60 -40 -20 ");
  EXPECT_EQ(about(ScaleKind::logarithmic, {1e-12, 1e-6}, 8), "1e-12 1e-11 1e-10 1e-9 1e-8 1e-7 1e-6 ");
  EXPECT_EQ(about(ScaleKind::logarithmic, {1e-12, 1e-6}, 4), "1e-12 1e-10 1e-8 1e-6 ");
  EXPECT_EQ(about(ScaleKind::logarithmic, {9e-10, 7e-8}, 12), "1e-9 2e-9 5e-9 1e-8 2e-8 5e-8 ");
  EXPECT_EQ(about(ScaleKind::shift, {0.8, 1.2}, 5), "0.8 0.9 1 1.1 1.2 ");
}

TEST(Legends, stand_below_the_picture) {
  const Dataset data = three_pixels();
  const std::vector<float> values = values_of("shift", data);
  const ColorScale scale = choose_scale(info("shift"), values, {});
  const Image image = false_color_picture(scale, info("shift"), data.manifest, values);
  EXPECT_EQ(image.width, 360);
  EXPECT_GT(image.height, 20);
  EXPECT_EQ(image.display.size(), static_cast<std::size_t>(image.width * image.height));
  EXPECT_EQ(image.display[0], scale.color(0.5f));
  EXPECT_EQ(image.display[1], scale.color(3));
  EXPECT_EQ(image.display[2], kMissing);
  // The bar runs through the whole scale, and its ends stand in the picture.
  for (const Rgb color : {diverging_color(1), diverging_color(-std::log(2.0) / std::log(3.0))}) {
    const bool found = std::ranges::any_of(image.display, [&](Rgb c) {
      return std::abs(c.r - color.r) + std::abs(c.g - color.g) + std::abs(c.b - color.b) < 0.02f;
    });
    EXPECT_TRUE(found);
  }
}

TEST(Legends, cope_with_every_channel_and_with_nothing) {
  Manifest manifest;
  manifest.set_size(2, 2);
  manifest.objects = {{"earth"}};
  const std::vector<std::vector<float>> cases = {{NAN, NAN, NAN, NAN},
                                                 {0, 0, 0, 0},
                                                 {1, 1, 1, 1},
                                                 {INFINITY, -INFINITY, NAN, 0},
                                                 {1e30f, -1e30f, 1e-30f, 2}};
  for (const std::vector<float>& values : cases)
    for (const ChannelInfo& channel : kHitChannelInfo) {
      const ColorScale scale = choose_scale(channel, values, {});
      for (const Rgb c : false_color_picture(scale, channel, manifest, values).display)
        EXPECT_TRUE(c.r >= 0 && c.r <= 1 && c.g >= 0 && c.g <= 1 && c.b >= 0 && c.b <= 1) << channel.name;
    }
}

TEST(Legends, have_a_glyph_for_every_letter) {
  std::vector<std::string> seen;
  for (char letter = ' '; letter <= '~'; ++letter) {
    std::string dots;
    for (int y = 0; y < kGlyphHeight; ++y)
      for (int x = 0; x < kGlyphWidth; ++x) dots += glyph_dot(letter, x, y) ? '#' : '.';
    EXPECT_EQ(std::ranges::find(seen, dots), seen.end()) << letter;
    seen.push_back(dots);
  }
  EXPECT_TRUE(glyph_dot('T', 0, 0) && glyph_dot('T', 2, 6) && !glyph_dot('T', 0, 6) && glyph_dot('p', 0, 8));
}

TEST(ChannelFiles, hold_the_numbers_in_the_frame_of_the_whole_picture) {
  TestFolder folder;
  Manifest manifest;
  manifest.set_size(3, 2);
  manifest.height = 10;
  manifest.first_line = 4;
  const std::vector<float> values = {1, NAN, INFINITY, -2.5f, 0, 1e-30f};
  write_channel(folder.file("a.exr"), "uv.U", manifest, values);
  const auto in = OIIO::ImageInput::open(folder.file("a.exr"));
  ASSERT_TRUE(in);
  const OIIO::ImageSpec& spec = in->spec();
  EXPECT_EQ(spec.channelnames, std::vector<std::string>{"uv.U"});
  EXPECT_EQ(spec.format, OIIO::TypeDesc::FLOAT);
  EXPECT_EQ((std::array{spec.width, spec.height, spec.x, spec.y}), (std::array{3, 2, 0, 4}));
  EXPECT_EQ((std::array{spec.full_width, spec.full_height, spec.full_x, spec.full_y}),
            (std::array{3, 10, 0, 0}));
  std::vector<float> found(6);
  ASSERT_TRUE(in->read_image(0, 0, 0, 1, OIIO::TypeDesc::FLOAT, found.data()));
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_TRUE(found[i] == values[i] || (std::isnan(found[i]) && std::isnan(values[i]))) << i;
  EXPECT_EQ(folder.names().size(), 1u);
}

}  // namespace
}  // namespace nullcone::postrender
