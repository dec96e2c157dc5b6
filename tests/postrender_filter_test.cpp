// Several samples a pixel, and pixel filters.
#include <tbb/global_control.h>

#include <cmath>

#include "postrender/pixel_filter.h"
#include "postrender/sample_grid.h"
#include "tests/postrender_fixture.h"

namespace nullcone::postrender {
namespace {

using Type = PixelFilter::Type;
const std::vector<PixelFilter> kFilters = {{Type::box, 1},        {Type::box, 2.5},    {Type::gaussian, 2},
                                           {Type::gaussian, 3.3}, {Type::mitchell, 4}, {Type::mitchell, 2}};

std::string text_of(const PixelFilter& filter) {
  const char* names[] = {"box", "gaussian", "mitchell"};
  return R"({"pixel_filter":{"type":")" + std::string(names[static_cast<int>(filter.type)]) +
         R"(","width":)" + std::to_string(filter.width) + "}}";
}

/// What the samples of a picture see, as a picture of `samples` by `samples` samples a pixel would record it.
Dataset gathered(const Dataset& grid, int samples) {
  Dataset out;
  const int width = grid.manifest.width / samples, lines = grid.manifest.lines / samples;
  out.manifest.set_size(width, lines);
  out.manifest.samples = samples;
  out.manifest.objects = grid.manifest.objects;
  out.manifest.set_lights(grid.manifest.lights, grid.manifest.light_paths);
  out.hits = empty_like(grid.hits);
  out.hits.channels = out.manifest.channels = grid.hits.channels | ChannelSet::of("sample");
  for (int pixel = 0; pixel < width * lines; ++pixel) {
    std::vector<std::pair<std::size_t, std::uint32_t>> list;
    for (int sample = 0; sample < samples * samples; ++sample) {
      const int row = pixel / width * samples + sample / samples,
                column = pixel % width * samples + sample % samples;
      const auto ray = static_cast<std::size_t>(row * grid.manifest.width + column);
      for (std::size_t hit = grid.hits.offset[ray]; hit < grid.hits.offset[ray + 1]; ++hit)
        list.emplace_back(hit, static_cast<std::uint32_t>(sample));
    }
    std::ranges::stable_sort(list, {}, [&](const auto& entry) { return grid.hits.Z[entry.first]; });
    for (const auto& [hit, sample] : list) {
      out.hits.sample.push_back(sample);
      for_each_channel(
          [&, at = hit](const ChannelInfo& channel, const auto& from, auto& to) {
            if (channel.name != "sample") to.push_back(from[at]);
          },
          grid.hits, out.hits);
    }
    out.hits.offset.push_back(out.hits.Z.size());
  }
  return out;
}

/// A dataset of one object of white, where `seen` says so, and of `samples` by `samples` samples a pixel.
Dataset white_where(int width, int lines, int samples, const std::function<bool(int, int)>& seen) {
  return gathered(
      make_dataset(width * samples, lines * samples, {{"earth"}},
                   [&](int column, int row) { return std::vector<TestHit>(seen(column, row) ? 1 : 0); }),
      samples);
}

Image white_picture(Dataset data, const PixelFilter& filter) {
  nlohmann::json look = nlohmann::json::parse(text_of(filter));
  look["objects"]["earth"]["texture"] = {{"type", "color"}, {"rgb", {1, 1, 1}}};
  return picture(std::move(data), look.dump());
}

