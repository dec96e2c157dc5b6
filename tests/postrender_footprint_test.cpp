// Footprints from recorded steps (duv): objects below a pixel, thin lines, and steps that are unknown.
#include <OpenImageIO/imageio.h>

#include <cmath>

#include "tests/postrender_fixture.h"

namespace nullcone::postrender {
namespace {

/// Adds the channel duv, with the steps that `at` gives for each crossing.
Dataset with_steps(Dataset data, const std::function<std::array<float, 4>(std::size_t)>& at) {
  data.hits.channels = data.manifest.channels = data.hits.channels | ChannelSet::of("duv");
  for (std::size_t hit = 0; hit < data.hits.count(); ++hit) {
    const std::array<float, 4> steps = at(hit);
    for (std::size_t i = 0; i < 4; ++i) data.hits.duv[i].push_back(steps[i]);
  }
  return data;
}

/// A grey picture of `width` by 4 texels, black but for a white line one texel wide in the middle.
void write_thin_line(const std::string& path, int width) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(4 * width));
  for (std::size_t row = 0; row < 4; ++row)
    bytes[row * static_cast<std::size_t>(width) + static_cast<std::size_t>(width / 2)] = 255;
  const auto out = OIIO::ImageOutput::create("png");
  ASSERT_TRUE(out->open(path, OIIO::ImageSpec(width, 4, 1, OIIO::TypeDesc::UINT8)));
  ASSERT_TRUE(out->write_image(OIIO::TypeDesc::UINT8, bytes.data()));
  out->close();
}

constexpr const char* kEarthBoard = R"({"objects":{"earth":{"texture":{"type":"checkerboard","counts":[16,8],
    "colors":[[1,1,1],[0,0,0]]}}}})";
constexpr const char* kLine = R"({"objects":{"earth":{"texture":{"type":"image","file":"line.png"}}}})";

/// One pixel of the picture sees the object, all of it.
Dataset speck(std::array<float, 4> steps) {
  return with_steps(make_dataset(5, 5, {{"earth"}},
                                 [](int column, int row) {
                                   TestHit hit;
                                   hit.u = hit.v = 0.53f;
                                   return std::vector<TestHit>(column == 2 && row == 2 ? 1 : 0, hit);
                                 }),
                    [&](std::size_t) { return steps; });
}

TEST(RecordedSteps, turn_an_object_of_one_pixel_into_its_mean) {
  TestFolder folder;
  write_thin_line(folder.file("line.png"), 64);
  const std::size_t middle = 12;
  EXPECT_NEAR(picture(speck({1, 0, 0, 1}), kEarthBoard).display[middle].r, 0.5f, 1e-6f);
  EXPECT_NEAR(picture(speck({1, 0, 0, 1}), kLine, folder.path()).display[middle].r, 1.0f / 64, 1e-3f / 64);
  // Without them no neighbour counts, and the texture is sharp.
  Dataset blind = speck({1, 0, 0, 1});
  blind.hits.channels = blind.manifest.channels = kDefaultChannels;
  for (auto& steps : blind.hits.duv) steps.clear();
  EXPECT_NEAR(picture(std::move(blind), kEarthBoard).display[middle].r, 1, 1e-6f);
}

TEST(RecordedSteps, that_are_unknown_blur_fully) {
  TestFolder folder;
  write_thin_line(folder.file("line.png"), 64);
  for (const float unknown : {INFINITY, -INFINITY, std::nanf(""), 1e30f}) {
    const Dataset data = speck({unknown, unknown, unknown, unknown});
    EXPECT_NEAR(picture(data, kEarthBoard).display[12].r, 0.5f, 1e-5f) << unknown;
    EXPECT_NEAR(picture(data, kLine, folder.path()).display[12].r, 1.0f / 64, 1e-3f / 64) << unknown;
    // A texture that does not vary along u must not turn infinity into what is not a number.
    nlohmann::json flat = nlohmann::json::parse(kLine);
    flat["objects"]["earth"]["texture"]["scale"] = {1, 0};
    EXPECT_NEAR(picture(data, flat.dump(), folder.path()).display[12].r, 1.0f / 64, 1e-3f / 64) << unknown;
  }
}

