// Which channels a look needs, and what is made of datasets that lack some.
#include "postrender/needed_channels.h"
#include "tests/postrender_fixture.h"

namespace nullcone::postrender {
namespace {

ChannelSet set_of(const std::vector<std::string>& groups) {
  ChannelSet out;
  for (const std::string& group : groups) out = out | ChannelSet::of(group);
  return out;
}

ChannelSet needed(const std::string& text, ChannelSet recorded = kDefaultChannels, int samples = 1) {
  Manifest manifest;
  manifest.objects = {{"earth"}};
  manifest.channels = recorded;
  manifest.samples = samples;
  return needed_channels(look_of(text, manifest), manifest);
}

std::string with_texture(const std::string& texture) {
  return R"({"objects":{"earth":{"texture":)" + texture +
         R"(}},"effects":{"doppler":false,"searchlight":false}})";
}

constexpr const char* kPlain = R"({"effects":{"doppler":true,"searchlight":false}})";
constexpr const char* kBoard = R"({"type":"checkerboard","counts":[4,4],"colors":[[1,1,1],[0,0,0]]})";

TEST(NeededChannels, are_those_that_change_the_picture) {
  EXPECT_EQ(needed("{}"), set_of({"A", "id", "shift"}));  // colours are beamed
  EXPECT_EQ(needed(kPlain), set_of({"A", "id"}));         // but have no wavelengths to shift
  EXPECT_EQ(needed(with_texture(kBoard)), set_of({"A", "id", "uv", "order"}));
  EXPECT_EQ(needed(with_texture(R"({"type":"image","file":"a.png"})")), set_of({"A", "id", "uv", "order"}));
  EXPECT_EQ(needed(with_texture(R"({"type":"image","file":"a.png","filter":"bilinear"})")),
            set_of({"A", "id", "uv"}));
  EXPECT_EQ(needed(R"({"objects":{"earth":{"spectrum":{"type":"black_body","temperature_K":5000}}},
                       "effects":{"searchlight":false}})"),
            set_of({"A", "id", "shift"}));
  const std::string slice = R"({"objects":{"earth":{"time_slices":[{"channel":"CLOCK","from":0,
      "texture":{"type":"color","rgb":[1,1,1]}}]}},"effects":{"searchlight":false}})";
  for (const std::string clock : {"t", "tau"}) {
    std::string text = slice;
    text.replace(text.find("CLOCK"), 5, clock);
    EXPECT_EQ(needed(text), set_of({"A", "id", clock}));
  }
}

TEST(NeededChannels, include_recorded_steps_and_samples_where_there_are_any) {
  EXPECT_EQ(needed(with_texture(kBoard), kAllChannels), set_of({"A", "id", "uv", "duv"}));
  EXPECT_EQ(needed(kPlain, kAllChannels), set_of({"A", "id"}));
  EXPECT_EQ(needed(kPlain, kDefaultChannels | ChannelSet::of("sample"), 2), set_of({"A", "id", "sample"}));
}

TEST(NeededChannels, are_not_needed_by_what_is_hidden) {
  EXPECT_EQ(needed(R"({"objects":{"earth":{"opacity":0,"texture":{"type":"image","file":"a.png"}}}})"),
            set_of({"A", "id"}));
}

/// `data` without the channels of some groups.
Dataset without(Dataset data, const std::vector<std::string>& groups) {
  data.hits.channels.bits &= ~set_of(groups).bits;
  data.manifest.channels = data.hits.channels;
  for (const std::string& group : groups) {
    const auto drop = [&](const char* name, auto& column) {
      if (group == name) column.clear(), column.shrink_to_fit();
    };
    drop("order", data.hits.order), drop("uv", data.hits.u), drop("uv", data.hits.v);
    drop("shift", data.hits.shift), drop("t", data.hits.t), drop("tau", data.hits.tau);
    drop("mu", data.hits.mu), drop("Z", data.hits.Z), drop("A", data.hits.A), drop("id", data.hits.id);
  }
  return data;
}

TEST(MissingChannels, are_named_with_what_needs_them) {
  const auto found = [](const std::string& text, const std::vector<std::string>& groups) {
    const Dataset data = without(flat_map(4, 2), groups);
    const Look look = look_of(text, data.manifest);
    // The renderer refuses them too, and does not read beyond what is there.
    EXPECT_NE(complaint([&] { Renderer(data).render(look); }), "") << text;
    return complaint([&] { check_channels(look, data.manifest, data.hits.channels, "a.exr"); });
  };
  EXPECT_EQ(
      found(R"({"objects":{"earth":{"spectrum":{"type":"black_body","temperature_K":5000}}}})", {"shift"}),
      "a.exr: has no channel 'shift', which the look needs for /effects/doppler; trace with "
      "records.channels that include it, or switch the effect off");
  EXPECT_NE(found("{}", {"shift"}).find("for /effects/searchlight;"), std::string::npos);
  EXPECT_NE(
      found(with_texture(kBoard), {"uv"}).find("'uv', which the look needs for /objects/earth/texture;"),
      std::string::npos);
  EXPECT_NE(found(R"({"objects":{"earth":{"time_slices":[{"channel":"t","spectrum":{"type":"display"}},
                     {"channel":"tau","spectrum":{"type":"display"}}]}}})",
                  {"tau"})
                .find("'tau', which the look needs for /objects/earth/time_slices/1;"),
            std::string::npos);
}

TEST(MissingChannels, that_nothing_asks_for_change_nothing) {
  // Lines with one crossing a pixel are read as they lie, others are copied: both with gaps in the columns.
  const auto data = [] {
    return make_dataset(8, 6, {{"earth"}}, [](int column, int row) {
      TestHit hit;
      hit.u = 0.1f * static_cast<float>(column);
      hit.v = 0.15f * static_cast<float>(row);
      hit.shift = 1;
      return std::vector<TestHit>(row < 3 ? 1 : static_cast<std::size_t>(column % 3), hit);
    });
  };
  const std::vector<std::string> spare = {"Z", "t", "tau", "mu"};
  for (const std::string& text : {std::string("{}"), with_texture(kBoard)})
    EXPECT_EQ(picture(without(data(), spare), text).exposed, picture(data(), text).exposed);
  // All of one order, as missing ones are taken; no effect needs the shift.
  const std::vector<std::string> more = {"Z", "t", "tau", "mu", "order", "shift"};
  EXPECT_EQ(picture(without(data(), more), with_texture(kBoard)).exposed,
            picture(data(), with_texture(kBoard)).exposed);
  EXPECT_EQ(picture(without(data(), {"uv", "shift"}), kPlain).exposed, picture(data(), kPlain).exposed);
  // A black body without effects is black only where a shift that is recorded makes no sense.
  const std::string body = R"({"objects":{"earth":{"spectrum":{"type":"black_body","temperature_K":5000}}},
    "effects":{"doppler":false,"searchlight":false}})";
  EXPECT_EQ(picture(without(data(), {"shift"}), body).exposed, picture(data(), body).exposed);
  EXPECT_GT(picture(without(data(), {"shift"}), body).exposed[0].g, 0.5f);
}

TEST(MissingChannels, without_which_there_is_no_picture_are_refused) {
  for (const char* channel : {"A", "id"})
    EXPECT_EQ(complaint([&] { Renderer renderer(without(flat_map(2, 2), {channel})); }),
              "dataset: has no channel '" + std::string(channel) + "'");
}

}  // namespace
}  // namespace nullcone::postrender
