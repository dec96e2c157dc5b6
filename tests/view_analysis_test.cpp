// What the viewer tells of a dataset: pictures as bytes, histograms of emission times, lists of images, false
// colours.
#include <gtest/gtest.h>
#include <png.h>
#include <turbojpeg.h>
#include <webp/decode.h>

#include <fstream>

#include "apps/view/channel_view.h"
#include "apps/view/encode.h"
#include "apps/view/histogram.h"
#include "apps/view/image_list.h"
#include "core/scene/read_scene.h"
#include "core/trace/trace_scene.h"
#include "metrics/registry.h"
#include "postrender/channel_values.h"
#include "postrender/legend.h"
#include "tests/postrender_fixture.h"

namespace nullcone::view {
namespace {

using nlohmann::ordered_json;
using postrender::complaint;
using postrender::make_dataset;
using postrender::TestHit;
using Bytes = std::vector<std::uint8_t>;

/// Smooth, but for an edge where it is wide.
Bytes some_picture(int width, int height) {
  Bytes out;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (const int value : {40 + x / 3, 60 + y / 3, 90})
        out.push_back(static_cast<std::uint8_t>(x < 150 ? value : value + 60));
  return out;
}

Bytes decoded(Format format, const std::string& bytes, int width, int height) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  Bytes out(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  int w = 0, h = 0;
  if (format == Format::png) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    EXPECT_NE(png_image_begin_read_from_memory(&image, data, bytes.size()), 0);
    EXPECT_EQ(image.format, static_cast<unsigned>(PNG_FORMAT_RGB));
    w = static_cast<int>(image.width), h = static_cast<int>(image.height);
    EXPECT_NE(png_image_finish_read(&image, nullptr, out.data(), 0, nullptr), 0);
  } else if (format == Format::webp) {
    EXPECT_NE(WebPGetInfo(data, bytes.size(), &w, &h), 0);
    EXPECT_NE(WebPDecodeRGBInto(data, bytes.size(), out.data(), out.size(), 3 * width), nullptr);
  } else {
    tjhandle decoder = tjInitDecompress();
    int subsampling = -1, space = -1;
    EXPECT_EQ(tjDecompressHeader3(decoder, data, bytes.size(), &w, &h, &subsampling, &space), 0);
    EXPECT_EQ(subsampling, TJSAMP_444);
    EXPECT_EQ(tjDecompress2(decoder, data, bytes.size(), out.data(), width, 0, height, TJPF_RGB, 0), 0);
    tjDestroy(decoder);
  }
  EXPECT_EQ(w, width);
  EXPECT_EQ(h, height);
  return out;
}

double mean_error(const Bytes& a, const Bytes& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(double(a[i]) - double(b[i]));
  return sum / static_cast<double>(a.size());
}

TEST(ViewEncode, DecodesToWhatWentIn) {
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 3}, {5, 1}, {17, 33}, {301, 203}}) {
    const Bytes in = some_picture(width, height);
    EXPECT_EQ(decoded(Format::png, encode(Format::png, width, height, in), width, height), in) << width;
    for (const Format lossy : {Format::jpeg, Format::webp})
      EXPECT_LT(mean_error(decoded(lossy, encode(lossy, width, height, in), width, height), in), 3)
          << width << content_type(lossy);
    const std::string raw = encode(Format::raw, width, height, in);
    ASSERT_EQ(raw.size(), in.size() / 3 * 4);
    for (std::size_t i = 0; i < raw.size(); ++i)
      ASSERT_EQ(static_cast<std::uint8_t>(raw[i]), i % 4 == 3 ? 255 : in[i / 4 * 3 + i % 4]) << i;
  }
}

TEST(ViewEncode, FailsWithAReason) {
  const Bytes in = some_picture(4, 4);
  EXPECT_THROW(encode(Format::raw, 4, 5, in), WorkError);
  EXPECT_THROW(encode(Format::png, 0, 0, {}), WorkError);
  const Bytes line = some_picture(1'000'001, 1);  // wider than each of the formats can be
  for (const Format format : {Format::jpeg, Format::webp, Format::png})
    EXPECT_THROW(encode(format, 1'000'001, 1, line), WorkError) << content_type(format);
  EXPECT_EQ(find_format("jpeg"), Format::jpeg);
  EXPECT_FALSE(find_format("gif"));
}

/// One line of crossings with "earth" at these times; one with "moon" behind the first.
Dataset at_times(const std::vector<float>& times) {
  return make_dataset(static_cast<int>(times.size()), 1, {{"earth", 10}, {"moon", 0}}, [&](int x, int) {
    TestHit hit, moon;
    hit.t = times[static_cast<std::size_t>(x)], hit.tau = 2 * hit.t;
    moon.id = 2, moon.t = 99;
    return x == 0 ? std::vector{hit, moon} : std::vector{hit};
  });
}

