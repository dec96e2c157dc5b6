#include "apps/info.h"

namespace nullcone {

namespace {

Report channel_list(const auto& channels) {
  Report out = Report::array();
  for (const ChannelInfo& channel : channels)
    out.push_back({{"name", std::string(channel.name)},
                   {"type", channel.whole ? "uint" : "float"},
                   {"unit", std::string(channel.unit)},
                   {"range", std::string(channel.range)},
                   {"since", channel.since},
                   {"meaning", std::string(channel.meaning)}});
  return out;
}

}  // namespace

Report format_table() {
  Report statuses = Report::array();
  for (const std::string_view name : kStatusNames) statuses.push_back(std::string(name));
  return {{"format", kNewestFormat},
          {"band_lines", kBandLines},
          {"hits", channel_list(kHitChannelInfo)},
          {"light", channel_list(kLightChannelInfo)},
          {"rays", channel_list(kRayChannelInfo)},
          {"status", statuses}};
}

}  // namespace nullcone
