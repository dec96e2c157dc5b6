// The published picture (Grave & Buser 2008, figs. 5 to 8): every statement of its text, on the records.
#include <algorithm>
#include <fstream>
#include <iterator>
#include <numbers>

#include "core/base/json.h"
#include "tests/reference_cases.h"
#include "tests/sanitized.h"
#include "tests/traced.h"

namespace nullcone::test {
namespace {

using namespace nullcone::host;

constexpr double kDegrees = 180 / std::numbers::pi;

json earth_scene() { return json::parse(std::ifstream(NULLCONE_SOURCE "/scenes/goedel_earth.json")); }

/// What is known of one image of the sphere.
struct Image {
  double azimuth_from = 1e9, azimuth_to = -1e9, elevation_from = 1e9, elevation_to = -1e9;
  double g_from = 1e9, g_to = 0, g_sum = 0, t_from = 1e9, t_to = -1e9, Z_from = 1e9, Z_to = 0;
  int count = 0, direct = 0, mirrored = 0;
  unsigned odd_orders = 0;
  double u_sum_cos = 0, u_sum_sin = 0;

  void add(const HitRecord& h, double azimuth, double elevation) {
    const auto widen = [](double x, double& from, double& to) {
      from = std::min(from, x), to = std::max(to, x);
    };
    widen(azimuth, azimuth_from, azimuth_to);
    widen(elevation, elevation_from, elevation_to);
    widen(h.shift, g_from, g_to);
    widen(h.t, t_from, t_to);
    widen(h.Z, Z_from, Z_to);
    g_sum += h.shift;
    u_sum_cos += std::cos(2 * std::numbers::pi * h.u);
    u_sum_sin += std::sin(2 * std::numbers::pi * h.u);
    odd_orders += h.order & 1U;
    ++count;
  }
  double g() const { return g_sum / count; }
  double longitude_deg() const { return std::atan2(u_sum_sin, u_sum_cos) * kDegrees; }
};

struct EarthPicture {
  Image left, centre, right;

  explicit EarthPicture(const Traced& traced) {
    const auto width = static_cast<std::size_t>(traced.scene.camera.width);
    const auto height = static_cast<std::size_t>(traced.scene.camera.height);
    std::vector<const HitRecord*> at(width * height, nullptr);
    traced.for_each_hit([&](const HitRecord& h, std::size_t x, std::size_t y) {
      if (h.id == 1) at[y * width + x] = &h;
    });
    for (std::size_t y = 0; y + 1 < height; ++y)
      for (std::size_t x = 0; x + 1 < width; ++x)
        if (const HitRecord* h = at[y * width + x]) {
          const Vec3<double> look = traced.look(x, y);
          const double azimuth = std::atan2(look[1], look[0]) * kDegrees;
          Image& image = azimuth > 100 ? left : azimuth > 0 ? centre : right;
          image.add(*h, azimuth, std::asin(look[2]) * kDegrees);
          parity(image, *h, at[y * width + x + 1], at[(y + 1) * width + x]);
        }
  }

