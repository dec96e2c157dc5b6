// Stars in traced skies: moving observers and black holes, against closed forms.
#include "postrender/picture_file.h"
#include "tests/sky_view.h"
#include "tests/traced.h"

namespace nullcone::postrender {
namespace {

/// What was traced as a dataset of its sky.
Dataset dataset_of(const test::Traced& traced) {
  const Camera& camera = traced.scene.camera;
  std::vector<std::vector<TestHit>> hits(static_cast<std::size_t>(camera.width * camera.height));
  traced.for_each_hit([&](const HitRecord& hit, std::size_t x, std::size_t y) {
    hits[y * static_cast<std::size_t>(camera.width) + x] = {
        {1, static_cast<float>(hit.u), static_cast<float>(hit.v), static_cast<float>(hit.shift)}};
  });
  Dataset out = make_dataset(camera.width, camera.height, {{"sky"}}, [&](int column, int row) {
    return hits[static_cast<std::size_t>(row * camera.width + column)];
  });
  out.manifest.setting =
      sky_dataset(Camera{camera.type, 1, 1, 1, camera.fov_horizontal, camera.fov_vertical}).manifest.setting;
  return out;
}

std::string star_at(double ra_deg, double dec_deg) {
  char text[100];
  std::snprintf(text, sizeof text, "%.12g,%.12g,0,6000\n", ra_deg, dec_deg);
  return text;
}

Image render(const Dataset& data, const std::string& catalogue, const std::string& effects) {
  const test::TestFolder folder;
  folder.write("stars.csv", catalogue);
  return picture(data,
                 R"({"exposure":{"white_cd_m2":1},"effects":)" + effects +
                     R"(,"objects":{"sky":{"stars":{"file":"stars.csv"}}}})",
                 folder.path());
}

constexpr const char* kAsTheyAre = R"({"doppler":false,"searchlight":false})";

TEST(TracedSky, IsAberrated) {
  const test::Traced traced = test::trace_text(R"({
    "metric": {"name": "minkowski"}, "observer": {"event": [0, 0, 0, 0], "velocity": [0.5, 0, 0]},
    "camera": {"type": "perspective", "fov_deg": 80, "resolution": [160, 120]},
    "objects": [{"name": "sky", "shape": {"type": "sky"}}]})");
  const Dataset data = dataset_of(traced);
  const double gamma = 1 / std::sqrt(0.75);
  for (const double angle : {10.0, 30.0, 50.0}) {
    const double theta = angle * kDegree, seen = std::atan2(std::sin(theta), gamma * (std::cos(theta) + 0.5));
    const double delta = gamma * (1 + 0.5 * std::cos(theta));
    const Spot spot = spot_of(render(data, star_at(angle, 0), R"({"doppler":false})"), traced.scene.camera);
    const auto place = host::picture_position(traced.scene.camera, {{std::cos(seen), std::sin(seen), 0.0}});
    EXPECT_NEAR(spot.x, place[0], 0.03);
    EXPECT_NEAR(spot.y, place[1], 0.03);
    EXPECT_NEAR(spot.flux / 2.54e-6 / (delta * delta), 1, 4e-3);  // delta^4 times delta^-2 of solid angle
  }
}

/// Deflection to the second order, 4 M/b + 15 pi M^2/(4 b^2), of an observer at the distance D from the hole
/// and a source at infinity: for angles so small that b = D theta.
struct WeakLens {
  double D, M = 1;
  double beta(double theta) const {
    const double b = D * std::abs(theta), bend = 4 * M / b + 15 * std::numbers::pi * M * M / (4 * b * b);
    return theta - std::copysign(bend, theta);
  }
  /// The image of a source at beta on the side of `from`.
  double theta(double source, double from) const {
    for (int i = 0; i < 60; ++i) from -= (beta(from) - source) / slope(from);
    return from;
  }
  double slope(double theta) const { return (beta(theta + 1e-7) - beta(theta - 1e-7)) / 2e-7; }
  double magnification(double theta) const { return std::abs(theta / (beta(theta) * slope(theta))); }
};

TEST(TracedSky, IsMagnifiedBySchwarzschild) {
  const test::Traced traced = test::trace_text(R"({
    "metric": {"name": "kerr_schild", "spin": 0}, "observer": {"event": [0, 10000, 0, 0]},
    "camera": {"type": "perspective", "azimuth_deg": 180, "fov_deg": 5, "resolution": [240, 240]},
    "objects": [{"name": "sky", "shape": {"type": "sky"}}]})");
  const Dataset data = dataset_of(traced);
  const WeakLens lens{10000};
  const double einstein = std::sqrt(4 / lens.D);
  for (const double u : {0.5, 1.0}) {
    const double source = u * einstein;
    // To the right of the hole, from an observer who looks along -x, is +y.
    const Image image = render(data, star_at(180 - source / kDegree, 0), kAsTheyAre);
    const double textbook = (u * u + 2) / (2 * u * std::sqrt(u * u + 4));
    for (const int side : {1, -1}) {
      const double theta = lens.theta(source, side * einstein);
      const Spot spot =
          spot_of(image, traced.scene.camera, [&](double x, double) { return side * (x - 120) > 0; });
      const auto place =
          host::picture_position(traced.scene.camera, {{-std::cos(theta), std::sin(theta), 0.0}});
      EXPECT_NEAR(spot.x, place[0], 0.1) << u << " " << side;
      EXPECT_NEAR(spot.y, 120, 0.1) << u << " " << side;
      const double mu = spot.flux / 2.54e-6;
      // A pixel is a fiftieth of the ring's radius; the inner image changes by that much over it.
      EXPECT_NEAR(mu / lens.magnification(theta), 1, 0.02) << u << " " << side;
      // The textbook's, for deflections of the first order: 15 pi/16 M/b more, up to 2 % at the inner image.
      EXPECT_NEAR(mu / (textbook + side * 0.5), 1, 0.06) << u << " " << side;
    }
  }
}

