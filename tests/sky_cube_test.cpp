// Cube maps as textures: directions, edges between faces, averages, files.
#include <OpenImageIO/imageio.h>

#include "postrender/cube_map.h"
#include "tests/sky_view.h"

namespace nullcone::postrender {
namespace {

using Function = std::function<Rgb(const Vector&)>;

/// A strip of faces as the project's own camera makes it.
std::vector<Rgb> strip_of(int n, const Function& f) {
  const Camera camera = of_all_directions(CameraType::cube_map, 6 * n, n);
  std::vector<Rgb> out;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < 6 * n; ++i) out.push_back(f(host::look_direction<double>(camera, i + 0.5, j + 0.5)));
  return out;
}

void write_exr(const std::string& path, int width, int height, const std::vector<Rgb>& texels) {
  const auto out = OIIO::ImageOutput::create("openexr");
  ASSERT_TRUE(out && out->open(path, OIIO::ImageSpec(width, height, 3, OIIO::TypeDesc::FLOAT)));
  ASSERT_TRUE(out->write_image(OIIO::TypeDesc::FLOAT, texels.data()));
  out->close();
}

/// Smooth, and different in all directions.
Rgb smooth(const Vector& d) {
  return {static_cast<float>(0.5 + 0.3 * std::sin(2 * d[0] + d[1]) + 0.1 * d[2]),
          static_cast<float>(0.5 + 0.4 * d[1] * d[2]),
          static_cast<float>(0.5 + 0.3 * std::cos(3 * d[2] - d[0]))};
}

double difference(Rgb a, Rgb b) {
  return static_cast<double>(std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)}));
}

/// The colours that are seen in some directions, one a pixel.
std::vector<Rgb> seen_in(const std::vector<Vector>& directions, const std::string& texture,
                         const std::string& folder, const Kernel& kernel = *kernels().front()) {
  Dataset data = make_dataset(static_cast<int>(directions.size()), 1, {{"sky"}}, [&](int column, int) {
    TestHit hit;
    const auto [u, v] = uv_of(components(directions[static_cast<std::size_t>(column)]));
    hit.u = u, hit.v = v;
    return std::vector{hit};
  });
  const Look look = look_of(R"({"objects":{"sky":{"texture":)" + texture + "}}}", data.manifest, folder);
  return Renderer(std::move(data), kernel).render(look).exposed;
}

std::vector<Vector> spread_directions(int count) {
  std::vector<Vector> out;
  for (int i = 0; i < count; ++i) {
    const double z = (2 * i + 1.0) / count - 1, r = std::sqrt(1 - z * z),
                 a = 2.399963 * i;  // the golden angle
    out.push_back({{r * std::cos(a), r * std::sin(a), z}});
  }
  for (const double x : {-1.0, 1.0})  // corners, edges, middles of faces
    for (const double y : {-1.0, 0.0, 1.0})
      for (const double z : {-1.0, 0.0, 1.0}) out.push_back(normalised(Vector{{x, y, z}}));
  return out;
}

constexpr const char* kStrip = R"({"type":"cube_map","file":"strip.exr","filter":"bilinear"})";

TEST(CubeMap, IsLookedUpByDirection) {
  const test::TestFolder folder;
  const std::vector<Vector> directions = spread_directions(4000);
  std::array<double, 2> worst{};
  for (const std::size_t k : {0U, 1U}) {
    const int n = k == 0 ? 16 : 32;
    write_exr(folder.file("strip.exr"), 6 * n, n, strip_of(n, smooth));
    const std::vector<Rgb> seen = seen_in(directions, kStrip, folder.path());
    for (std::size_t i = 0; i < directions.size(); ++i)
      worst[k] = std::max(worst[k], difference(seen[i], smooth(directions[i])));
    for (const Kernel* kernel : kernels())
      EXPECT_EQ(seen_in(directions, kStrip, folder.path(), *kernel), seen);
  }
  // Second order: |f''| h^2 / 8 in each of two directions, with |f''| up to 3 and h = 2/16 in the middle of a
  // face; also at edges and corners.
  EXPECT_LT(worst[0], 2 * 3 * 0.125 * 0.125 / 8);
  EXPECT_LT(worst[1], 0.3 * worst[0]);
}

TEST(CubeMap, HasNoSeams) {
  // Whatever the texels are: noise.
  const test::TestFolder folder;
  unsigned state = 1;
  const auto noise = [&](const Vector&) {
    state = state * 1664525 + 1013904223;
    return Rgb{static_cast<float>(state >> 8) * 0x1p-24f, 0.5f, 0};
  };
  for (const int n : {1, 2, 5, 8}) {
    write_exr(folder.file("strip.exr"), 6 * n, n, strip_of(n, noise));
    std::vector<Vector> directions;
    constexpr double kBeside = 1e-4;
    for (int i = -50; i <= 50; ++i)
      for (int axis = 0; axis < 3; ++axis)
        for (const double a : {-1.0, 1.0})
          for (const double b : {-1.0, 1.0})
            for (const double aside : {-kBeside, kBeside}) {
              Vector d{};
              const auto at = [&](int k) -> double& { return d.c[static_cast<std::size_t>((axis + k) % 3)]; };
              at(0) = i / 50.0, at(1) = a * (1 + aside), at(2) = b;
              directions.push_back(normalised(d));
            }
    const std::vector<Rgb> seen = seen_in(directions, kStrip, folder.path());
    // The greatest slope is 1 a texel, of which there are n/2 a unit; twice that where two directions meet.
    for (std::size_t i = 0; i < seen.size(); i += 2)
      ASSERT_LT(difference(seen[i], seen[i + 1]), 4 * n * kBeside + 2e-3) << n << " " << i;
  }
}

