// Coarser copies of datasets.
#include "apps/view/thin.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "core/trace/trace_scene.h"
#include "metrics/registry.h"
#include "postrender/sample_grid.h"
#include "tests/live_scenes.h"

namespace nullcone::view {

namespace {

using postrender::TestHit;

/// Some crossings a pixel, some of them seen through others, shifts and times at random.
Dataset random_dataset(int width, int height) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> part(0, 1);
  return postrender::make_dataset(width, height, {{"earth"}, {"moon"}}, [&](int, int) {
    std::vector<TestHit> out(random() % 4);
    for (TestHit& hit : out) {
      hit.id = 1 + random() % 2;
      hit.opacity = random() % 2 == 0 ? 1.0f : part(random);
      hit.u = part(random), hit.v = part(random), hit.shift = 0.5f + part(random), hit.t = -part(random);
    }
    return out;
  });
}

/// Spheres before one another, half transparent, lit by a lamp along two paths; `samples` a pixel.
Dataset lit_dataset(int samples) {
  const auto metrics = metric_descriptions();
  const Scene scene = read_scene(
      R"({"metric": {"name": "minkowski"}, "observer": {"event": [0, 0, 0, 0]}, "records": {"differentials": true},
          "camera": {"type": "perspective", "fov_deg": 45, "resolution": [37, 22], "samples": )" +
          std::to_string(samples) +
          R"(}, "objects": [
          {"name": "earth", "opacity": 0.4, "shape": {"type": "sphere", "radius": 0.2}, "placing":
            {"type": "local", "worldline": {"type": "static", "event": [0, 0.8, 0.1, 0]}}},
          {"name": "moon", "shape": {"type": "sphere", "radius": 0.3}, "placing":
            {"type": "local", "worldline": {"type": "static", "event": [0, 1.2, -0.1, 0]}}}],
          "lights": {"lamps": [{"name": "sun", "worldline": {"type": "static", "event": [0, 0.4, 0.5, 0.6]}}]}})",
      "test", metrics);
  return trace_scene(find_spacetime(scene.metric), scene, "test");
}

const std::string kGlowing =
    R"({"objects": {"earth": {"spectrum": {"type": "black_body", "temperature_K": 6000}}},
        "exposure": {"white_cd_m2": 1e9}})";
const std::string kLit =
    R"({"objects": {"earth": {"surface": {"type": "lambertian"}}, "moon": {"surface": {"type": "lambertian"}}},
        "lights": {"sun": {"intensity": 0.3}}})";

postrender::Image picture(const Dataset& dataset, const std::string& look) {
  postrender::Renderer renderer(dataset);
  postrender::Image image;
  renderer.render(postrender::parse_look(json::parse(look), {"test", "", ""}, dataset.manifest),
                  {.exposed = false, .display = false, .encoded = true}, image);
  return image;
}

/// The picture of a thinned dataset is made of pixels of that of its samples; returns how many colours it
/// has.
void expect_pixels_of(const Dataset& dataset, int step, const std::string& look) {
  const int samples = dataset.manifest.samples, middle = (samples - 1) / 2;
  const auto coarse = picture(thin(dataset, step), look),
             fine = picture(postrender::by_samples(dataset), look);
  ASSERT_EQ(coarse.width, std::max((dataset.manifest.width + (step - 1) / 2) / step, 1));
  std::size_t coloured = 0;
  for (int row = 0; row < coarse.height; ++row)
    for (int column = 0; column < coarse.width; ++column) {
      const int x = (step / 2 + column * step) * samples + middle,
                y = (step / 2 + row * step) * samples + middle;
      for (int c = 0; c < 3; ++c) {
        const auto found = coarse.encoded.at(static_cast<std::size_t>(3 * (row * coarse.width + column) + c)),
                   expected = fine.encoded.at(static_cast<std::size_t>(3 * (y * fine.width + x) + c));
        ASSERT_EQ(found, expected) << column << ", " << row << ", step " << step;
        coloured += found > 0 && found < 255;
      }
    }
  EXPECT_GT(coloured, 20u);
}

}  // namespace

TEST(Thin, CountsWhatRemains) {
  for (const int step : {1, 2, 3, 4, 5, 7})
    for (int count = 1; count < 40; ++count) {
      int remaining = 0;
      for (int i = step / 2; i < count; i += step) ++remaining;
      EXPECT_EQ(thinned(count, step), std::max(remaining, 1)) << count << ", " << step;
    }
}

TEST(Thin, ShowsPixelsOfTheWholePicture) {
  const Dataset seen_through = random_dataset(37, 22);
  for (const int step : {1, 2, 3, 4}) expect_pixels_of(seen_through, step, kGlowing);
}

