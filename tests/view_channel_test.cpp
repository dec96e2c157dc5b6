// Channels in false colours, as the viewer shows them: the same as nullcone-postrender --show.
#include <set>

#include "apps/view/channel_view.h"
#include "postrender/channel_values.h"
#include "postrender/color.h"
#include "postrender/legend.h"
#include "tests/postrender_fixture.h"

namespace nullcone::view {
namespace {

using nlohmann::ordered_json;
using postrender::complaint;
using postrender::TestHit;

/// Some values of everything, and nothing in the last column; light of a lamp along two paths.
Dataset colorful() {
  Dataset out = postrender::make_dataset(40, 9, {{"earth"}, {"moon"}}, [](int x, int y) {
    TestHit hit;
    hit.id = x < 9 ? 1 : 2;
    hit.shift = 0.3F + 0.05F * static_cast<float>(x);
    hit.t = y == 3 ? -INFINITY : -0.1F * static_cast<float>(x);
    hit.order = static_cast<std::uint32_t>(y);
    return std::vector<TestHit>(x == 39 ? 0 : 1, hit);
  });
  out.manifest.set_lights({{"sun", 0}}, 2);
  out.hits.channels = out.manifest.channels;
  set_lamps(out.hits, {"sun"}, 2);
  const std::size_t count = out.hits.Z.size();
  for (LightPath& path : out.hits.light)
    path = {path.prefix, std::vector<float>(count, 0.5F), std::vector<float>(count, 2.0F),
            std::vector<float>(count, -3.0F), std::vector<float>(count, -4.0F)};
  for (std::size_t i = 0; i < out.rays.status.size(); ++i) {
    out.rays.status[i] = i % 7 == 0 ? 6 : 1;
    out.rays.error[i] = i % 5 == 0 ? 0 : 1e-9F * static_cast<float>(i);
  }
  return out;
}

TEST(ViewChannels, AreColoredAsInPicturesWithALegend) {
  const Dataset data = colorful();
  for (const ordered_json& channel : channel_list(data.manifest)) {
    const std::string name = channel["name"];
    const auto choice = postrender::find_channel(name, data.manifest, "a.exr");
    const std::vector<float> values = postrender::channel_values(choice, data);
    postrender::ColorScale scale = postrender::choose_scale(choice.info, values, {});
    scale.channel = name;
    const auto image = postrender::false_color_picture(scale, choice.info, data.manifest, values);
    const auto encoded = postrender::encode_srgb8(image.display);
    const ChannelView view = view_channel(data, name, {});
    ASSERT_EQ(view.rgb.size(), 3u * 40 * 9) << name;
    for (std::size_t i = 0; i < view.rgb.size(); ++i)
      ASSERT_EQ(view.rgb[i], encoded[i / 120 * 3 * static_cast<std::size_t>(image.width) + i % 120])
          << name << " " << i;
    EXPECT_EQ(view.legend["name"], name);
    EXPECT_EQ(view.legend["unit"], channel["unit"]);
    EXPECT_EQ(view.legend["meaning"], channel["meaning"]);
    if (view.legend["kind"] == "categories") continue;
    EXPECT_EQ(view.legend["from"], scale.range.first);
    EXPECT_EQ(view.legend["colors"].size(), 64u);
  }
}

TEST(ViewChannels, AreThoseThatCanBeShown) {
  Dataset data = colorful();
  std::set<std::string> names;
  for (const ordered_json& channel : channel_list(data.manifest)) names.insert(channel["name"]);
  for (const char* name :
       {"status", "steps", "error", "drift", "shift", "uv.U", "light.sun.0.E", "light.sun.1.tau"})
    EXPECT_EQ(names.count(name), 1u) << name;
  EXPECT_EQ(names.count("duv.Ux"), 0u);
  EXPECT_EQ(names.size(), 4 + 10 + 8u);
  EXPECT_EQ(complaint([&] { view_channel(data, "colour", {}); }).substr(0, 62),
            "channel: there is no 'colour'; expected one of status, steps, ");
  EXPECT_NE(complaint([&] { view_channel(data, "duv.Ux", {}); }), "");
  data.rays = {};
  EXPECT_NE(complaint([&] { view_channel(data, "status", {}); }), "");
}

TEST(ViewChannels, HaveLegendsWithTicksOrNames) {
  const Dataset data = colorful();
  const ordered_json t = view_channel(data, "t", std::pair{-4.0, 0.0}).legend;
  EXPECT_EQ(t["kind"], "linear");
  EXPECT_EQ(t["ticks"][1].dump(), R"({"value":-3.0,"text":"-3","place":0.25})");
  const ordered_json shift = view_channel(data, "shift", std::pair{0.25, 4.0}).legend;
  EXPECT_EQ(shift["kind"], "shift");
  bool one = false;
  for (const ordered_json& tick : shift["ticks"]) one |= tick["text"] == "1" && tick["place"] == 0.5;
  EXPECT_TRUE(one);
  EXPECT_EQ(view_channel(data, "error", {}).legend["kind"], "logarithmic");
  const ordered_json id = view_channel(data, "id", {}).legend;
  ASSERT_EQ(id["categories"].size(), 2u);
  EXPECT_EQ(id["categories"][1]["text"], "moon");
  const ChannelView status = view_channel(data, "status", {});
  ASSERT_EQ(status.legend["categories"].size(), 2u);
  EXPECT_EQ(status.legend["categories"][1]["value"], 6);
  EXPECT_EQ(status.legend["categories"][1]["text"], std::string(kStatusNames[6]));
  const auto hex = [&](std::size_t pixel) {
    char out[8];
    std::snprintf(out, sizeof out, "#%02x%02x%02x", status.rgb[3 * pixel], status.rgb[3 * pixel + 1],
                  status.rgb[3 * pixel + 2]);
    return std::string(out);
  };
  EXPECT_EQ(status.legend["categories"][1]["color"], hex(0));
  EXPECT_EQ(status.legend["categories"][0]["color"], hex(1));
}

TEST(ViewChannels, RefuseRangesThatMakeNoSense) {
  const Dataset data = colorful();
  const auto about = [&](const char* name, double from, double to) {
    return complaint([&] { view_channel(data, name, std::pair{from, to}); });
  };
  EXPECT_NE(about("t", 1, 1), "");
  EXPECT_NE(about("t", NAN, 1), "");
  EXPECT_NE(about("t", 0, INFINITY), "");
  EXPECT_NE(about("shift", 0, 1), "");
  EXPECT_NE(about("id", 0, 1), "");
  EXPECT_EQ(about("t", -1, 1), "");
}

}  // namespace
}  // namespace nullcone::view
