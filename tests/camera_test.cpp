// Cameras as maps between the picture and the sky.
#include "core/base/camera.h"

#include <gtest/gtest.h>

#include <bit>
#include <random>
#include <vector>

namespace nullcone::host {
namespace {

constexpr double kDegrees = std::numbers::pi / 180;

Camera camera_of(CameraType type, int width, int height, double across = 360, double along = 180) {
  Camera out{type, width, height};
  out.fov_horizontal = across * kDegrees, out.fov_vertical = along * kDegrees;
  // Axes in general position.
  const Vec3<double> f = normalised(Vec3<double>{{0.3, -0.7, 0.4}}),
                     l = normalised(cross(Vec3<double>{{0.2, 0.1, 1}}, f));
  out.forward = f.c, out.left = l.c, out.up = cross(f, l).c;
  return out;
}

const Camera kCubeCamera = camera_of(CameraType::cube_map, 360, 60),
             kTetrahedronCamera = camera_of(CameraType::tetrahedron_map, 200, 100);

std::vector<Camera> cameras() {
  return {camera_of(CameraType::perspective, 90, 50, 100, 60),
          camera_of(CameraType::panorama, 120, 70, 200, 80),
          camera_of(CameraType::panorama, 128, 64),
          camera_of(CameraType::fisheye, 90, 70, 180, 180),
          camera_of(CameraType::fisheye, 50, 81, 330, 330),
          kCubeCamera,
          kTetrahedronCamera};
}

double distance(const Vec3<double>& a, const Vec3<double>& b) { return norm(a - b); }

/// Components along forward, left and up.
Vec3<double> in_camera(const Camera& camera, const Vec3<double>& m) {
  return {{dot(Vec3<double>{camera.forward}, m), dot(Vec3<double>{camera.left}, m),
           dot(Vec3<double>{camera.up}, m)}};
}

class Cameras : public testing::Test {
 protected:
  std::mt19937_64 random{1};
  double from_to(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); }
  Vec3<double> direction() {
    std::normal_distribution<double> normal;
    return normalised(Vec3<double>{{normal(random), normal(random), normal(random)}});
  }
};

TEST_F(Cameras, FromThePictureToTheSkyAndBack) {
  for (const Camera& camera : cameras())
    for (int i = 0; i < 20000; ++i) {
      const double x = from_to(0, camera.width), y = from_to(0, camera.height);
      const Vec3<double> m = look_direction(camera, x, y);
      ASSERT_NEAR(norm(m), 1, 1e-15);
      if (!has_ray(camera, x, y)) continue;
      const auto place = picture_position(camera, 3.0 * m);
      ASSERT_NEAR(place[0], x, 1e-12 * camera.width) << kCameraNames[static_cast<std::size_t>(camera.type)];
      ASSERT_NEAR(place[1], y, 1e-12 * camera.height);
    }
}

TEST_F(Cameras, MapsHaveAPlaceForEveryDirection) {
  for (const Camera& camera : {kCubeCamera, kTetrahedronCamera})
    for (int i = 0; i < 20000; ++i) {
      const Vec3<double> m = direction();
      const auto place = picture_position(camera, m);
      ASSERT_TRUE(place[0] >= 0 && place[0] <= camera.width && place[1] >= 0 && place[1] <= camera.height);
      ASSERT_LT(distance(look_direction(camera, place[0], place[1]), m), 1e-14);
    }
}

/// The sky that the pixels cover, by their edges.
double solid_angle(const Camera& camera) {
  double out = 0;
  for (int j = 0; j < camera.height; ++j)
    for (int i = 0; i < camera.width; ++i) {
      const double x = i + 0.5, y = j + 0.5;
      if (!has_ray(camera, x, y)) continue;
      const auto m = [&](double dx, double dy) { return look_direction(camera, x, y, dx, dy); };
      out += norm(cross(m(0.5, 0) - m(-0.5, 0), m(0, 0.5) - m(0, -0.5)));
    }
  return out;
}

TEST_F(Cameras, PixelsCoverTheSkyOnce) {
  // The midpoint rule is good to the square of a pixel: a 60th of a face.
  EXPECT_NEAR(solid_angle(kCubeCamera) / (4 * std::numbers::pi), 1, 5e-4);
  EXPECT_NEAR(solid_angle(kTetrahedronCamera) / (4 * std::numbers::pi), 1, 5e-4);
  EXPECT_NEAR(solid_angle(camera_of(CameraType::panorama, 128, 64)) / (4 * std::numbers::pi), 1, 5e-4);
  for (const double fov : {90.0, 180.0, 300.0}) {
    // Pixels are in or out as a whole: 400 pi/2 on the rim, of random sign.
    const double covered = solid_angle(camera_of(CameraType::fisheye, 400, 410, fov, fov));
    EXPECT_NEAR(covered / (2 * std::numbers::pi * (1 - std::cos(0.5 * fov * kDegrees))), 1, 2e-3) << fov;
  }
}

TEST_F(Cameras, AFisheyeIsEquidistant) {
  const Camera camera = camera_of(CameraType::fisheye, 80, 60, 200, 200);
  const Vec3<double> forward{camera.forward}, left{camera.left}, up{camera.up};
  EXPECT_LT(distance(look_direction(camera, 40.0, 30.0), forward), 1e-15);
  const double edge = 100 * kDegrees;
  const auto at = [&](double angle, const Vec3<double>& aside) {
    return std::cos(angle) * forward + std::sin(angle) * aside;
  };
  EXPECT_LT(distance(look_direction(camera, 10.0, 30.0), at(edge, left)), 1e-15);
  EXPECT_LT(distance(look_direction(camera, 40.0, 0.0), at(edge, up)), 1e-15);
  EXPECT_LT(distance(look_direction(camera, 40.0, 15.0), at(0.5 * edge, up)), 1e-15);
  EXPECT_LT(distance(look_direction(camera, 46.0, 38.0), at(edge / 3, normalised(-0.6 * left - 0.8 * up))),
            1e-15);
  EXPECT_TRUE(has_ray(camera, 10.0, 30.0));
  EXPECT_TRUE(has_ray(camera, 40.0, 60.0));
  EXPECT_FALSE(has_ray(camera, 9.99, 30.0));
  EXPECT_FALSE(has_ray(camera, 18.0, 8.0));
  EXPECT_LT(picture_position(camera, at(edge + 0.01, left))[0], 0);
  EXPECT_LT(picture_position(camera, -forward)[0], 0);
}

TEST_F(Cameras, TheFacesOfACube) {
  const Camera& camera = kCubeCamera;
  const Vec3<double> forward{camera.forward}, left{camera.left}, up{camera.up};
  const std::array<Vec3<double>, 6> centre = {-left, left, up, -up, forward, -forward},
                                    to_right = {-forward, forward, -left, -left, -left, left},
                                    to_top = {up, up, -forward, forward, up, up};
  for (std::size_t i = 0; i < 6; ++i) {
    const double x = 60 * static_cast<double>(i) + 30;
    EXPECT_LT(distance(look_direction(camera, x, 30.0), centre[i]), 1e-15) << i;
    EXPECT_LT(distance(look_direction(camera, x + 15, 24.0),
                       normalised(centre[i] + 0.5 * to_right[i] + 0.2 * to_top[i])),
              2e-15)
        << i;
  }
}

TEST_F(Cameras, TheFacesOfACubeMeet) {
  enum Number { right, left, up, down, front, back };
  /// The direction at a part of the edge of a face: from the left, or from the top.
  const auto at = [](Number face, double s, double t) {
    const double x = 60.0 * static_cast<int>(face) + 30, y = 30;
    return look_direction(kCubeCamera, x, y, 60 * (s - 0.5), 60 * (t - 0.5));
  };
  for (const double s : {0.0, 0.1, 0.7, 1.0}) {
    for (const auto& [one, other] : {std::pair{left, front}, {front, right}, {right, back}, {back, left}})
      EXPECT_LT(distance(at(one, 1, s), at(other, 0, s)), 1e-15) << one << " " << other;
    EXPECT_LT(distance(at(up, s, 1), at(front, s, 0)), 1e-15);
    EXPECT_LT(distance(at(down, s, 0), at(front, s, 1)), 1e-15);
    EXPECT_LT(distance(at(up, s, 0), at(back, 1 - s, 0)), 1e-15);
    EXPECT_LT(distance(at(down, s, 1), at(back, 1 - s, 1)), 1e-15);
    EXPECT_LT(distance(at(up, 0, s), at(left, s, 0)), 1e-15);
    EXPECT_LT(distance(at(up, 1, s), at(right, 1 - s, 0)), 1e-15);
    EXPECT_LT(distance(at(down, 0, s), at(left, 1 - s, 1)), 1e-15);
    EXPECT_LT(distance(at(down, 1, s), at(right, s, 1)), 1e-15);
  }
}

TEST_F(Cameras, TheTetrahedronUnrolls) {
  const Camera& camera = kTetrahedronCamera;
  const auto at = [&](double x, double y) { return look_direction(camera, x, y); };
  const Vec3<double> A = at(0, 100), B = at(0, 0), C = at(100, 100), D = at(100, 0);
  EXPECT_LT(distance(at(200, 0), B), 1e-15);
  EXPECT_LT(distance(at(200, 100), A), 1e-15);
  const std::array<Vec3<double>, 4> corners = {A, B, C, D};
  for (const Vec3<double>& a : corners)
    for (const Vec3<double>& b : corners)
      if (&a != &b) {
        EXPECT_NEAR(dot(a, b), -1.0 / 3, 1e-15);
      }
  EXPECT_LT(distance(D, -Vec3<double>{camera.forward}), 1e-15);
  EXPECT_LT(distance(at(100.0 / 3, 200.0 / 3), Vec3<double>{camera.forward}), 1e-14);
  EXPECT_GT(dot(Vec3<double>{camera.left}, A), 0.8);
  EXPECT_GT(dot(Vec3<double>{camera.up}, B), 0.9);
  constexpr double kLittle = 1e-9;  // of a pixel, of 0.05 at most
  for (const double s : {3.0, 40.0, 77.0, 99.0}) {
    EXPECT_LT(distance(at(s - kLittle, s), at(s + kLittle, s)), kLittle);  // the diagonals
    EXPECT_LT(distance(at(100 + s - kLittle, s), at(100 + s + kLittle, s)), kLittle);
    EXPECT_LT(distance(at(100 - kLittle, s), at(100 + kLittle, s)), kLittle);
    EXPECT_LT(distance(at(kLittle, s), at(200 - kLittle, s)), kLittle);  // the right edge is the left one
  }
}

/// Borchers 2005, (A.11): what his matrices make of an event in the eye's coordinates (x to the right, y up,
/// z backwards), within the clip plane that he gives.
TEST_F(Cameras, TheFirstTriangleIsThatOfBorchers) {
  const Camera& camera = kTetrahedronCamera;
  int inside = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3<double> m = direction(), seen = in_camera(camera, m);
    const double x = -seen[1], y = seen[2], z = -seen[0], w = -z;
    const double X = x / std::sqrt(6.0), Y = std::sqrt(2.0) / 3 * y + z / 3;
    const double right = (X - 0.5 * Y - 0.5 * w) / w, top = Y / w;
    const bool kept =
        w > 0 && right >= -1 && top >= -1 && -std::sqrt(3.0) / 2 * x - 0.5 * y - std::sqrt(2.0) * z >= 0;
    const auto place = picture_position(camera, m);
    const bool found = place[0] < 100 && place[1] > place[0];
    ASSERT_EQ(kept, found) << place[0] << " " << place[1];
    if (!kept) continue;
    ++inside;
    ASSERT_NEAR(place[0], 50 * (1 + right), 1e-11);
    ASSERT_NEAR(place[1], 50 * (1 - top), 1e-11);
  }
  EXPECT_NEAR(inside, 5000, 4 * 61);  // a quarter of the sky; 4 standard deviations
}

