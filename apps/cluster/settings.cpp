#include "apps/cluster/settings.h"

#include <nlohmann/json.hpp>

#include "core/base/json.h"

namespace nullcone::cluster {

using nlohmann::json;

namespace {

std::vector<std::string> texts(JsonObject& root, std::string_view key) {
  const json& list = root.at(key);
  if (!list.is_array()) root.refuse(key, "expected a list of texts");
  std::vector<std::string> out;
  for (const json& entry : list) {
    if (!entry.is_string()) root.refuse(key, "expected a list of texts");
    out.push_back(entry.get<std::string>());
  }
  return out;
}

int whole(JsonObject& root, std::string_view key, long least) {
  return static_cast<int>(root.integer(key, least, 1'000'000'000));
}

}  // namespace

json settings_to_json(const Settings& s) {
  return {{"frames", s.frames},
          {"shards", s.shards},
          {"threads", s.threads},
          {"isa", s.isa},
          {"partition", s.partition},
          {"account", s.account},
          {"qos", s.qos},
          {"sbatch", s.sbatch},
          {"launcher", s.launcher},
          {"memory_mb", s.memory_mb},
          {"minutes", s.minutes},
          {"per_task", s.per_task},
          {"max_running", s.max_running},
          {"tries", s.tries},
          {"retry_delay_s", s.retry_delay_s},
          {"trial", s.trial},
          {"pictures", s.pictures},
          {"looks", s.looks},
          {"movie", s.movie},
          {"fps", s.fps}};
}

Settings read_settings(JsonObject root) {
  Settings out;
  out.frames = root.text("frames");
  out.shards = whole(root, "shards", 1);
  out.threads = whole(root, "threads", 1);
  out.isa = root.text("isa");
  out.partition = root.text("partition");
  out.account = root.text("account");
  out.qos = root.text("qos");
  out.sbatch = texts(root, "sbatch");
  out.launcher = root.text("launcher");
  out.memory_mb = whole(root, "memory_mb", -1);
  out.minutes = whole(root, "minutes", -1);
  out.per_task = whole(root, "per_task", 0);
  out.max_running = whole(root, "max_running", 0);
  out.tries = whole(root, "tries", 1);
  out.retry_delay_s = whole(root, "retry_delay_s", 0);
  out.trial = root.word("trial", {"here", "queue", "none"});
  out.pictures = root.boolean("pictures", false);
  out.looks = texts(root, "looks");
  out.movie = root.text("movie");
  out.fps = root.positive("fps");
  root.finish();
  return out;
}

}  // namespace nullcone::cluster