TEST(RecordedSteps, agree_with_neighbours_where_those_know) {
  // A sphere seen from far away, with the exact derivatives of its longitude and latitude.
  constexpr int kSide = 96;
  constexpr double kPi = 3.14159265358979, kScale = 2.2 / kSide;
  std::vector<std::array<float, 4>> steps;
  const Dataset data = make_dataset(kSide, kSide, {{"earth"}}, [&](int column, int row) {
    const double x = (column + 0.5 - kSide / 2) * kScale, y = (kSide / 2 - row - 0.5) * kScale;
    const double zz = 1 - x * x - y * y;
    if (zz < 0.1) return std::vector<TestHit>{};  // the limb, where one pixel's difference is no derivative
    const double z = std::sqrt(zz), ring = x * x + zz;
    TestHit hit;
    hit.u = static_cast<float>(0.5 + std::atan2(x, z) / (2 * kPi));
    hit.v = static_cast<float>(0.5 + std::asin(y) / kPi);
    // d atan2(x, z) = (z dx - x dz) / ring with dz = -(x dx + y dy) / z.
    steps.push_back({static_cast<float>(kScale * (z + x * x / z) / ring / (2 * kPi)), 0,
                     static_cast<float>(-kScale * (x * y / z) / ring / (2 * kPi)),
                     static_cast<float>(-kScale / std::sqrt(1 - y * y) / kPi)});
    return std::vector{hit};
  });
  const std::string look = R"({"objects":{"earth":{"texture":{"type":"checkerboard","counts":[90,45],
    "colors":[[1,1,1],[0,0,0]]}}}})";
  const Image known = picture(with_steps(data, [&](std::size_t hit) { return steps[hit]; }), look),
              guessed = picture(data, look);
  double difference = 0, contrast = 0;
  for (std::size_t i = 0; i < known.display.size(); ++i) {
    difference += static_cast<double>(std::abs(known.display[i].r - guessed.display[i].r));
    contrast += static_cast<double>(std::abs(known.display[i].r - 0.5f));
  }
  const auto hits = static_cast<double>(data.hits.count());
  EXPECT_GT(contrast / hits, 0.1);     // there are squares to be seen
  EXPECT_LT(difference / hits, 0.02);  // differences are derivatives up to the second order
}

TEST(RecordedSteps, keep_a_thin_line_as_bright_as_it_moves) {
  TestFolder folder;
  write_thin_line(folder.file("line.png"), 512);
  // A strip of one pixel's height: there are no neighbours above and below. 8 texels a pixel.
  const auto brightness = [&](float shift) {
    const Dataset data = with_steps(make_dataset(64, 1, {{"earth"}},
                                                 [&](int column, int) {
                                                   TestHit hit;
                                                   hit.u = (static_cast<float>(column) + 0.5f + shift) / 64;
                                                   return std::vector{hit};
                                                 }),
                                    [](std::size_t) {
                                      return std::array<float, 4>{1 / 64.0f, 0, 0, 0};
                                    });
    double sum = 0;
    for (const Rgb c : picture(data, kLine, folder.path()).display) sum += static_cast<double>(c.r);
    return sum;
  };
  // One texel of eight, spread over the pixels that see it. Triangles a pixel apart add up to 1 exactly.
  for (int i = 0; i < 16; ++i)
    EXPECT_NEAR(brightness(static_cast<float>(i) / 16), 1.0 / 8, 0.01 / 8) << i << "/16 of a pixel";
}

TEST(RecordedSteps, blur_along_the_axis_that_they_belong_to) {
  // Stripes across u or across v; (u, v) stands in the middle of a bright one. A step of two stripes blurs.
  const auto seen = [](std::size_t step, const char* counts, bool gap) {
    const Dataset data = make_dataset(3, 3, {{"earth"}}, [&](int column, int row) {
      TestHit hit;
      hit.u = hit.v = 8.5f / 16;
      return std::vector<TestHit>(gap && column == 0 && row == 1 ? 0 : 1, hit);
    });
    const std::string look = R"({"objects":{"earth":{"texture":{"type":"checkerboard","counts":)" +
                             std::string(counts) + R"(,"colors":[[1,1,1],[0,0,0]]}}}})";
    std::array<float, 4> steps{};
    steps[step] = 2 / 16.0f;
    return picture(with_steps(data, [&](std::size_t) { return steps; }), look).display[4].r;
  };
  for (const bool gap : {false, true})  // lines as they lie, and copied ones
    for (std::size_t step = 0; step < 4; ++step) {
      const bool along_u = step % 2 == 0;
      EXPECT_NEAR(seen(step, "[16,1]", gap), along_u ? 0.5f : 1.0f, 1e-5f) << step << gap;
      EXPECT_NEAR(seen(step, "[1,16]", gap), along_u ? 1.0f : 0.5f, 1e-5f) << step << gap;
    }
}

TEST(RecordedSteps, are_the_same_with_every_instruction_set) {
  const std::vector<float> recorded = {0.1f, -0.1f, 1e7f, INFINITY, std::nanf(""), 0, -INFINITY, 1, 2, 3, 4};
  Layer line = {};
  for (auto& steps : line.duv) steps = recorded.data();
  for (const Kernel* kernel : kernels()) {
    std::array<std::vector<float>, 4> out;
    out.fill(std::vector<float>(10));
    kernel->recorded_footprints(line, 1, 10, {out[0].data(), out[1].data(), out[2].data(), out[3].data()});
    for (const auto& found : out)
      EXPECT_EQ(found, (std::vector<float>{-0.1f, 1e6f, 1e6f, 1e6f, 0, 1e6f, 1, 2, 3, 4})) << kernel->isa;
  }
}

}  // namespace
}  // namespace nullcone::postrender
