#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/record/dataset_file.h"

namespace nullcone {

using nlohmann::json;

namespace {
constexpr int kNewestFormat = 1;
}

std::string manifest_to_json(const Manifest& m) {
  json objects = json::array();
  for (const ObjectEntry& object : m.objects)
    objects.push_back({{"name", object.name}, {"tau_origin", object.tau_origin}});
  return json{{"format", m.format},
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
              {"rays_sha256", m.rays_sha256}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
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