TEST(Samples, keep_their_light) {
  Dataset grid = make_dataset(6, 4, {{"earth"}}, [](int column, int row) {
    return std::vector<TestHit>(static_cast<std::size_t>(column + 2 * row) % 3);
  });
  grid.manifest.set_lights({{"sun", 0}, {"moon", 0}}, 1);
  set_lamps(grid.hits, {"sun", "moon"}, 1);
  for (std::size_t k = 0; k < grid.hits.count(); ++k)
    for (LightPath& path : grid.hits.light) {
      const auto value = static_cast<float>(2 * k + path.prefix.size());
      path.E.push_back(value), path.shift.push_back(1 + value), path.t.push_back(-value);
      path.tau.push_back(value / 2);
    }
  const Dataset together = gathered(grid, 2), apart = by_samples(together);
  EXPECT_NE(together.hits.light[0].E, grid.hits.light[0].E);
  for (const std::size_t lamp : {0u, 1u}) {
    EXPECT_EQ(apart.hits.light[lamp].E, grid.hits.light[lamp].E);
    EXPECT_EQ(apart.hits.light[lamp].tau, grid.hits.light[lamp].tau);
  }
}

TEST(PixelFilters, have_their_closed_forms) {
  const PixelFilter mitchell{Type::mitchell, 4}, gaussian{Type::gaussian, 2}, box{Type::box, 1};
  EXPECT_DOUBLE_EQ(filter_value(mitchell, 0), 8.0 / 9);
  EXPECT_NEAR(filter_value(mitchell, 1), 1.0 / 18, 1e-15);
  EXPECT_NEAR(filter_value(mitchell, -1.5), -5.0 / 144, 1e-15);
  EXPECT_NEAR(filter_value(mitchell, 0.5), 77.0 / 144, 1e-15);
  EXPECT_NEAR(filter_value(mitchell, 2), 0, 1e-15);
  EXPECT_NEAR(filter_value({Type::mitchell, 2}, 0.5), 1.0 / 18, 1e-15);  // half as wide
  EXPECT_NEAR(filter_value(gaussian, 0.5), std::exp(-0.5), 1e-15);       // sigma is a quarter of the width
  EXPECT_EQ(filter_value(gaussian, 1.01), 0);
  EXPECT_EQ(filter_value(box, 0.49), 1);
  EXPECT_EQ(filter_value(box, 0.51), 0);
}

TEST(PixelFilters, weigh_with_one_in_all) {
  for (const PixelFilter& filter : kFilters)
    for (const int samples : {1, 2, 3, 4}) {
      const FilterTable table(filter, 7, samples);
      for (std::size_t pixel = 0; pixel < 7; ++pixel) {
        double sum = 0;
        std::size_t last = 0;
        table.for_each_sample(pixel, [&](float weight, std::size_t i) {
          sum += static_cast<double>(weight);
          last = i;
        });
        EXPECT_NEAR(sum, 1, 1e-6);
        EXPECT_LT(last, static_cast<std::size_t>(7 * samples));
      }
    }
  // The weights of Mitchell's filter in the middle of a line are its values, because they add up to 1 anyway.
  const FilterTable table({Type::mitchell, 4}, 9, 1);
  std::vector<float> weights;
  table.for_each_sample(4, [&](float weight, std::size_t) { weights.push_back(weight); });
  ASSERT_EQ(weights.size(), 5u);
  const std::array expected = {0.0, 1.0 / 18, 8.0 / 9, 1.0 / 18, 0.0};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(static_cast<double>(weights[i]), expected[i], 1e-7);
}

TEST(PixelFilters, leave_a_constant_picture_alone) {
  for (const PixelFilter& filter : kFilters)
    for (const int samples : {1, 2, 3}) {
      const Image image = white_picture(white_where(6, 5, samples, [](int, int) { return true; }), filter);
      EXPECT_EQ(image.width, 6);
      EXPECT_EQ(image.height, 5);
      for (const Rgb c : image.exposed)
        expect_color(c, {1, 1, 1}, 2e-6f);  // rounding of up to 12 + 12 weights
    }
}

TEST(PixelFilters, cover_an_edge_in_steps) {
  // A half plane that ends within the second of three pixels, k quarters from its left side.
  for (int k = 0; k <= 4; ++k) {
    const Image image =
        white_picture(white_where(3, 2, 4, [=](int column, int) { return column < 4 + k; }), {});
    EXPECT_EQ(image.exposed[3].r, 1);
    EXPECT_EQ(image.exposed[4].r, static_cast<float>(k) / 4);
    EXPECT_EQ(image.exposed[5].r, 0);
  }
}

