// Stars: flux and place against closed forms.
#include <tbb/global_control.h>

#include "postrender/black_body.h"
#include "postrender/star_catalogue.h"
#include "postrender/star_images.h"
#include "tests/sky_view.h"

namespace nullcone::postrender {
namespace {

constexpr double kMagnitude = 3, kTemperature_K = 5800;
const double kFlux_lx = 2.54e-6 * std::pow(10, -0.4 * kMagnitude);

/// A catalogue of one star.
std::string one_star(const Vector& d) {
  char text[200];
  std::snprintf(text, sizeof text, "ra,dec,magnitude,temperature\n%.12g,%.12g,%g,%g\n",
                std::atan2(d[1], d[0]) / kDegree, std::atan2(d[2], std::hypot(d[0], d[1])) / kDegree,
                kMagnitude, kTemperature_K);
  return text;
}

std::string look_with(const std::string& stars, const std::string& more = "") {
  return R"({"exposure":{"white_cd_m2":0.001},"objects":{"sky":{"stars":)" + stars + "}}" + more + "}";
}
const char* const kFromFile = R"({"file":"stars.csv"})";

struct Stars : testing::Test {
  test::TestFolder folder;
  Image render(Dataset data, const std::string& text) const {
    return picture(std::move(data), text, folder.path());
  }
  Image render_star(const Vector& star, Dataset data, const std::string& more = "") const {
    folder.write("stars.csv", one_star(star));
    return render(std::move(data), look_with(kFromFile, more));
  }
};

TEST_F(Stars, AtRestKeepTheirFluxAndStandWhereTheCameraPutsThem) {
  const Camera camera = perspective(120, 90, 60);
  for (int i = 0; i < 12; ++i) {
    const double x = 20 + 6.9 * i, y = 15 + 5.3 * i;
    const Vector star = host::look_direction<double>(camera, x, y);
    const Spot spot = spot_of(render_star(star, sky_dataset(camera)), camera);
    // The map is curved within a pixel of half a degree: a triangle's mean is within (0.5 degrees)^2 of it.
    EXPECT_NEAR(spot.flux / kFlux_lx, 1, 2e-3) << i;
    EXPECT_NEAR(spot.x, x, 0.01) << i;
    EXPECT_NEAR(spot.y, y, 0.01) << i;
  }
}

TEST_F(Stars, HaveTheColourOfABlackBody) {
  const Camera camera = perspective(60, 40, 20);
  const Image image = render_star({{1, 0, 0}}, sky_dataset(camera));
  std::array<double, 3> sum{};
  for (const Rgb c : image.exposed) {
    sum[0] += static_cast<double>(c.r);
    sum[1] += static_cast<double>(c.g);
    sum[2] += static_cast<double>(c.b);
  }
  const std::array<double, 3> expected = linear_srgb(black_body_xyz(kTemperature_K));
  EXPECT_NEAR(sum[0] / sum[1], expected[0] / expected[1], 1e-4);
  EXPECT_NEAR(sum[2] / sum[1], expected[2] / expected[1], 1e-4);
}

/// Seen by an observer who moves along +x: aberration and Doppler shift.
Seen moving(const Vector& look, double beta) {
  const double gamma = 1 / std::sqrt(1 - beta * beta), ahead = 1 - beta * look[0];
  return {{(look[0] - beta) / ahead, look[1] / (gamma * ahead), look[2] / (gamma * ahead)},
          1 / (gamma * ahead)};
}

TEST_F(Stars, AreAberratedAndBeamed) {
  constexpr double kBeta = 0.6;
  const double gamma = 1.25;
  const Camera camera = perspective(160, 120, 70);
  const auto map = [](const Vector& look) { return moving(look, kBeta); };
  for (const double angle : {5.0, 20.0, 40.0, 55.0}) {
    const Vector star = {
        {std::cos(angle * kDegree), 0.8 * std::sin(angle * kDegree), 0.6 * std::sin(angle * kDegree)}};
    const double delta = gamma * (1 + kBeta * star[0]);  // observed / emitted frequency
    // tan(theta') = sin(theta) / (gamma (cos(theta) + beta))
    const Vector look = {{gamma * (star[0] + kBeta), star[1], star[2]}};
    const auto place = host::picture_position(camera, look);
    const auto flux = [&](const std::string& effects) {
      const Spot spot =
          spot_of(render_star(star, sky_dataset(camera, 1, map), ",\"effects\":" + effects), camera);
      EXPECT_NEAR(spot.x, place[0], 0.02) << angle;
      EXPECT_NEAR(spot.y, place[1], 0.02) << angle;
      return spot.flux / kFlux_lx;
    };
    const double seen = black_body_xyz(delta * kTemperature_K)[1] / black_body_xyz(kTemperature_K)[1];
    const double area = 1 / (delta * delta);  // of solid angles
    EXPECT_NEAR(flux(R"({"doppler":false,"searchlight":false})") / area, 1, 3e-3);
    EXPECT_NEAR(flux(R"({"doppler":false})") / (area * std::pow(delta, 4)), 1, 3e-3);
    EXPECT_NEAR(flux("{}") / (area * seen), 1, 3e-3);
    EXPECT_NEAR(flux(R"({"searchlight":false})") / (area * seen * std::pow(delta, -5)), 1, 3e-3);
  }
}

/// A point lens straight ahead, for small angles: beta = theta - theta_E^2 / theta.
Seen lensed(const Vector& look, double einstein) {
  const double theta = std::hypot(look[1], look[2]) / look[0];
  const double beta = theta - einstein * einstein / theta, scale = theta > 0 ? beta / theta : 0;
  const Vector d = {{1, scale * look[1] / look[0], scale * look[2] / look[0]}};
  return {components(normalised(d))};
}

struct Fluxes {
  double outer, inner;
};
Fluxes lens_fluxes(const Stars& test, int size, int samples, double u, double angle_deg) {
  constexpr double kEinstein = 0.02;
  const Camera camera = perspective(size, size, 6);
  const Vector star = normalised(Vector{
      {1, u * kEinstein * std::cos(angle_deg * kDegree), u * kEinstein * std::sin(angle_deg * kDegree)}});
  const auto map = [](const Vector& look) { return lensed(look, kEinstein); };
  const Image image = test.render_star(star, sky_dataset(camera, samples, map));
  const double middle = size / 2.0;
  const auto side = [&](double sign) {
    return spot_of(image, camera,
                   [&](double x, double y) {
                     return sign * ((middle - x) * star[1] + (middle - y) * star[2]) > 0;
                   })
               .flux /
           kFlux_lx;
  };
  return {side(1), side(-1)};
}

TEST_F(Stars, AreMagnifiedByALensOnBothSides) {
  for (const double u : {0.3, 0.5, 1.0, 1.4})
    for (const double angle : {0.0, 33.0, 90.0}) {
      const Fluxes found = lens_fluxes(*this, 400, 1, u, angle);
      const double mu = (u * u + 2) / (2 * u * std::sqrt(u * u + 4));
      // The mean over a triangle differs in the second order of a pixel over the distance from the ring's
      // caustic.
      EXPECT_NEAR(found.outer / (mu + 0.5), 1, 0.01) << u << " " << angle;
      EXPECT_NEAR(found.inner / (mu - 0.5), 1, 0.02) << u << " " << angle;
    }
}

TEST_F(Stars, DoNotDependOnTheResolution) {
  const Fluxes fine = lens_fluxes(*this, 600, 1, 0.5, 20);
  for (const auto& [size, samples] : {std::pair{300, 1}, {150, 1}, {100, 3}, {200, 2}}) {
    const Fluxes found = lens_fluxes(*this, size, samples, 0.5, 20);
    EXPECT_NEAR(found.outer / fine.outer, 1, 0.02) << size << " " << samples;
    EXPECT_NEAR(found.inner / fine.inner, 1, 0.05) << size << " " << samples;
  }
}

TEST_F(Stars, AreNeverMagnifiedMoreThanTheLookSays) {
  // Exactly behind the lens a point would be infinitely bright.
  const std::string text = one_star({{1, 0, 0}});
  const Camera camera = perspective(201, 201, 6);
  const Dataset data = sky_dataset(camera, 1, [](const Vector& look) { return lensed(look, 0.02); });
  const StarField field(read_stars(folder.write("stars.csv", text), ""));
  const StarImages images = find_star_images(data, data.manifest, 1, field);
  ASSERT_GT(images.images.size(), 50U);
  for (const double most : {10.0, 40.0, 1e12}) {
    double expected = 0;
    for (const StarImage& image : images.images)
      expected += std::min(most, static_cast<double>(image.magnification));
    const std::string stars = R"({"file":"stars.csv","most_magnified":)" + std::to_string(most) + "}";
    const Spot spot = spot_of(render(data, look_with(stars)), camera);
    EXPECT_NEAR(spot.flux / kFlux_lx / expected, 1, 0.01) << most;
    EXPECT_LE(expected, most * static_cast<double>(images.images.size())) << most;
  }
}

TEST_F(Stars, KeepTheirFluxOverSeamsAndEdgesOfFaces) {
  for (const Camera& camera : {of_all_directions(CameraType::cube_map, 6 * 48, 48),
                               of_all_directions(CameraType::panorama, 192, 96)})
    for (const double azimuth : {180.0, 179.3, 135.0, 44.6, 45.3}) {
      const Vector star = {{std::cos(azimuth * kDegree) * 0.96, std::sin(azimuth * kDegree) * 0.96, 0.28}};
      const Image image = render_star(star, sky_dataset(camera));
      // Solid angles of pixels change over the spot: by about 1/48 a pixel at an edge of a face.
      EXPECT_NEAR(spot_of(image, camera).flux / kFlux_lx, 1, 0.02) << azimuth << " " << camera.width;
    }
}

TEST_F(Stars, AreDimmedByWhatStandsBeforeThem) {
  const Camera camera = perspective(60, 40, 20);
  const auto flux = [&](float opacity, const std::string& look) {
    const auto glass = [&](double, double) {
      return std::vector<TestHit>{{2, 0.5f, 0.5f, 1, -1, 0, opacity}};
    };
    return spot_of(render(sky_dataset(camera, 1, at_rest, glass), look), camera).flux / kFlux_lx;
  };
  folder.write("stars.csv", one_star({{1, 0.02, 0.01}}));
  const auto with = [&](const std::string& glass, const std::string& sky = "") {
    return R"({"exposure":{"white_cd_m2":0.001},"objects":{"sky":{"stars":{"file":"stars.csv"})" + sky +
           R"(},"glass":{"texture":{"type":"color","rgb":[0,0,0]})" + glass + "}}}";
  };
  EXPECT_NEAR(flux(0.25f, with("")), 0.75, 2e-3);
  EXPECT_NEAR(flux(1, with(R"(,"opacity":0.4)")), 0.6, 2e-3);
  EXPECT_EQ(flux(1, with("")), 0);
  EXPECT_NEAR(flux(0, with("", R"(,"opacity":0.5)")), 0.5, 2e-3);
  EXPECT_NEAR(flux(0, with("", R"(,"intensity":3)")), 3, 1e-2);
}

TEST_F(Stars, AreTheSameWithAnyNumberOfThreadsAndInWindows) {
  const Camera camera = of_all_directions(CameraType::panorama, 160, 80);
  const Dataset data = sky_dataset(camera);
  const Look look = look_of(look_with(R"({"random":[{"count":3000,"magnitudes":[0,6]}]})"), data.manifest);
  const auto threads = [&](std::size_t n, const Kernel& kernel) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, n);
    return Renderer(data, kernel).render(look).exposed;
  };
  const std::vector<Rgb> one = threads(1, *kernels().front());
  for (const Kernel* kernel : kernels()) EXPECT_EQ(threads(3, *kernel), one) << kernel->isa;
  // A window has the same light as those lines of the whole picture, but for the map beyond its edges.
  Dataset window = data;
  window.manifest.first_line = 30;
  window.manifest.lines = window.manifest.traced_lines = 20;
  window.hits = data.band(30, 20).hits;
  const Image part = Renderer(window).render(look);
  double difference = 0, sum = 0;
  for (std::size_t i = 0; i < part.exposed.size(); ++i) {
    const auto whole = static_cast<double>(luminance(one[30 * 160 + i])),
               here = static_cast<double>(luminance(part.exposed[i]));
    difference += std::abs(whole - here);
    sum += whole;
  }
  EXPECT_LT(difference, 0.01 * sum);
}

