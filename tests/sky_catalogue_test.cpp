// Stars: each image once, where they come from, and how looks tell of them.
#include "postrender/sample_grid.h"
#include "postrender/star_catalogue.h"
#include "postrender/star_images.h"
#include "tests/sky_view.h"

namespace nullcone::postrender {
namespace {

StarField random_field(std::size_t count, std::uint64_t seed = 1) {
  std::vector<Star> stars;
  RandomStars rule;
  rule.count = count;
  rule.seed = seed;
  add_random_stars(rule, stars);
  return StarField(stars);
}

/// How often each star is seen by a camera, its images within the picture.
std::vector<int> counts(const StarField& field, const Camera& camera, int samples = 1) {
  const Dataset data = sky_dataset(camera, samples);
  std::vector<int> out(field.stars().size());
  const StarImages images = find_star_images(by_samples(data), data.manifest, 1, field);
  for (const StarImage& image : images.images) {
    const auto x = static_cast<double>(image.x), y = static_cast<double>(image.y);
    const bool across = images.wraps || (x >= image.left && x <= image.right);
    if (across && y >= 0 && y <= camera.height) ++out[image.star];
  }
  return out;
}

TEST(StarImages, AreFoundOnceEach) {
  const StarField field = random_field(20000);
  for (const int n : counts(field, of_all_directions(CameraType::panorama, 72, 36))) ASSERT_EQ(n, 1);
  for (const int n : counts(field, of_all_directions(CameraType::panorama, 25, 13), 3)) ASSERT_EQ(n, 1);
  // Faces are continued beyond their edges in straight lines, so near an edge a few are seen on both or on
  // none.
  int wrong = 0;
  for (const int n : counts(field, of_all_directions(CameraType::cube_map, 6 * 32, 32))) wrong += n != 1;
  EXPECT_LT(wrong, 30);
}

TEST(StarImages, ThatFallOnRaysAreFoundOnce) {
  // Stars in the very directions of the rays: on corners of triangles.
  const Camera camera = of_all_directions(CameraType::panorama, 32, 16);
  const Dataset data = sky_dataset(camera);
  std::vector<Star> stars;
  for (std::size_t i = 0; i < data.hits.count(); ++i) {
    const double lon = 2 * std::numbers::pi * (static_cast<double>(data.hits.u[i]) - 0.5),
                 lat = std::numbers::pi * (static_cast<double>(data.hits.v[i]) - 0.5);
    stars.push_back({{static_cast<float>(std::cos(lat) * std::cos(lon)),
                      static_cast<float>(std::cos(lat) * std::sin(lon)), static_cast<float>(std::sin(lat))},
                     1,
                     6000});
  }
  stars.push_back({{1, 0, 0}, 1, 6000});
  stars.push_back({{0, 1, 0}, 1, 6000});
  stars.push_back({{0, 0, 1}, 1, 6000});
  int total = 0;
  for (const int n : counts(StarField(stars), camera)) {
    EXPECT_LE(n, 1);
    total += n;
  }
  EXPECT_EQ(total, static_cast<int>(stars.size()));
}

TEST(StarImages, TreeFindsAllStarsInABox) {
  for (const std::size_t count : {1U, 8U, 9U, 17U, 3000U}) {
    const StarField field = random_field(count, 7);
    for (int k = 0; k < 100; ++k) {
      Box box;
      for (std::size_t i = 0; i < 3; ++i) {
        box.low[i] = static_cast<float>(std::sin(1.7 * k + 2.1 * static_cast<double>(i)));
        box.high[i] = box.low[i] + 0.01f * static_cast<float>(k);
      }
      std::vector<char> found(count);
      field.within(box, [&](std::uint32_t first, std::uint32_t last) {
        for (std::uint32_t i = first; i < last; ++i) found[i]++;
      });
      for (std::size_t i = 0; i < count; ++i) {
        const auto& d = field.stars()[i].direction;
        ASSERT_LE(found[i], 1);
        ASSERT_TRUE(found[i] == 1 || !box.meets({d, d}));
      }
    }
  }
}

TEST(StarCatalogue, ByChanceFollowsItsLaw) {
  std::vector<Star> stars;
  RandomStars rule{100000, 5, {1, 7}, {3000, 12000}};
  add_random_stars(rule, stars);
  int bright = 0;
  std::array<double, 3> mean{};
  for (const Star& star : stars) {
    const double m = -2.5 * std::log10(static_cast<double>(star.illuminance_lx) / kMagnitude0_lx);
    ASSERT_TRUE(m > 0.999 && m < 7.001 && star.temperature_K >= 3000 && star.temperature_K <= 12000.1f);
    bright += m < 6;
    for (std::size_t i = 0; i < 3; ++i) mean[i] += static_cast<double>(star.direction[i]) / 1e5;
  }
  // (10^(0.5 (6 - 1)) - 1) / (10^(0.5 (7 - 1)) - 1), and three standard deviations.
  EXPECT_NEAR(bright / 1e5, (std::pow(10, 2.5) - 1) / 999, 3 * std::sqrt(0.32 * 0.68 / 1e5));
  for (const double component : mean) EXPECT_NEAR(component, 0, 3 * std::sqrt(1 / 3e5));
  std::vector<Star> again, other, cluster;
  add_random_stars(rule, again);
  rule.seed = 6;
  add_random_stars(rule, other);
  EXPECT_EQ(again[77].direction, stars[77].direction);
  EXPECT_NE(other[77].direction, stars[77].direction);
  rule.around_deg = {120, 40};
  rule.spread_deg = 1;
  add_random_stars(rule, cluster);
  const Direction middle = direction_of(120, 40);
  double square = 0;
  for (const Star& star : cluster)
    for (std::size_t i = 0; i < 3; ++i)
      square += std::pow(static_cast<double>(star.direction[i]) - middle[i], 2);
  EXPECT_NEAR(std::sqrt(square / 2e5) / kDegree, 1, 0.02);
}

TEST(StarCatalogue, ReadsFilesAndTellsWhereTheyAreWrong) {
  const test::TestFolder folder;
  const auto read = [&](const std::string& text) {
    return read_stars(folder.write("s.csv", text), "/stars/file");
  };
  const auto stars =
      read("# bright\nname,ra,dec,V,T\nSirius, 101.287, -16.716, -1.46, 9940 # A1\n\n0,90,0,1e4\r\n");
  ASSERT_EQ(stars.size(), 2U);
  EXPECT_NEAR(static_cast<double>(stars[1].direction[2]), 1, 1e-7);
  EXPECT_NEAR(static_cast<double>(stars[0].illuminance_lx), 2.54e-6 * std::pow(10, 0.4 * 1.46), 1e-11);
  const std::string file = folder.file("s.csv");
  const auto fault = [&](const std::string& text) {
    std::string found = complaint([&] { read(text); });
    EXPECT_TRUE(found.starts_with(file)) << found;
    EXPECT_EQ(found.find('\n'), std::string::npos);
    return found.substr(std::min(found.size(), file.size() + 2));
  };
  EXPECT_EQ(fault("1,2,3,4000\n1,2,bright,4000\n"),
            "line 2: expected a magnitude from -50 to 50, found 'bright'");
  EXPECT_EQ(fault("1,2,nan,4000\n"), "line 1: expected a magnitude from -50 to 50, found 'nan'");
  EXPECT_EQ(fault("1,2,3,inf\n"), "line 1: expected a temperature in kelvin from 500 to 1e6, found 'inf'");
  EXPECT_EQ(fault("1,2,3,0\n"), "line 1: expected a temperature in kelvin from 500 to 1e6, found '0'");
  EXPECT_EQ(fault("1,91,3,5000\n"), "line 1: expected a declination in degrees from -90 to 90, found '91'");
  EXPECT_EQ(fault("1,2,3,5000\n\n#\n1,2\n").substr(0, 23), "line 4: holds 2 columns");
  EXPECT_EQ(fault("# nothing\n"), "/stars/file: holds no stars");
  EXPECT_EQ(fault(std::string(5000, 'x')).substr(0, 50),
            "line 1: is longer than 1000 characters; expected a");
  EXPECT_EQ(complaint([&] { read_stars(folder.file("none"), "/p"); }),
            folder.file("none") + ": /p: no such file; expected a catalogue of stars");
  EXPECT_EQ(complaint([&] { read_stars(folder.path(), "/p"); }),
            folder.path() + ": /p: not a file; expected a catalogue of stars");
  // Two GiB of nothing.
  std::filesystem::resize_file(folder.write("big", ""), std::uintmax_t{2} << 30);
  EXPECT_EQ(complaint([&] { read_stars(folder.file("big"), "/p"); }),
            folder.file("big") + ": /p: is larger than 512 MiB; expected a catalogue of stars");
}

TEST(StarLooks, AreReadStrictly) {
  const Manifest manifest = [] {
    Manifest out;
    out.objects = {{"sky"}, {"ball"}};
    out.scene =
        R"({"objects":[{"name":"sky","shape":{"type":"sky"}},{"name":"ball","shape":{"type":"sphere"}}]})";
    return out;
  }();
  const auto fault = [&](const std::string& name, const std::string& stars) {
    return complaint(
        [&] { look_of(R"({"objects":{")" + name + R"(":{"stars":)" + stars + "}}}", manifest); });
  };
  EXPECT_EQ(fault("sky", R"({"random":[{"count":3}]})"), "");
  EXPECT_EQ(fault("ball", R"({"random":[{"count":3}]})"),
            "look.json: /objects/ball/stars: is no sky; expected stars on a sky only");
  EXPECT_EQ(fault("sky", "{}"), "look.json: /objects/sky/stars: expected file, or random, or both");
  EXPECT_NE(fault("sky", R"({"random":[{"count":2.5}]})"), "");
  EXPECT_NE(fault("sky", R"({"random":[{"count":3,"colour":1}]})"), "");
  EXPECT_NE(fault("sky", R"({"random":[{"count":3,"magnitudes":[5,4]}]})"), "");
  EXPECT_NE(fault("sky", R"({"random":[{"count":3000000},{"count":3000000}]})"), "");
  EXPECT_NE(fault("sky", R"({"random":[{"count":3,"spread_deg":4}]})"), "");
  EXPECT_NE(
      fault("sky", R"({"random":[{"count":3}],"rotate_deg":[0,0,{"keyframes":[[0,0],[1,5]],"by":"t"}]})"),
      "");
  EXPECT_NE(fault("sky", R"({"random":[{"count":3}],"size_px":0})"), "");
}

}  // namespace
}  // namespace nullcone::postrender