  /// uv against the picture: u to the right and v upwards make a direct image.
  static void parity(Image& image, const HitRecord& h, const HitRecord* to_right, const HitRecord* below) {
    if (!to_right || !below) return;
    const auto wrapped = [](double d) { return d - std::round(d); };
    const double det =
        wrapped(to_right->u - h.u) * (h.v - below->v) - (to_right->v - h.v) * wrapped(h.u - below->u);
    ++(det > 0 ? image.direct : image.mirrored);
  }
};

const Traced& traced_earth() {
  static const Traced traced = [] {
    json scene = earth_scene();
    if (kSanitized) scene["camera"]["resolution"] = {660, 300};
    return trace_text(scene.dump());
  }();
  return traced;
}

TEST(GoedelEarth, HasTheThreeImagesOfTheTable) {
  const EarthPicture picture(traced_earth());
  struct Row {
    const Image& image;
    double azimuth[2], size[2], g, g_range[2], t[2], Z[2];
    bool mirrored;
  };
  const Row rows[] = {
      {picture.left, {114, 129}, {15.1, 1.9}, 1.006, {0.94, 1.07}, {-3.66, -3.59}, {7.51, 7.66}, false},
      {picture.centre, {62, 86}, {23.80, 22.07}, 0.476, {0.46, 0.50}, {-0.65, -0.57}, {0.61, 0.70}, false},
      {picture.right, {-81, -53}, {28.5, 2.5}, 0.442, {0.42, 0.47}, {-2.10, -2.03}, {5.67, 5.76}, true},
  };
  const double coarse = kSanitized ? 3 : 1;  // wider pixels miss more of an edge
  for (const Row& row : rows) {
    const Image& image = row.image;
    ASSERT_GT(image.count, 100);
    // The table is rounded to its last digit; a pixel is 0.083 degrees, half of it missing at either side.
    EXPECT_NEAR(image.azimuth_from, row.azimuth[0], 0.6 * coarse);
    EXPECT_NEAR(image.azimuth_to, row.azimuth[1], 0.6 * coarse);
    EXPECT_NEAR(image.azimuth_to - image.azimuth_from, row.size[0], kSanitized ? 0.7 : 0.17);
    EXPECT_NEAR(image.elevation_to - image.elevation_from, row.size[1], 0.17);
    EXPECT_NEAR(image.g(), row.g, 0.001 * coarse);
    EXPECT_NEAR(image.g_from, row.g_range[0], 0.006 * coarse);
    EXPECT_NEAR(image.g_to, row.g_range[1], 0.006 * coarse);
    EXPECT_NEAR(image.t_from, row.t[0], 0.006 * coarse);
    EXPECT_NEAR(image.t_to, row.t[1], 0.006 * coarse);
    EXPECT_NEAR(image.Z_from, row.Z[0], 0.006 * coarse);
    EXPECT_NEAR(image.Z_to, row.Z[1], 0.006 * coarse);
    EXPECT_GT(row.mirrored ? image.mirrored : image.direct,
              99 * (row.mirrored ? image.direct : image.mirrored));
    EXPECT_EQ(image.odd_orders, row.mirrored ? static_cast<unsigned>(image.count) : 0U);
  }
}

TEST(GoedelEarth, RightShowsTheSideOfTheCentreAndLeftTheOther) {
  const EarthPicture picture(traced_earth());
  const auto apart = [](const Image& a, const Image& b) {
    return std::fabs(std::remainder(a.longitude_deg() - b.longitude_deg(), 360));
  };
  EXPECT_LT(apart(picture.right, picture.centre), 90);
  EXPECT_GT(apart(picture.left, picture.centre), 90);
}

TEST(GoedelEarth, SquaresStandStillWhereTheyShould) {
  const Traced& traced = traced_earth();
  for (const std::uint32_t id : {2U, 3U}) {
    double azimuth = 0, elevation = 0;
    int count = 0;
    traced.for_each_hit([&](const HitRecord& h, std::size_t x, std::size_t y) {
      if (h.id != id) return;
      const Vec3<double> look = traced.look(x, y);
      azimuth += std::atan2(look[1], look[0]) * kDegrees;
      elevation += std::asin(look[2]) * kDegrees;
      ++count;
      EXPECT_NEAR(h.shift, 1, 1e-12);
      EXPECT_GT(h.mu, 0.99);  // they face the observer
    });
    ASSERT_GT(count, 50);
    EXPECT_NEAR(azimuth / count, id == 2 ? 67 : 81, 0.5);
    EXPECT_NEAR(elevation / count, -10.8, 0.2);
  }
}

TEST(GoedelEarth, EveryRayIsAccountedFor) {
  const Traced& traced = traced_earth();
  EXPECT_EQ(traced.rays_with(Status::hit), traced.hits());
  EXPECT_EQ(traced.rays_with(Status::hit) + traced.rays_with(Status::lookback_reached),
            static_cast<std::size_t>(traced.scene.camera.width * traced.scene.camera.height));
}

/// Connected regions of hits whose lambda changes little from pixel to pixel.
int count_images(const Traced& traced) {
  const int width = traced.scene.camera.width, height = traced.scene.camera.height;
  std::vector<double> Z(static_cast<std::size_t>(width * height), -1);
  traced.for_each_hit([&](const HitRecord& h, std::size_t x, std::size_t y) {
    if (h.id == 1) Z[y * static_cast<std::size_t>(width) + x] = h.Z;
  });
  int images = 0;
  std::vector<int> stack;
  for (int start = 0; start < width * height; ++start) {
    if (Z[static_cast<std::size_t>(start)] < 0) continue;
    ++images;
    stack.assign(1, start);
    double z = 0;
    while (!stack.empty()) {
      const int at = stack.back(), x = at % width, y = at / width;
      stack.pop_back();
      double& here = Z[static_cast<std::size_t>(at)];
      if (here < 0) continue;
      z = here;
      here = -1;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const int nx = (x + dx + width) % width, ny = y + dy;
          if (ny < 0 || ny >= height) continue;
          const double there = Z[static_cast<std::size_t>(ny * width + nx)];
          if (there >= 0 && std::fabs(there - z) < 0.3) stack.push_back(ny * width + nx);
        }
    }
  }
  return images;
}

TEST(GoedelEarth, TenTimesTheLookbackShowsMoreThanTwentyImages) {
  json scene = earth_scene();
  scene["max_lookback"] = 100;
  scene["camera"]["fov_deg"] = {360, 6};
  scene["camera"]["resolution"] = {kSanitized ? 1080 : 4320, 288};
  EXPECT_GT(count_images(trace_text(scene.dump())), 20);
}

}  // namespace
}  // namespace nullcone::test
