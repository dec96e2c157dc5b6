// The renderer: compositing, independence of threads, reuse, and records that do not fit.
#include <OpenImageIO/imageio.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "postrender/color.h"
#include "tests/postrender_fixture.h"

namespace nullcone::postrender {
namespace {

TestHit hit_of(std::uint32_t id, float opacity) {
  TestHit hit;
  hit.id = id;
  hit.opacity = opacity;
  return hit;
}

constexpr const char* kThreeColors = R"({"objects":{"red":{"texture":{"type":"color","rgb":[1,0,0]}},
  "green":{"texture":{"type":"color","rgb":[0,1,0]}},"blue":{"texture":{"type":"color","rgb":[0,0,1]}}},
  "background":[1,1,1]})";

TEST(Renderer, composites_front_to_back) {
  const std::vector<ObjectEntry> objects = {{"red"}, {"green"}, {"blue"}};
  // 1/2 red, then 1/4 of the remaining half green, and 3/8 of the white background.
  const Image seen = picture(one_pixel({hit_of(1, 0.5f), hit_of(2, 0.25f)}, objects), kThreeColors);
  expect_color(seen.exposed[0], {0.5f + 0.375f, 0.125f + 0.375f, 0.375f}, 1e-6f);
  // Nothing shines through an opaque surface.
  const Image hidden =
      picture(one_pixel({hit_of(1, 0.5f), hit_of(2, 1), hit_of(3, 1)}, objects), kThreeColors);
  EXPECT_EQ(hidden.exposed[0], (Rgb{0.5f, 0.5f, 0}));
}

TEST(Renderer, adds_physical_and_display_light) {
  const std::vector<ObjectEntry> objects = {{"star"}, {"sign"}};
  const Image image = picture(one_pixel({hit_of(2, 0.5f), hit_of(1, 1)}, objects),
                              R"({"objects":{"star":{"spectrum":{"type":"black_body","temperature_K":6500}},
                                 "sign":{"texture":{"type":"color","rgb":[0,0,0]}}}})");
  // "auto" makes the one lit pixel white: luminance 1.
  EXPECT_NEAR(luminance(image.exposed[0]), 1, 1e-6f);
  EXPECT_GT(image.white_cd_m2, 1e9);
}

/// Two half-transparent objects with every kind of texture and spectrum, varying everywhere.
Dataset busy(int width, int height) {
  return make_dataset(width, height, {{"near"}, {"far", 3.0}}, [](int column, int row) {
    const auto x = static_cast<float>(column), y = static_cast<float>(row);
    TestHit near = hit_of(1, 0.3f + 0.3f * std::sin(0.1f * x)), far = hit_of(2, 1);
    near.u = 0.01f * x - std::floor(0.01f * x);
    near.v = 0.5f + 0.4f * std::sin(0.05f * y);
    near.shift = 0.6f + 0.01f * y;
    near.tau = near.t = -0.1f * x;
    far.u = 0.5f + 0.4f * std::sin(0.03f * (x + y));
    far.v = 0.5f + 0.4f * std::cos(0.07f * x);
    far.shift = 1.2f;
    far.t = -5;
    return std::vector{near, far};
  });
}

constexpr const char* kBusyLook = R"({"objects":{
  "near":{"spectrum":{"type":"black_body","temperature_K":4000},
          "time_slices":[{"channel":"t","from":-5,"to":-2,"spectrum":{"type":"display"}}]},
  "far":{"texture":{"type":"checkerboard","counts":[40,20],"gradient":{"along":"v","from":[1,1,0],"to":[0,0,1]}}}},
  "tone":{"curve":"exponential","k":1.5}})";

TEST(Renderer, pictures_do_not_depend_on_threads) {
  const auto with_threads = [](std::size_t count) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, count);
    return picture(busy(150, 90), kBusyLook);
  };
  const Image one = with_threads(1);
  for (const std::size_t count : {2u, 5u}) {
    const Image many = with_threads(count);
    EXPECT_EQ(many.display, one.display);
    EXPECT_EQ(many.exposed, one.exposed);
    EXPECT_EQ(many.white_cd_m2, one.white_cd_m2);
  }
  EXPECT_NE(one.display.front(), one.display.back());
}

TEST(Renderer, pictures_do_not_depend_on_the_instruction_set) {
  TestFolder folder;
  const std::string name = folder.file("map.png");
  const auto out = OIIO::ImageOutput::create("png");
  ASSERT_TRUE(out->open(name, OIIO::ImageSpec(13, 7, 3, OIIO::TypeDesc::UINT8)));
  std::vector<std::uint8_t> bytes(13 * 7 * 3);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * 37);
  ASSERT_TRUE(out->write_image(OIIO::TypeDesc::UINT8, bytes.data()));
  out->close();
  nlohmann::json look = nlohmann::json::parse(kBusyLook);
  look["objects"]["near"]["texture"] = {{"type", "image"}, {"file", "map.png"}};
  Image first;
  for (const Kernel* kernel : kernels()) {
    Renderer renderer(busy(151, 37), *kernel);
    Image image;
    renderer.render(look_of(look.dump(), renderer.dataset().manifest, folder.path()), {true, true, true},
                    image);
    if (kernel == kernels().front()) first = image;
    EXPECT_EQ(image.exposed, first.exposed) << kernel->isa;
    EXPECT_EQ(image.display, first.display) << kernel->isa;
    EXPECT_EQ(image.encoded, encode_srgb8(image.display)) << kernel->isa;
  }
}