TEST(ViewHistogram, CountsEveryCrossingOfTheObject) {
  const Dataset data = at_times({-4, -3.9F, -2, 0, NAN, -INFINITY});
  const ordered_json t = emission_histogram(data, "earth", "t", 4);
  EXPECT_EQ(t.dump(), R"({"channel":"t","from":-4.0,"to":0.0,"counts":[2,0,1,1],"finite":4,"other":2})");
  const ordered_json tau = emission_histogram(data, "earth", "tau", 2);  // 10 + 2 t
  EXPECT_EQ(tau["from"], 2.0);
  EXPECT_EQ(tau["to"], 10.0);
  EXPECT_EQ(tau["counts"].dump(), "[2,2]");
  const ordered_json one = emission_histogram(data, "moon", "t", 3);
  EXPECT_LT(one["from"], 99);
  EXPECT_GT(one["to"], 99);
  EXPECT_EQ(one["counts"].dump(), "[0,1,0]");
  const ordered_json none = emission_histogram(at_times({NAN}), "earth", "t", 1);
  EXPECT_EQ(none["finite"], 0);
  EXPECT_LT(none["from"], none["to"]);
}

TEST(ViewHistogram, RefusesWhatThereIsNot) {
  Dataset data = at_times({1});
  EXPECT_EQ(complaint([&] { emission_histogram(data, "mars", "t", 4); }),
            "object: there is no 'mars'; expected one of earth, moon");
  EXPECT_NE(complaint([&] { emission_histogram(data, "earth", "Z", 4); }), "");
  for (const int bins : {0, -1, 1025})
    EXPECT_NE(complaint([&] { emission_histogram(data, "earth", "t", bins); }), "") << bins;
  data.hits.channels.bits &= ~ChannelSet::of("tau").bits;
  EXPECT_NE(complaint([&] { emission_histogram(data, "earth", "tau", 4); }).find("records.channels"),
            std::string::npos);
}