TEST_F(Cameras, PlacesBesideAPixelAreBesideItInTheSky) {
  for (const Camera& camera : cameras()) {
    // The most is that of the wide fisheye: 330 degrees on 50 pixels are 0.115 a pixel.
    for (int i = 0; i < camera.width; ++i)
      for (int j = 0; j < camera.height; ++j) {
        const double x = i + 0.5, y = j + 0.5, h = 1.0 / 16;
        const Vec3<double> m = look_direction(camera, x, y);
        const auto beside = [&](double dx, double dy) { return look_direction(camera, x, y, dx, dy) - m; };
        ASSERT_LT(norm(beside(h, 0)), 0.12 * h) << i << " " << j;
        // To the right and to the left are opposite, to first order.
        ASSERT_LT(norm(beside(h, 0) + beside(-h, 0)), 0.02 * h * h) << i << " " << j;
        ASSERT_LT(norm(beside(0, h) + beside(0, -h)), 0.02 * h * h) << i << " " << j;
      }
  }
}

TEST_F(Cameras, SamplesArePartsOfPixels) {
  for (Camera camera : cameras()) {
    camera.samples = 3;
    const Camera rays = sample_camera(camera);
    for (int n = 0; n < 2000; ++n) {
      const double i = std::floor(from_to(0, rays.width)) + 0.5,
                   j = std::floor(from_to(0, rays.height)) + 0.5;
      if (camera.type == CameraType::tetrahedron_map && std::fmod(i, 300) == j) continue;  // either triangle
      ASSERT_LT(distance(look_direction(rays, i, j), look_direction(camera, i / 3, j / 3)), 1e-14);
      const double from_rim =
          std::hypot(0.5 * rays.width - i, 0.5 * rays.height - j) / circle_radius(rays) - 1;
      if (std::fabs(from_rim) > 1e-14) {
        ASSERT_EQ(has_ray(rays, i, j), has_ray(camera, i / 3, j / 3));
      }
    }
  }
}