TEST(PixelFilters, keep_the_light_of_a_point) {
  // One sample of white far from the borders: the picture's light is that of a sample, 1/9. Box and Mitchell
  // add up exactly wherever it stands within its pixel; the Gaussian, which is cut at two sigma, by 3 % along
  // each axis, and exactly in the mean over all places.
  for (const PixelFilter& filter : {kFilters[0], kFilters[2], kFilters[4]}) {
    double mean = 0;
    for (int x = 0; x < 3; ++x)
      for (int y = 0; y < 3; ++y) {
        const auto seen = [=](int column, int row) { return column == 12 + x && row == 12 + y; };
        double sum = 0;
        for (const Rgb c : white_picture(white_where(9, 9, 3, seen), filter).exposed)
          sum += 9 * static_cast<double>(c.r);
        EXPECT_NEAR(sum, 1, filter.type == Type::gaussian ? 0.07 : 1e-5);
        mean += sum / 9;
      }
    EXPECT_NEAR(mean, 1, 1e-5);
  }
}

/// Two half-transparent objects, varying everywhere, with a steep texture.
Dataset layered(int width, int lines) {
  return make_dataset(width, lines, {{"near"}, {"far"}}, [](int column, int row) {
    TestHit near, far;
    near.u = 0.03f * static_cast<float>(column % 30);
    near.v = 0.04f * static_cast<float>(row % 20);
    near.opacity = 0.4f;
    near.shift = 0.8f + 0.01f * static_cast<float>(row);
    far.id = 2;
    far.u = 0.01f * static_cast<float>(row);
    return column % 7 == 3 ? std::vector<TestHit>{} : std::vector{near, far};
  });
}
constexpr const char* kLayeredLook = R"({"objects":{"near":{"texture":{"type":"checkerboard","counts":[9,5],
    "colors":[[1,0,0],[0,1,0]]}},"far":{"spectrum":{"type":"black_body","temperature_K":5000}}}})";

std::string with_filter(const PixelFilter& filter) {
  nlohmann::json look = nlohmann::json::parse(kLayeredLook);
  look.update(nlohmann::json::parse(text_of(filter)));
  return look.dump();
}

TEST(Samples, are_shaded_as_the_pixels_of_their_grid) {
  // Filtering by hand what the grid of samples shows gives the picture.
  const int samples = 3;
  const std::string look = R"({"objects":{"near":{"texture":{"type":"checkerboard","counts":[9,5],
    "colors":[[1,0,0],[0,1,0]]}}}})";
  const Dataset grid = layered(24, 15);
  const Image fine = picture(grid, look), image = picture(gathered(grid, samples), look);
  ASSERT_EQ(image.width, 8);
  ASSERT_EQ(image.height, 5);
  for (std::size_t row = 0; row < 5; ++row)
    for (std::size_t column = 0; column < 8; ++column) {
      Rgb mean;
      for (std::size_t s = 0; s < 9; ++s)
        mean = mean + (1 / 9.0f) * fine.exposed[(3 * row + s / 3) * 24 + 3 * column + s % 3];
      expect_color(image.exposed[row * 8 + column], mean, 1e-6f);
    }
}

TEST(Samples, share_the_recorded_steps_of_their_pixel) {
  Dataset data = white_where(2, 2, 4, [](int, int) { return true; });
  data.hits.channels = data.manifest.channels = data.hits.channels | ChannelSet::of("duv");
  for (auto& steps : data.hits.duv) steps.assign(data.hits.count(), 0.5f);
  const Dataset grid = by_samples(data);
  EXPECT_EQ(grid.manifest.width, 8);
  EXPECT_EQ(grid.manifest.lines, 8);
  EXPECT_EQ(grid.hits.duv[2], std::vector<float>(64, 0.125f));
}

