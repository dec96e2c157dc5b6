#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/record/dataset_file.h"

namespace nullcone {

using nlohmann::json;

namespace {

/// The channels; those of light must be what the lamps make them, behind the others.
ChannelSet channels_from(JsonObject& root, const Manifest& m) {
  ChannelSet out = m.channels & ChannelSet::of("light");
  const json& names = root.at("channels");
  if (!names.is_array()) root.refuse("channels", "expected a list of names");
  json light = json::array();
  for (const json& name : names) {
    std::size_t i = 0;
    while (i < kHitChannelInfo.size() && name != std::string(kHitChannelInfo[i].name)) ++i;
    if (i < kHitChannelInfo.size()) {
      out.bits |= 1U << i;
    } else if (!m.lights.empty() && name.is_string() && name.get<std::string>().starts_with("light.")) {
      light.push_back(name);
    } else {
      root.refuse("channels", "names a channel that this program does not know");
    }
    if (!light.empty() && i < kHitChannelInfo.size())
      root.refuse("channels", "expected those of light behind the others");
  }
  if ((kLeastChannels & out) != kLeastChannels) root.refuse("channels", "expected Z, A and id among them");
  if (light != json(channel_names(empty_hits(m, ChannelSet::of("light")))))
    root.refuse("channels", "expected E, shift, t and tau of every lamp and path, in order");
  return out;
}

std::vector<ObjectEntry> entries_from(JsonObject& root, std::string_view key) {
  std::vector<ObjectEntry> out;
  std::set<std::string> names;
  for (JsonObject& entry : root.objects(key)) {
    out.push_back({entry.name("name", names), entry.number("tau_origin")});
    entry.finish();
  }
  return out;
}

json to_json(const std::vector<ObjectEntry>& entries) {
  json out = json::array();
  for (const ObjectEntry& entry : entries)
    out.push_back({{"name", entry.name}, {"tau_origin", entry.tau_origin}});
  return out;
}

/// What format 3 has added; from format 4 on there may be no lamps.
void read_lights(JsonObject& root, Manifest& m) {
  if (m.format < 3) return;
  std::vector<ObjectEntry> lamps = entries_from(root, "lights");
  constexpr std::size_t kMost = 64;  // paths of all lamps
  if ((m.format == 3 && lamps.empty()) || lamps.size() > kMost)
    root.refuse("lights", m.format == 3 ? "expected 1 to 64 lamps" : "expected at most 64 lamps");
  const long paths = lamps.empty() ? root.integer("light_paths", 0, 0)
                                   : root.integer("light_paths", 1, static_cast<long>(kMost / lamps.size()));
  m.set_lights(std::move(lamps), static_cast<int>(paths));
  m.effort.light_doubts =
      static_cast<std::uint64_t>(root.integer("light_doubts", 0, std::numeric_limits<long>::max()));
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
  m.channels = channels_from(root, m);
  m.setting = canonical_json(root.at("setting"));
  m.effort.seconds = root.number("seconds");
}

}  // namespace

std::string manifest_to_json(const Manifest& m) {
  json out = {{"format", m.format},
              {"width", m.width},
              {"height", m.height},
              {"scene", m.scene},
              {"scene_sha256", m.scene_sha256},
              {"metric", m.metric},
              {"objects", to_json(m.objects)},
              {"version", m.version},
              {"isa", m.isa},
              {"host", m.host},
              {"core_seconds", m.effort.core_seconds},
              {"hits_sha256", m.hits_sha256},
              {"rays_sha256", m.rays_sha256}};
  if (m.format > 1)
    out.update(json{{"first_line", m.first_line},
                    {"lines", m.lines},
                    {"traced_lines", m.traced_lines},
                    {"samples", m.samples},
                    {"channels", channel_names(empty_hits(m))},
                    {"setting", m.setting.empty() ? json::object() : json::parse(m.setting)},
                    {"seconds", m.effort.seconds}});
  if (m.format > 2)
    out.update(json{{"lights", to_json(m.lights)},
                    {"light_paths", m.light_paths},
                    {"light_doubts", m.effort.light_doubts}});
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
  read_lights(root, m);
  read_window(root, m);
  m.scene = root.text("scene");
  m.scene_sha256 = root.text("scene_sha256");
  m.metric = root.text("metric");
  m.objects = entries_from(root, "objects");
  m.version = root.text("version");
  m.isa = root.text("isa");
  m.host = root.text("host");
  m.effort.core_seconds = root.number("core_seconds");
  m.hits_sha256 = root.text("hits_sha256");
  m.rays_sha256 = root.text("rays_sha256");
  root.finish();
  return m;
}

}  // namespace nullcone