TEST_F(Cameras, PacksHaveTheBitsOfOneLane) {
  using Lane = Lanes<Pack>;
  for (const Camera& camera : cameras())
    for (int n = 0; n < 5000; ++n) {
      std::array<double, Lane::count> x{}, y{};
      for (double& value : x) value = std::floor(from_to(0, camera.width)) + 0.5;
      for (double& value : y) value = std::floor(from_to(0, camera.height)) + 0.5;
      const Pack X = Lane::load(x.data()), Y = Lane::load(y.data());
      const Vec3<Pack> wide = look_direction(camera, X, Y, Pack(0.0625), Pack(-0.0625));
      std::array<bool, Lane::count> exists{};
      Lane::store(has_ray(camera, X, Y), exists.data());
      for (std::size_t lane = 0; lane < Lane::count; ++lane) {
        const Vec3<double> one = look_direction(camera, x[lane], y[lane], 0.0625, -0.0625);
        for (std::size_t c = 0; c < 3; ++c)
          ASSERT_EQ(std::bit_cast<std::uint64_t>(Lane::get(wide[c], lane)),
                    std::bit_cast<std::uint64_t>(one[c]));
        ASSERT_EQ(exists[lane], has_ray(camera, x[lane], y[lane]));
      }
    }
}

/// A film: places to the right and upwards, one direction everywhere; the same bits in packs.
TEST_F(Cameras, AFilmHasPlacesAndOneDirection) {
  using Lane = Lanes<Pack>;
  Camera camera = camera_of(CameraType::orthographic, 80, 50);
  camera.extent_horizontal = 1.6, camera.extent_vertical = 1;
  const Vec3<double> forward{camera.forward}, left{camera.left}, up{camera.up};
  EXPECT_LT(distance(place_on_film(camera, 40.0, 25.0), Vec3<double>{}), 1e-16);
  EXPECT_LT(distance(place_on_film(camera, 0.0, 25.0), 0.8 * left), 1e-15);
  EXPECT_LT(distance(place_on_film(camera, 80.0, 0.0), -0.8 * left + 0.5 * up), 1e-15);
  EXPECT_LT(distance(place_on_film(camera, 40.0, 25.0, 1.0, 2.0), -0.02 * left - 0.04 * up), 1e-15);
  const Camera samples = sample_camera([&] {
    Camera out = camera;
    out.samples = 4;
    return out;
  }());
  EXPECT_EQ(picture_position(camera, forward)[0], -1);
  for (int n = 0; n < 5000; ++n) {
    std::array<double, Lane::count> x{}, y{};
    for (double& value : x) value = from_to(0, camera.width);
    for (double& value : y) value = from_to(0, camera.height);
    const Pack X = Lane::load(x.data()), Y = Lane::load(y.data());
    const Vec3<Pack> wide = place_on_film(camera, X, Y, Pack(0.0625), Pack(-0.0625));
    for (std::size_t lane = 0; lane < Lane::count; ++lane) {
      const Vec3<double> one = place_on_film(camera, x[lane], y[lane], 0.0625, -0.0625);
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_EQ(std::bit_cast<std::uint64_t>(Lane::get(wide[c], lane)),
                  std::bit_cast<std::uint64_t>(one[c]));
      ASSERT_EQ(distance(look_direction(camera, x[lane], y[lane]), forward), 0);
      ASSERT_TRUE(has_ray(camera, x[lane], y[lane]));
      ASSERT_LT(
          distance(place_on_film(samples, 4 * x[lane], 4 * y[lane]), place_on_film(camera, x[lane], y[lane])),
          1e-15);
    }
  }
}

}  // namespace
}  // namespace nullcone::host