/// Letters are crossings: "a" at t = -1, "b" at t = -2 and so on; capitals have order 1; digits are another
/// object before one at t = -1.
Dataset drawn(const std::vector<std::string>& lines) {
  return make_dataset(static_cast<int>(lines[0].size()), static_cast<int>(lines.size()),
                      {{"earth", 10}, {"moon", 0}}, [&](int x, int y) {
                        const char c = lines[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
                        TestHit hit, moon;
                        moon.id = 2;
                        hit.order = c >= 'A' && c <= 'Z' ? 1 : 0;
                        hit.t = c <= '9' ? -1.0F : static_cast<float>((hit.order > 0 ? 'A' : 'a') - c - 1);
                        hit.tau = 2 * hit.t, hit.shift = -hit.t;
                        if (c == ' ') return std::vector<TestHit>{};
                        return c <= '9' ? std::vector{moon, hit} : std::vector{hit};
                      });
}

TEST(ViewImages, AreConnectedRegionsTheEarliestFirst) {
  const Dataset data = drawn({"a  bB  ", " a   BC", "1  cc  "});
  const ordered_json found = images_of(data, "earth");
  ASSERT_EQ(found["images"].size(), 4u);
  EXPECT_EQ(found["omitted"], 0);
  // c, B and C (mean of -2, -2 and -3), b, and a with what is behind the moon.
  EXPECT_EQ(found["images"][0].dump(),
            R"({"number":1,"order":0,"pixels":2,"centre":[3.5,2.0],"box":[3,2,4,2],"t":[-3.0,-3.0,-3.0],)"
            R"("tau":[4.0,4.0,4.0],"shift":[3.0,3.0,3.0]})");
  EXPECT_EQ(found["images"][1]["order"], 1);
  EXPECT_EQ(found["images"][1]["pixels"], 3);
  EXPECT_EQ(found["images"][1]["box"].dump(), "[4,0,6,1]");
  EXPECT_NEAR(found["images"][1]["t"][1].get<double>(), -7.0 / 3, 1e-12);
  EXPECT_EQ(found["images"][2]["pixels"], 1);
  EXPECT_EQ(found["images"][3]["pixels"], 3);
  EXPECT_EQ(found["images"][3]["box"].dump(), "[0,0,1,2]");
  EXPECT_EQ(images_of(data, "moon")["images"].size(), 1u);
  // -7/3 on the average comes before -2, though most of it is later.
  EXPECT_EQ(images_of(drawn({"b eaa"}), "earth")["images"][0]["pixels"], 3);
  EXPECT_NE(complaint([&] { images_of(data, "mars"); }).find("earth, moon"), std::string::npos);
}

TEST(ViewImages, MeetAtTheEdgesOfAPanoramaAllAround) {
  Dataset data = drawn({"a    ", "    a", "bb bb"});
  data.manifest.first_line = 7;
  data.manifest.setting = R"({"camera":{"type":"panorama","fov_rad":[3.1,1]}})";
  EXPECT_EQ(images_of(data, "earth")["images"].size(), 3u);  // b touches a at the right
  data.manifest.setting = R"({"camera":{"type":"panorama","fov_rad":[6.283185307179586,1]}})";
  const ordered_json found = images_of(data, "earth");
  ASSERT_EQ(found["images"].size(), 1u);
  EXPECT_EQ(found["images"][0]["pixels"], 6);
  EXPECT_EQ(found["images"][0]["box"].dump(), "[3,7,6,9]");
  EXPECT_NEAR(found["images"][0]["centre"][0].get<double>(), (5 + 4 + 5 + 6 + 3 + 4) / 6.0, 1e-12);
  for (const char* odd :
       {"", "[]", "{}", "{\"camera\":3}", "{\"camera\":{\"fov_rad\":7,\"type\":\"panorama\"}}"}) {
    data.manifest.setting = odd;
    EXPECT_EQ(images_of(data, "earth")["images"].size(), 3u) << odd;
  }
}

TEST(ViewImages, EndAtTheEdgesOfACubesFaces) {
  Dataset data = drawn({"aaa         ", "   a        ", "         aaa"});
  data.manifest.setting = R"({"camera":{"type":"tetrahedron_map","fov_rad":[6.283185307179586,3.1]}})";
  EXPECT_EQ(images_of(data, "earth")["images"].size(), 2u);  // the last row meets nothing
  data.manifest.setting = R"({"camera":{"type":"cube_map","fov_rad":[6.283185307179586,3.1]}})";
  EXPECT_EQ(images_of(data, "earth")["images"].size(), 4u);  // two columns a face
}

TEST(ViewImages, OfSeveralCrossingsAPixelAreTwoWhereOrdersDiffer) {
  const Dataset data = make_dataset(3, 2, {{"earth"}}, [](int x, int) {
    TestHit near, behind;
    behind.order = 2, behind.t = -5;
    return x == 1 ? std::vector{near, behind, near} : std::vector{x == 0 ? near : behind};
  });
  const ordered_json images = images_of(data, "earth")["images"];
  ASSERT_EQ(images.size(), 2u);
  EXPECT_EQ(images[0]["order"], 2);
  for (const ordered_json& image : images) EXPECT_EQ(image["pixels"], 4);
}

TEST(ViewImages, AreSortedByDistanceWithoutTimesAndCutOffAtTwoHundred) {
  Dataset data = make_dataset(801, 1, {{"earth"}},
                              [](int x, int) { return std::vector<TestHit>(x % 2 == 0 || x == 3 ? 1 : 0); });
  for (std::size_t i = 0; i < data.hits.Z.size(); ++i) data.hits.Z[i] = static_cast<float>(i);
  data.hits.channels = kLeastChannels | ChannelSet::of("shift");
  data.hits.t.clear(), data.hits.tau.clear(), data.hits.order.clear();
  const ordered_json found = images_of(data, "earth");
  ASSERT_EQ(found["images"].size(), 200u);
  EXPECT_EQ(found["omitted"], 200);
  EXPECT_EQ(found["images"].back()["number"], 200);
  EXPECT_FALSE(found["images"][0].contains("t") || found["images"][0].contains("order"));
  EXPECT_GT(found["images"][0]["centre"][0], found["images"][1]["centre"][0]);  // farther to the right
  int wide = 0;
  for (const ordered_json& image : found["images"]) wide += image["pixels"] == 3;
  EXPECT_EQ(wide, 1);  // the largest is among them
}

/// The published picture of a sphere in Goedel's universe (Grave & Buser 2008, table of its figure 5).
TEST(ViewImages, OfTheSphereInGoedelsUniverseAreThree) {
  nlohmann::json scene = nlohmann::json::parse(std::ifstream(NULLCONE_SOURCE "/scenes/goedel_earth.json"));
  scene["camera"]["resolution"] = {880, 100};
  const Scene read = read_scene(scene.dump(), "test", metric_descriptions());
  const Dataset data = trace_scene(find_spacetime("goedel"), read, "test");
  const ordered_json images = images_of(data, "earth")["images"];
  struct Row {
    double azimuth_from, azimuth_to, t_from, t_to, g;
    bool mirrored;
  };
  const Row rows[] = {{114, 129, -3.66, -3.59, 1.006, false},
                      {-81, -53, -2.10, -2.03, 0.442, true},
                      {62, 86, -0.65, -0.57, 0.476, false}};
  ASSERT_EQ(images.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto azimuth = [](double x) { return 24 + 220 * (0.5 - (x + 0.5) / 880); };
    const ordered_json& box = images[i]["box"];
    EXPECT_NEAR(azimuth(box[2]), rows[i].azimuth_from, 0.8)
        << i;  // rounded to 1, and a pixel is 0.25 degrees
    EXPECT_NEAR(azimuth(box[0]), rows[i].azimuth_to, 0.8) << i;
    EXPECT_NEAR(images[i]["t"][0].get<double>(), rows[i].t_from, 0.01) << i;
    EXPECT_NEAR(images[i]["t"][2].get<double>(), rows[i].t_to, 0.01) << i;
    EXPECT_NEAR(images[i]["shift"][1].get<double>(), rows[i].g, 0.003) << i;
    EXPECT_EQ(images[i]["order"].get<int>() % 2 == 1, rows[i].mirrored) << i;
  }
}

}  // namespace
}  // namespace nullcone::view
