#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/record/dataset_file.h"

namespace nullcone {

using nlohmann::json;

namespace {

ChannelSet channels_from(JsonObject& root) {
  ChannelSet out;
  const json& names = root.at("channels");
  if (!names.is_array()) root.refuse("channels", "expected a list of names");
  for (const json& name : names) {
    std::size_t i = 0;
    while (i < kHitChannelInfo.size() && name != std::string(kHitChannelInfo[i].name)) ++i;
    if (i == kHitChannelInfo.size())
      root.refuse("channels", "names a channel that this program does not know");
    out.bits |= 1U << i;
  }
  if ((kLeastChannels & out) != kLeastChannels) root.refuse("channels", "expected Z, A and id among them");
  return out;
}

/// What format 2 has added.
void read_window(JsonObject& root, Manifest& m) {
  if (m.format == 1) {
    m.lines = m.traced_lines = m.height;
    return;
  }
  m.first_line = static_cast<int>(root.integer("first_line", 0, m.height - 1));
  m.lines = static_cast<int>(root.integer("lines", 1, m.height - m.first_line));
  m.traced_lines = static_cast<int>(root.integer("traced_lines", 0, m.lines));
  m.samples = static_cast<int>(root.integer("samples", 1, 16));
  m.channels = channels_from(root);
  m.setting = canonical_json(root.at("setting"));
  m.seconds = root.number("seconds");
}

}  // namespace

std::string manifest_to_json(const Manifest& m) {
  json objects = json::array();
  for (const ObjectEntry& object : m.objects)
    objects.push_back({{"name", object.name}, {"tau_origin", object.tau_origin}});
  json out = {{"format", m.format},
              {"width", m.width},
              {"height", m.height},
              {"scene", m.scene},
              {"scene_sha256", m.scene_sha256},
              {"metric", m.metric},
              {"objects", objects},
              {"version", m.version},
              {"isa", m.isa},
              {"host", m.host},
              {"core_seconds", m.core_seconds},
              {"hits_sha256", m.hits_sha256},
              {"rays_sha256", m.rays_sha256}};
  if (m.format > 1)
    out.update(json{{"first_line", m.first_line},
                    {"lines", m.lines},
                    {"traced_lines", m.traced_lines},
                    {"samples", m.samples},
                    {"channels", channel_names(m.channels)},
                    {"setting", m.setting.empty() ? json::object() : json::parse(m.setting)},
                    {"seconds", m.seconds}});
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

Manifest manifest_from_json(const std::string& text, const std::string& place) {
  const json document = parse_json(text, place);
  JsonObject root(document, place, "");
  Manifest m;
  m.format = static_cast<int>(root.integer("format", 1, 1'000'000));
  if (m.format > kNewestFormat)
    throw InputError(place, "has format " + std::to_string(m.format) + ", this program reads up to " +
                                std::to_string(kNewestFormat) + "; use a newer nullcone");
  m.width = static_cast<int>(root.integer("width", 1, 1L << 28));
  m.height = static_cast<int>(root.integer("height", 1, 1L << 28));
  read_window(root, m);
  m.scene = root.text("scene");
  m.scene_sha256 = root.text("scene_sha256");
  m.metric = root.text("metric");
  std::set<std::string> names;
  for (JsonObject& object : root.objects("objects")) {
    m.objects.push_back({object.name("name", names), object.number("tau_origin")});
    object.finish();
  }
  m.version = root.text("version");
  m.isa = root.text("isa");
  m.host = root.text("host");
  m.core_seconds = root.number("core_seconds");
  m.hits_sha256 = root.text("hits_sha256");
  m.rays_sha256 = root.text("rays_sha256");
  root.finish();
  return m;
}

}  // namespace nullcone
