#include "core/scene/read_records.h"

#include <nlohmann/json.hpp>

namespace nullcone {

namespace {

std::string channel_names() {
  std::string out;
  std::string_view last;
  for (const ChannelInfo& channel : kHitChannelInfo) {
    if (channel.group() == last) continue;
    last = channel.group();
    out += (out.empty() ? "" : ", ") + std::string(last);
  }
  return out;
}

/// Channels by the names of their groups; what every dataset has need not be named.
ChannelSet read_channels(JsonObject& records, bool lit) {
  ChannelSet out = kLeastChannels;
  const nlohmann::json& names = records.at("channels");
  if (!names.is_array()) records.refuse("channels", "expected a list of names");
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string name = names[i].is_string() ? names[i].get<std::string>() : "";
    const ChannelSet group = ChannelSet::of(name);
    if (group.bits == 0)
      records.refuse("channels/" + std::to_string(i), "expected one of " + channel_names());
    if (group == ChannelSet::of("light") && !lit)
      records.refuse("channels/" + std::to_string(i), "'light' needs lamps; the scene has no lights");
    out = out | group;
  }
  return out;
}

}  // namespace

Records read_records(JsonObject& root, const Scene& scene) {
  Records out;
  const bool lit = !scene.lights.lamps.empty();
  const ChannelSet always = (scene.camera.samples > 1 ? ChannelSet::of("sample") : ChannelSet{}) |
                            (lit ? ChannelSet::of("light") : ChannelSet{});
  out.channels = out.channels | always;
  if (!root.has("records")) return out;
  JsonObject records = root.object("records");
  if (records.has("max_hits"))
    out.max_hits = static_cast<std::uint32_t>(records.integer("max_hits", 1, 1000));
  if (records.has("order"))
    out.max_order = static_cast<std::uint32_t>(records.integer("order", 0, 1'000'000));
  if (records.has("channels")) out.channels = read_channels(records, lit);
  if (records.boolean("differentials", false)) out.channels = out.channels | ChannelSet::of("duv");
  out.channels = out.channels | always;
  records.finish();
  return out;
}

}  // namespace nullcone