TEST(Samples, that_do_not_fit_are_refused) {
  Dataset data = white_where(2, 2, 2, [](int, int) { return true; });
  data.hits.sample[3] = 4;
  EXPECT_NE(complaint([&] { Renderer renderer(data); }).find("names sample 4; expected 0 to 3"),
            std::string::npos);
  data.hits.channels.bits &= ~ChannelSet::of("sample").bits;
  EXPECT_NE(complaint([&] { Renderer renderer(data); }).find("no channel 'sample'"), std::string::npos);
}

TEST(Samples, of_one_a_pixel_need_no_filter) {
  EXPECT_TRUE(is_identity({}, 1));
  EXPECT_FALSE(is_identity({}, 2));
  EXPECT_EQ(picture(layered(40, 30), with_filter({})).exposed,
            picture(layered(40, 30), kLayeredLook).exposed);
  EXPECT_FALSE(is_identity({Type::box, 1.5}, 1));
  EXPECT_FALSE(is_identity({Type::gaussian, 1}, 1));
}

TEST(Samples, pictures_do_not_depend_on_threads) {
  const Dataset data = gathered(layered(120, 80), 2);
  for (const PixelFilter& filter : kFilters) {
    const auto with_threads = [&](std::size_t count) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, count);
      return picture(data, with_filter(filter));
    };
    const Image one = with_threads(1);
    for (const std::size_t count : {2u, 5u}) {
      const Image many = with_threads(count);
      EXPECT_EQ(many.exposed, one.exposed);
      EXPECT_EQ(many.white_cd_m2, one.white_cd_m2);
    }
  }
}

TEST(Samples, what_is_kept_never_shows) {
  const Dataset data = gathered(layered(40, 40), 2);
  Renderer renderer(data);
  for (const PixelFilter& filter : {kFilters[0], kFilters[2], kFilters[2], kFilters[4], kFilters[0]}) {
    const Look look = look_of(with_filter(filter), renderer.manifest());
    EXPECT_EQ(renderer.render(look).exposed, picture(data, with_filter(filter)).exposed);
  }
}

TEST(Samples, auto_white_is_that_of_the_filtered_picture) {
  // One bright sample of four in every pixel: the pixels have a quarter of its luminance.
  const auto data = [] {
    return white_where(4, 4, 2, [](int column, int row) { return column % 2 == 0 && row % 2 == 0; });
  };
  const std::string look = R"({"objects":{"earth":{"spectrum":{"type":"black_body","temperature_K":5000}}}})";
  const double sample = picture(one_pixel({{}}), look).white_cd_m2;
  EXPECT_NEAR(picture(data(), look).white_cd_m2, sample / 4, 1e-6 * sample);
}

TEST(PixelFilters, that_make_no_sense_are_refused) {
  Manifest manifest;
  for (const auto& [text, place] : {std::pair{R"({"pixel_filter":{"type":1}})", "/pixel_filter/type"},
                                    {R"({"pixel_filter":{"type":"lanczos"}})", "/pixel_filter/type"},
                                    {R"({"pixel_filter":{"type":"box","width":0.5}})", "/pixel_filter/width"},
                                    {R"({"pixel_filter":{"type":"box","width":33}})", "/pixel_filter/width"},
                                    {R"({"pixel_filter":{"type":"box","sigma":1}})", "/pixel_filter/sigma"}})
    EXPECT_NE(complaint([&] { look_of(text, manifest); }).find(place), std::string::npos) << text;
  EXPECT_EQ(look_of(R"({"pixel_filter":{"type":"mitchell"}})", manifest).pixel_filter, kFilters[4]);
  EXPECT_EQ(look_of(R"({"pixel_filter":{"type":"gaussian"}})", manifest).pixel_filter, kFilters[2]);
}

}  // namespace
}  // namespace nullcone::postrender