TEST(Renderer, what_it_keeps_never_shows) {
  // A renderer that has shown other looks gives the same picture as a new one.
  Renderer renderer(busy(40, 40));
  const Manifest& manifest = renderer.dataset().manifest;
  const std::vector<std::string> texts = {kBusyLook,
                                          "{}",
                                          R"({"exposure":{"ev":2}})",
                                          R"({"background":[1,1,1]})",
                                          R"({"effects":{"searchlight":false}})",
                                          R"({"effects":{"searchlight":false},"exposure":{"ev":1}})",
                                          R"({"effects":{"searchlight":false},"exposure":{"ev":2}})",
                                          kBusyLook};
  for (const std::string& text : texts)
    EXPECT_EQ(renderer.render(look_of(text, manifest)).display, picture(busy(40, 40), text).display) << text;
}

/// What a look-up between four texels must give, from the definition of wrapping and clamping.
Rgb looked_up(const Pyramid& image, float u, float v) {
  const int width = image.levels[0].width, height = image.levels[0].height;
  const float x = (u - std::floor(u)) * static_cast<float>(width) - 0.5f,
              y = std::clamp((1 - v) * static_cast<float>(height) - 0.5f, 0.0f,
                             static_cast<float>(height - 1));
  const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(y);
  const float s = x - static_cast<float>(left), t = y - static_cast<float>(top);
  const auto row = [&](int j) {
    const int at = std::min(j, height - 1);
    return mix(image.texel(0, (left + width) % width, at), image.texel(0, (left + 1) % width, at), s);
  };
  return mix(row(top), row(top + 1), t);
}

TEST(LookUps, find_the_four_texels_around_them_across_tiles_and_seams) {
  for (const auto& [width, height] : {std::pair{37, 19}, {16, 8}, {1, 1}, {3, 40}}) {
    TextureLevel full{width, height, {}};
    for (int i = 0; i < width * height; ++i) full.texels.push_back({static_cast<float>(i * 37 % 101), 1, 0});
    const Pyramid image = make_pyramid(std::move(full));
    std::vector<float> u, v;
    for (int i = 0; i <= 400; ++i) {
      u.push_back(static_cast<float>(i) / 200 - 0.5f);
      v.push_back(static_cast<float>(i * 173 % 401) / 400);
    }
    for (const Kernel* kernel : kernels()) {
      std::vector<Rgbx> found(u.size());
      kernel->image({image.levels.data(), 0, image.texels.data(), image.unit, {}, false},
                    {u.size(), u.data(), v.data(), nullptr, nullptr, {}}, found.data());
      // Positions round by 2^-24 of the image's side; from one texel to the next it is up to 100.
      for (std::size_t i = 0; i < u.size(); ++i)
        expect_color(found[i], looked_up(image, u[i], v[i]), 100 * 40 * 0x1p-23f);
    }
  }
}

TEST(Footprints, are_the_same_however_a_line_is_cut) {
  constexpr std::size_t kWidth = 600;
  const Dataset data = busy(kWidth, 3);
  std::array<std::vector<float>, 3> u;
  std::vector<float> v(kWidth);
  std::vector<std::uint32_t> id(kWidth, 1);
  std::array<Layer, 3> lines;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t i = 0; i < kWidth; ++i) u[row].push_back(data.hits.u[2 * (row * kWidth + i)]);
    lines[row] = {id.data(), id.data(), u[row].data(), v.data(), v.data(), v.data()};
  }
  const auto cut = [&](const Kernel& kernel, std::size_t length) {
    std::array<std::vector<float>, 4> out;
    out.fill(std::vector<float>(kWidth));
    for (std::size_t first = 0; first < kWidth; first += length)
      kernel.footprints(lines, kWidth, first, std::min(length, kWidth - first),
                        {&out[0][first], &out[1][first], &out[2][first], &out[3][first]});
    return out;
  };
  const auto expected = cut(*kernels().front(), kSegment);
  EXPECT_NEAR(expected[0][kSegment], 0.01f, 1e-6f);
  for (const Kernel* kernel : kernels())
    for (const std::size_t length : {1u, 7u, 100u, 256u}) EXPECT_EQ(cut(*kernel, length), expected) << length;
}

TEST(Renderer, records_that_do_not_fit_are_refused) {
  const auto refused = [](auto&& spoil) {
    Dataset data = busy(4, 4);
    spoil(data);
    return complaint([&] { Renderer renderer(std::move(data)); });
  };
  EXPECT_EQ(refused([](Dataset&) {}), "");
  EXPECT_NE(refused([](Dataset& d) { d.hits.shift.pop_back(); }).find("shift"), std::string::npos);
  EXPECT_NE(refused([](Dataset& d) { d.hits.id[3] = 9; }).find("object 9"), std::string::npos);
  EXPECT_NE(refused([](Dataset& d) { d.hits.id[3] = 0; }).find("object 0"), std::string::npos);
  EXPECT_NE(refused([](Dataset& d) { d.hits.offset.pop_back(); }), "");
  EXPECT_NE(refused([](Dataset& d) { d.hits.offset[2] = 1000; }), "");
  EXPECT_NE(refused([](Dataset& d) { d.manifest.width = 0; }), "");
}

TEST(Renderer, broken_coordinates_do_no_harm) {
  TestHit hit;
  hit.u = NAN;
  hit.v = INFINITY;
  for (const char* texture : {R"({"type":"checkerboard","counts":[3,3],"colors":[[1,1,1],[0,0,0]]})",
                              R"({"type":"color","rgb":[1,1,1]})"}) {
    const Image image =
        picture(one_pixel({hit}), std::string(R"({"objects":{"earth":{"texture":)") + texture + "}}}");
    EXPECT_TRUE(image.display[0].r >= 0 && image.display[0].r <= 1);
  }
}

}  // namespace
}  // namespace nullcone::postrender