TEST(CubeMap, AgreesWithTheLatitudeLongitudePictureThatItWasMadeOf) {
  const test::TestFolder folder;
  // Step 1: a picture of all directions.
  constexpr int kWide = 512, kHigh = 256;
  std::vector<Rgb> map;
  for (int j = 0; j < kHigh; ++j)
    for (int i = 0; i < kWide; ++i) {
      const double lon = 2 * std::numbers::pi * ((i + 0.5) / kWide - 0.5),
                   lat = std::numbers::pi * (0.5 - (j + 0.5) / kHigh);
      map.push_back(smooth({{std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat)}}));
    }
  write_exr(folder.file("map.exr"), kWide, kHigh, map);
  // Step 2: seen by a cube camera; its picture is the sky of another scene.
  const std::string direct =
      R"({"objects":{"sky":{"texture":{"type":"image","file":"map.exr","filter":"bilinear"}}}})";
  const Image cube =
      picture(sky_dataset(of_all_directions(CameraType::cube_map, 6 * 96, 96)), direct, folder.path());
  write_exr(folder.file("strip.exr"), 6 * 96, 96, cube.exposed);
  // Step 3: both ways in the views of other cameras, turned too.
  for (const char* filter : {"bilinear", "mipmap"})
    for (const char* turn : {"", R"(,"rotate_deg":[20,-35,50])"}) {
      const auto look = [&](const std::string& texture) {
        return R"({"objects":{"sky":{"texture":{)" + texture + R"(,"filter":")" + filter + "\"" + turn +
               "}}}}";
      };
      // At the poles averages over the longer side of a footprint blur maps by latitude and longitude: not
      // there.
      const bool averages = std::string(filter) == "mipmap";
      if (averages && *turn != 0) continue;
      for (const Camera& camera :
           {perspective(90, 60, 100), of_all_directions(CameraType::panorama, 120, 60)}) {
        if (averages && camera.type != CameraType::perspective) continue;
        const Image a =
            picture(sky_dataset(camera), look(R"("type":"image","file":"map.exr")"), folder.path());
        const Image b =
            picture(sky_dataset(camera), look(R"("type":"cube_map","file":"strip.exr")"), folder.path());
        double worst = 0;
        for (std::size_t i = 0; i < a.exposed.size(); ++i)
          worst = std::max(worst, difference(a.exposed[i], b.exposed[i]));
        // Averages over footprints of 3 degrees, which are not the same on both maps, differ in the second
        // order.
        EXPECT_LT(worst, averages ? 6e-3 : 1e-3) << filter << turn << camera.width;
      }
    }
}

TEST(CubeMap, ShowsItsMeanFromAfar) {
  const test::TestFolder folder;
  write_exr(folder.file("strip.exr"), 6 * 16, 16, strip_of(16, [](const Vector& d) {
              const auto odd =
                  static_cast<int>(std::floor(8 * d[0]) + std::floor(8 * d[1]) + std::floor(8 * d[2]));
              return (odd & 1) ? Rgb{1, 1, 1} : Rgb{};
            }));
  const Image image =
      picture(sky_dataset(of_all_directions(CameraType::panorama, 4, 2)),
              R"({"objects":{"sky":{"texture":{"type":"cube_map","file":"strip.exr"}}}})", folder.path());
  for (const Rgb c : image.exposed) EXPECT_NEAR(c.g, 0.5, 0.15);
}

TEST(CubeMap, IsReadFromSixFilesToo) {
  const test::TestFolder folder;
  constexpr int n = 8;
  const std::vector<Rgb> strip = strip_of(n, smooth);
  write_exr(folder.file("strip.exr"), 6 * n, n, strip);
  std::string faces;
  for (int face = 0; face < 6; ++face) {
    std::vector<Rgb> one;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) one.push_back(strip[static_cast<std::size_t>(j * 6 * n + face * n + i)]);
    const std::string name = kCubeFaceNames[static_cast<std::size_t>(face)];
    write_exr(folder.file(name + ".exr"), n, n, one);
    faces += (face > 0 ? ",\"" : "\"") + name + "\":\"" + name + ".exr\"";
  }
  const std::string six = R"({"type":"cube_map","filter":"bilinear","faces":{)" + faces + "}}";
  const std::vector<Vector> directions = spread_directions(300);
  EXPECT_EQ(seen_in(directions, six, folder.path()), seen_in(directions, kStrip, folder.path()));
  // Faces of other sizes, and strips of other shapes.
  write_exr(folder.file("down.exr"), n, n + 1, std::vector<Rgb>(n * (n + 1)));
  EXPECT_EQ(
      complaint([&] { seen_in(directions, six, folder.path()); }),
      folder.file("down.exr") +
          ": /objects/sky/texture/faces/down: is 8 x 9; expected a square, as large as all other faces");
  write_exr(folder.file("strip.exr"), 5 * n, n, std::vector<Rgb>(5 * n * n));
  EXPECT_EQ(complaint([&] { seen_in(directions, kStrip, folder.path()); }),
            folder.file("strip.exr") +
                ": /objects/sky/texture/file: is 40 x 8; expected six square faces side by side, 6 n x n");
  EXPECT_EQ(complaint([&] { seen_in(directions, R"({"type":"cube_map"})", folder.path()); }),
            "look.json: /objects/sky/texture: expected either file or faces");
  EXPECT_NE(complaint([&] {
              seen_in(directions, R"({"type":"cube_map","file":"a.png","scale":[1,1]})", folder.path());
            }),
            "");
}

}  // namespace
}  // namespace nullcone::postrender
