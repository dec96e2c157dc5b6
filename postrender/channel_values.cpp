#include "postrender/channel_values.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"

namespace nullcone::postrender {

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

std::string all_names() {
  std::string out;
  for (const ChannelInfo& info : kRayChannelInfo) out += std::string(info.name) + ", ";
  for (const ChannelInfo& info : kHitChannelInfo) out += std::string(info.name) + ", ";
  return out.substr(0, out.size() - 2);
}

/// Those of light from lamps, lamp by lamp.
std::string light_names(const Manifest& manifest) {
  std::string out;
  const std::string last = std::to_string(manifest.light_paths - 1);
  for (const ObjectEntry& lamp : manifest.lights)
    for (const ChannelInfo& info : kLightChannelInfo)
      out +=
          ", light." + lamp.name + (last == "0" ? ".0." : ".<0 to " + last + ">.") + std::string(info.name);
  return out;
}

template <class Column>
std::vector<float> nearest(const Column& column, const Hits& hits) {
  std::vector<float> out(hits.offset.size() - 1, kNone);
  for (std::size_t pixel = 0; pixel < out.size(); ++pixel)
    if (hits.offset[pixel] < hits.offset[pixel + 1])
      out[pixel] = static_cast<float>(column[hits.offset[pixel]]);
  return out;
}

/// Leaves out what stands beside an E of 0.
void hide_unlit(const std::string& name, const Hits& hits, std::vector<float>& values) {
  for (const LightPath& path : hits.light) {
    if (!name.starts_with(path.prefix) || name == path.prefix + "E") continue;
    const std::vector<float> lit = nearest(path.E, hits);
    for (std::size_t pixel = 0; pixel < values.size(); ++pixel)
      if (lit[pixel] == 0) values[pixel] = kNone;
  }
}

/// The greatest of the samples of each pixel; a sample that is not a number is worst.
template <class Column>
std::vector<float> worst(const Column& column, const Manifest& manifest) {
  const auto n = static_cast<std::size_t>(manifest.samples), width = static_cast<std::size_t>(manifest.width);
  std::vector<float> out(manifest.pixels(), -std::numeric_limits<float>::infinity());
  for (std::size_t ray = 0; ray < column.size(); ++ray) {
    float& pixel = out[ray / (n * width) / n * width + ray % (n * width) / n];
    const auto value = static_cast<float>(column[ray]);
    if (value > pixel || std::isnan(value)) pixel = value;
  }
  return out;
}

}  // namespace

ChannelChoice find_channel(const std::string& name, const Manifest& manifest, const std::string& file) {
  for (const ChannelInfo& info : kRayChannelInfo)
    if (info.name == name) return {name, info, true};
  for (std::size_t i = 0; i < kHitChannelInfo.size(); ++i) {
    if (kHitChannelInfo[i].name != name) continue;
    if (!manifest.channels.has(i))
      throw InputError(file, "has no channel '" + name + "'; trace with records.channels that include it");
    return {name, kHitChannelInfo[i]};
  }
  for (const std::string& light : channel_names(empty_hits(manifest, ChannelSet::of("light"))))
    if (light == name)
      return {name,
              *std::ranges::find(kLightChannelInfo, name.substr(name.rfind('.') + 1), &ChannelInfo::name)};
  throw InputError("--show", "unknown channel '" + printable(name, 40) + "'; expected one of " + all_names() +
                                 light_names(manifest));
}

std::vector<float> channel_values(const ChannelChoice& choice, const Dataset& dataset) {
  std::vector<float> out;
  const auto pick = [&](const ChannelInfo& info, const auto& column, auto&& values) {
    if (info.name == choice.name) out = values(column);
  };
  if (choice.of_rays) {
    for_each_channel(
        [&](const ChannelInfo& info, const auto& column) {
          pick(info, column, [&](const auto& found) { return worst(found, dataset.manifest); });
        },
        dataset.rays);
  } else {
    for_each_channel(
        [&](const ChannelInfo& info, const auto& column) {
          pick(info, column, [&](const auto& found) { return nearest(found, dataset.hits); });
        },
        dataset.hits);
    hide_unlit(choice.name, dataset.hits, out);
  }
  return out;
}

}  // namespace nullcone::postrender