TEST(TracedSky, ShowsAnEinsteinRing) {
  const test::Traced traced = test::trace_text(R"({
    "metric": {"name": "kerr_schild", "spin": 0}, "observer": {"event": [0, 10000, 0, 0]},
    "camera": {"type": "perspective", "azimuth_deg": 180, "fov_deg": 5, "resolution": [160, 160]},
    "objects": [{"name": "sky", "shape": {"type": "sky"}}]})");
  const Image image = render(dataset_of(traced), star_at(180.003, 0.002), kAsTheyAre);
  const WeakLens lens{10000};
  const double expected =
      lens.theta(0, 0.02) / kDegree / (5.0 / 160);  // in pixels, to 0.1 % of the projection
  double sum = 0, mean = 0;
  for (int j = 0; j < 160; ++j)
    for (int i = 0; i < 160; ++i) {
      const double light =
          static_cast<double>(luminance(image.exposed[static_cast<std::size_t>(j * 160 + i)]));
      sum += light;
      mean += light * std::hypot(i - 79.5, j - 79.5);
    }
  EXPECT_NEAR(mean / sum, expected, 0.3);
}

TEST(TracedSky, MadeByACubeCameraServesAnotherScene) {
  // Step 1: a sky of smooth colours, all around in empty space.
  const test::TestFolder folder;
  const auto board = [](int width, int height) {
    Image out;
    set_size(out, width, height, {});
    for (int j = 0; j < height; ++j)
      for (int i = 0; i < width; ++i) {
        const double lon = 2 * std::numbers::pi * (i + 0.5) / width,
                     lat = std::numbers::pi * (0.5 - (j + 0.5) / height);
        const double x = std::cos(lat) * std::cos(lon), y = std::cos(lat) * std::sin(lon), z = std::sin(lat);
        out.exposed[static_cast<std::size_t>(j * width + i)] = {
            static_cast<float>(0.5 + 0.4 * x * y), static_cast<float>(0.5 + 0.4 * z),
            static_cast<float>(0.5 + 0.3 * std::sin(3 * x))};
      }
    return out;
  };
  write_picture(folder.file("map.exr"), board(512, 256), 32);
  const std::string flat = R"({"metric": {"name": "minkowski"}, "observer": {"event": [0, 0, 0, 0]},
    "camera": {"type": "cube_map", "resolution": [576, 96]}, "objects": [{"name": "sky", "shape": {"type": "sky"}}]})";
  const auto look = [](const std::string& texture) {
    return R"({"effects":{"doppler":false,"searchlight":false},"objects":{"sky":{"texture":)" + texture +
           "}}}";
  };
  const std::string map = look(R"({"type":"image","file":"map.exr","filter":"bilinear"})");
  write_picture(folder.file("cube.exr"), picture(dataset_of(test::trace_text(flat)), map, folder.path()), 32);
  // Step 2: behind a black hole.
  const Dataset hole = dataset_of(test::trace_text(R"({
    "metric": {"name": "kerr_schild", "spin": 0}, "observer": {"event": [0, 20, 0, 0]},
    "camera": {"type": "perspective", "azimuth_deg": 180, "fov_deg": 90, "resolution": [80, 60]},
    "objects": [{"name": "sky", "shape": {"type": "sky"}}]})"));
  const Image direct = picture(hole, map, folder.path()),
              by_cube = picture(hole, look(R"({"type":"cube_map","file":"cube.exr","filter":"bilinear"})"),
                                folder.path());
  float worst = 0;
  for (std::size_t i = 0; i < direct.exposed.size(); ++i) {
    const Rgb d = direct.exposed[i] - by_cube.exposed[i];
    worst = std::max({worst, std::abs(d.r), std::abs(d.g), std::abs(d.b)});
  }
  // Interpolation: |f''| h^2 / 8 in two directions, |f''| up to 2.7; 2.9e-4 with h = 2/96 in the middle of a
  // face, and twice 1e-4 with h = 2 pi/512 on the map. Texels are half floats: 2^-12 of 0.9 each, on map and
  // cube.
  EXPECT_LT(worst, 2.9e-4f + 2e-4f + 2 * 2.2e-4f);
}

}  // namespace
}  // namespace nullcone::postrender