TEST(Thin, KeepsLightAndOneSample) {
  for (const int samples : {1, 2, 3}) {
    const Dataset lit = lit_dataset(samples);
    for (const int step : {1, 2, 4}) {
      expect_pixels_of(lit, step, kLit);
      expect_pixels_of(lit, step, kGlowing);
    }
  }
}

TEST(Thin, KeepsAllColumnsOfAPixel) {
  const Dataset lit = lit_dataset(3), coarse = thin(lit, 3);
  EXPECT_EQ(coarse.manifest.samples, 1);
  EXPECT_TRUE(std::ranges::all_of(coarse.hits.sample, [](std::uint32_t sample) { return sample == 0; }));
  std::size_t there = 0;
  for (std::size_t pixel = 0; pixel < coarse.pixels(); ++pixel) {
    const std::size_t x = 1 + 3 * (pixel % 12), y = 1 + 3 * (pixel / 12);
    EXPECT_EQ(coarse.rays.status[pixel], lit.rays.status[(3 * y + 1) * 111 + 3 * x + 1]);
    EXPECT_EQ(coarse.rays.steps[pixel], lit.rays.steps[(3 * y + 1) * 111 + 3 * x + 1]);
    std::size_t next = coarse.hits.offset[pixel];
    for (std::size_t hit = lit.hits.offset[y * 37 + x]; hit < lit.hits.offset[y * 37 + x + 1]; ++hit) {
      if (lit.hits.sample[hit] != 4) continue;
      for_each_channel(
          [&](const ChannelInfo& channel, const auto& column, const auto& from) {
            if (channel.name == "sample") return;
            const bool footprint = channel.group() == "duv";  // three times as wide
            const auto expected = footprint ? from[hit] + from[hit] + from[hit] : from[hit];
            EXPECT_EQ(column.at(next), expected) << channel.name;
          },
          coarse.hits, lit.hits);
      ++next, ++there;
    }
    EXPECT_EQ(next, coarse.hits.offset[pixel + 1]);
  }
  EXPECT_EQ(there, coarse.hits.count());
  EXPECT_GT(there, 20u);
}

TEST(Thin, FootprintsAreThoseOfACoarseCamera) {
  // A quad face to face fills the picture: u changes by the same from pixel to pixel, as large as they are.
  const auto metrics = metric_descriptions();
  for (const int samples : {1, 2}) {
    const Scene scene = read_scene(
        R"({"metric": {"name": "minkowski"}, "observer": {"event": [0, 0, 0, 0]}, "records": {"differentials": true},
          "camera": {"type": "perspective", "fov_deg": 90, "resolution": [32, 16], "samples": )" +
            std::to_string(samples) +
            R"(}, "objects": [{"name": "wall", "shape": {"type": "quad", "edges": [10, 10]}, "placing":
            {"type": "coordinate", "centre": [2, 0, 0], "z_axis": [-1, 0, 0], "y_axis": [0, 0, 1]}}]})",
        "test", metrics);
    const Dataset coarse = thin(trace_scene(find_spacetime(scene.metric), scene, "test"), 4);
    ASSERT_EQ(coarse.hits.count(), 32u);
    for (std::size_t i = 0; i < 32; ++i)  // eight pixels see 2 tan(45 deg) * 2 of 10
      EXPECT_NEAR(std::abs(coarse.hits.duv[0][i]), 4.0 / 10 / 8, 1e-5);
  }
}

TEST(Thin, KeepsTheWindow) {
  Dataset window = random_dataset(30, 20);
  window.manifest.height = 100;
  window.manifest.first_line = 48;
  window.manifest.traced_lines = 13;
  const Manifest coarse = thin(window, 2).manifest;
  EXPECT_EQ(coarse.width, 15);
  EXPECT_EQ(coarse.height, 50);
  EXPECT_EQ(coarse.first_line, 24);
  EXPECT_EQ(coarse.lines, 10);
  EXPECT_EQ(coarse.traced_lines, 6);  // 1, 3, ... 11 of 13
  const Manifest last = thin(window, 64).manifest;
  EXPECT_EQ(last.lines, 1);
  EXPECT_LE(last.first_line + last.lines, last.height);
}

TEST(Thin, TakesWhatIsThere) {
  Dataset no_rays = random_dataset(8, 8);
  no_rays.rays = {};
  EXPECT_TRUE(thin(no_rays, 2).rays.status.empty());
  EXPECT_EQ(thin(random_dataset(1, 1), 4).pixels(), 1u);
  EXPECT_EQ(thin(random_dataset(8, 8), 1).hits.count(), random_dataset(8, 8).hits.count());
  EXPECT_THROW(thin(random_dataset(8, 8), 0), InputError);
  EXPECT_THROW(thin(random_dataset(8, 8), 1 << 30), InputError);
  Dataset untold = random_dataset(8, 8);
  untold.manifest.samples = 2;
  EXPECT_THROW(thin(untold, 2), InputError);
}

}  // namespace nullcone::view