TEST_F(Stars, StayWhenOnlyTheExposureChanges) {
  const Dataset data = sky_dataset(perspective(60, 40, 40));
  const std::string stars = R"({"random":[{"count":5000}]})";
  Renderer renderer(data);
  for (const char* white : {"0.001", "0.1", "\"auto\""}) {
    const std::string text = R"({"exposure":{"white_cd_m2":)" + std::string(white) +
                             R"(},"objects":{"sky":{"stars":)" + stars + "}}}";
    const Look look = look_of(text, data.manifest);
    EXPECT_EQ(renderer.render(look).exposed, Renderer(data).render(look).exposed) << white;
  }
}

TEST_F(Stars, FollowTheRotation) {
  const Camera camera = perspective(60, 40, 20);
  folder.write("stars.csv", one_star({{1, 0, 0}}));
  // What is at +x is seen 3 degrees towards +y, at the left.
  const Image image = render(sky_dataset(camera), look_with(R"({"file":"stars.csv","rotate_deg":[0,0,3]})"));
  const auto place = host::picture_position(camera, {{std::cos(3 * kDegree), std::sin(3 * kDegree), 0.0}});
  EXPECT_NEAR(spot_of(image, camera).x, place[0], 0.02);
}

}  // namespace
}  // namespace nullcone::postrender
