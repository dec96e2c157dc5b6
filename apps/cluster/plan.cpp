#include "apps/cluster/plan.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "core/base/error.h"
#include "core/base/frame_numbers.h"
#include "core/base/json.h"

namespace nullcone::cluster {

using nlohmann::json;

namespace {

constexpr double kBundle_s = 300,
                 kMostTurns = 8;        // little is lost with a task, and nobody idles for long in the end
constexpr double kDispatch_per_s = 30;  // tasks that a scheduler starts; docs/cluster.md
constexpr double kTimeMargin = 3, kMemoryMargin = 1.25;
constexpr int kLeastMinutes = 5, kMemoryRest_mb = 64;

/// Of what runs_of() writes.
std::vector<std::int64_t> read_runs(const std::string& text, const JsonObject& root) {
  constexpr std::int64_t kMost = 100'000'000;
  std::vector<std::int64_t> out;
  std::istringstream runs(text);
  for (std::string run; std::getline(runs, run, ',');) {
    std::istringstream numbers(run);
    std::int64_t first = -1, last = -1;
    char dash = 0, more = 0;
    if (numbers >> first) last = first;
    if (numbers >> dash && (dash != '-' || !(numbers >> last))) last = -1;
    if (first < 0 || last < first || last - first > kMost || numbers >> more ||
        (!out.empty() && first <= out.back()))
      root.refuse("pieces", "expected ascending runs such as 0-3,7");
    for (std::int64_t i = first; i <= last; ++i) out.push_back(i);
  }
  return out;
}

int bundles_for(std::size_t pieces, const Settings& settings, const Cost& cost, int slots) {
  const auto count = static_cast<double>(pieces);
  if (settings.per_task > 0) return static_cast<int>(std::ceil(count / settings.per_task));
  if (!cost.known()) return static_cast<int>(pieces);
  const double work = count * cost.seconds;
  // n tasks are started in n / rate and last work / n, which together is least here.
  double out = std::sqrt(work * kDispatch_per_s);
  if (slots > 0 && out > slots) {  // all are at work: then in turns, but no faster than tasks are started
    const double each = std::max(kBundle_s, slots / kDispatch_per_s);
    out = slots * std::clamp(std::floor(work / each / slots), 1.0, kMostTurns);
  }
  return static_cast<int>(std::clamp(std::floor(out), 1.0, count));
}

int memory_of(std::uint64_t peak_bytes, double margin) {
  return kMemoryRest_mb + static_cast<int>(std::ceil(margin * static_cast<double>(peak_bytes) / (1 << 20)));
}

int memory_for(const Settings& settings, const Cost& cost, const Capacity& capacity, const Round* before,
               const Needs& needs) {
  if (settings.memory_mb == 0) return 0;
  int out = std::max(settings.memory_mb, 0);
  if (out == 0 && cost.peak_bytes > 0) out = memory_of(cost.peak_bytes, kMemoryMargin);
  if (before != nullptr) out = std::max(out, before->memory_mb);
  if (before != nullptr && needs.memory)
    out = std::max({out, 2 * before->memory_mb, memory_of(needs.peak_bytes, 2)});
  return capacity.memory_mb > 0 ? std::min(out, std::max(capacity.memory_mb, settings.memory_mb)) : out;
}

int minutes_for(const Round& round, const Capacity& capacity, const Round* before, const Needs& needs) {
  if (round.settings.minutes >= 0) return round.settings.minutes;
  if (round.piece_s == 0) return 0;
  const double pieces = std::ceil(static_cast<double>(round.pieces.size()) / round.bundles);
  int out = kLeastMinutes + static_cast<int>(std::ceil(kTimeMargin * pieces * round.piece_s / 60));
  if (before != nullptr && needs.time) out = std::max(out, 2 * before->minutes);
  return capacity.minutes > 0 ? std::min(out, capacity.minutes) : out;
}

}  // namespace

Cost measured_cost(const std::vector<Attempt>& attempts, int shards) {
  Cost out;
  std::map<std::int64_t, double> seconds;
  for (const Attempt& attempt : attempts) {
    if (attempt.shards != shards) continue;
    double& all = seconds[attempt.piece] += attempt.seconds;
    if (attempt.outcome != Outcome::done) continue;
    out.seconds = std::max(out.seconds, std::exchange(all, 0));
    out.peak_bytes = std::max(out.peak_bytes, attempt.peak_bytes);
  }
  return out;
}

std::vector<std::int64_t> Round::bundle(int which) const {
  std::vector<std::int64_t> out;
  if (bundles < 1) return out;
  for (auto i = static_cast<std::size_t>(which); i < pieces.size(); i += static_cast<std::size_t>(bundles))
    out.push_back(pieces[i]);
  return out;
}

bool same_request(const Round& a, const Round& b) {
  return a.scene_sha256 == b.scene_sha256 && settings_to_json(a.settings) == settings_to_json(b.settings);
}

std::string round_to_json(const Round& round) {
  return json{{"round", round.number},
              {"chain", round.chain},
              {"settings", settings_to_json(round.settings)},
              {"scene_sha256", round.scene_sha256},
              {"pieces", runs_of(round.pieces)},
              {"bundles", round.bundles},
              {"memory_mb", round.memory_mb},
              {"minutes", round.minutes},
              {"piece_s", round.piece_s},
              {"delay_s", round.delay_s},
              {"trial", round.trial},
              {"begun", round.begun},
              {"progress", round.progress}}
             .dump(2, ' ', false, json::error_handler_t::replace) +
         "\n";
}

Round read_round(const Folder& folder, int number) {
  const std::string path = folder.round(number, "plan.json");
  const json document = parse_json_file(path);
  JsonObject root(document, path, "");
  constexpr long kMost = 1'000'000'000;
  Round out;
  out.number = static_cast<int>(root.integer("round", 1, kMost));
  out.chain = static_cast<int>(root.integer("chain", 1, out.number));
  out.settings = read_settings(root.object("settings"));
  out.scene_sha256 = root.text("scene_sha256");
  out.pieces = read_runs(root.text("pieces"), root);
  out.bundles = static_cast<int>(root.integer("bundles", 0, kMost));
  out.memory_mb = static_cast<int>(root.integer("memory_mb", 0, kMost));
  out.minutes = static_cast<int>(root.integer("minutes", 0, kMost));
  out.piece_s = root.number("piece_s");
  out.delay_s = static_cast<int>(root.integer("delay_s", 0, kMost));
  out.trial = root.boolean("trial", false);
  out.begun = root.number("begun");
  out.progress = root.number("progress");
  root.finish();
  return out;
}

void size_round(Round& round, const Cost& cost, const Capacity& capacity, const Round* before,
                const Needs& needs) {
  round.bundles = bundles_for(round.pieces.size(), round.settings, cost, capacity.slots);
  round.piece_s = cost.seconds;
  round.memory_mb = memory_for(round.settings, cost, capacity, before, needs);
  round.minutes = minutes_for(round, capacity, before, needs);
}

}  // namespace nullcone::cluster
