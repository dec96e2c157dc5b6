#include "apps/cluster/slurm.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <thread>

#include "core/base/error.h"

namespace nullcone::cluster {

std::vector<std::string> Jobs::ids() const {
  std::vector<std::string> out;
  for (const Array& array : arrays) out.push_back(array.id);
  if (!finish.empty()) out.push_back(finish);
  return out;
}

Jobs read_jobs(const std::string& path) {
  Jobs out;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string kind, id;
    int first = 0;
    words >> kind >> id >> first;
    if (id.empty() || id.find_first_not_of("0123456789") != id.npos) continue;
    if (kind == "array") out.arrays.push_back({id, first});
    if (kind == "finish") out.finish = id;
  }
  return out;
}

bool has_slurm() {
  static const bool found = [] {
    for (const char* hides :
         {"SQUEUE_PARTITION", "SQUEUE_USERS", "SQUEUE_ACCOUNT", "SQUEUE_QOS", "SQUEUE_NAMES",
          "SQUEUE_LICENSES", "SQUEUE_STATES", "SQUEUE_SORT", "SINFO_PARTITION", "SINFO_SORT"})
      ::unsetenv(hides);
    return on_path("sbatch") && on_path("squeue");
  }();
  return found;
}

namespace {

/// States in which a task is over, and those in which it is not.
const std::set<std::string> kOver = {"COMPLETED", "CANCELLED", "FAILED",    "TIMEOUT", "NODE_FAIL",
                                     "PREEMPTED", "DEADLINE",  "BOOT_FAIL", "REVOKED", "OUT_OF_MEMORY"};
const std::set<std::string> kActive = {
    "PENDING",      "RUNNING", "SUSPENDED", "COMPLETING",  "CONFIGURING",   "REQUEUED", "REQUEUE_HOLD",
    "SPECIAL_EXIT", "STOPPED", "SIGNALING", "REQUEUE_FED", "RESV_DEL_HOLD", "RESIZING", "STAGE_OUT"};

/// A scheduler that is restarted or busy says nothing for a while.
Captured ask(const std::vector<std::string>& words) {
  constexpr int kTimes = 3;
  for (int i = 1;; ++i) {
    Captured said = capture(words);
    if (said.end.good() || said.complaints.find("Invalid job id") != std::string::npos || i == kTimes)
      return said;
    std::this_thread::sleep_for(std::chrono::seconds(2 * i));
  }
}

}  // namespace

bool Task::active() const { return kActive.contains(state); }

std::map<int, Task> tasks_of(const std::string& job) {
  if (!has_slurm()) return {};
  const Captured said = ask(
      {"squeue", "--noheader", "--all", "--array", "--states=all", "--jobs=" + job, "--format=%K|%T|%N|%r"});
  if (!said.end.good()) {
    if (said.complaints.find("Invalid job id") != std::string::npos) return {};
    throw WorkError("squeue",
                    "does not answer: " + printable(said.complaints.substr(0, said.complaints.find('\n'))));
  }
  std::map<int, Task> out;
  std::istringstream lines(said.output);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string index;
    Task task;
    std::getline(words, index, '|'), std::getline(words, task.state, '|');
    std::getline(words, task.host, '|'), std::getline(words, task.reason);
    if (!kOver.contains(task.state) && !task.active()) continue;  // a line that is none of squeue's
    const bool in_array = !index.empty() && index.find_first_not_of("0123456789") == index.npos;
    out[in_array ? std::atoi(index.c_str()) : kNoIndex] = std::move(task);
  }
  return out;
}

bool any_active(const std::vector<std::string>& jobs) {
  return std::ranges::any_of(jobs, [](const std::string& job) {
    return std::ranges::any_of(tasks_of(job), [](const auto& entry) { return entry.second.active(); });
  });
}

std::vector<std::string> held_tasks(const std::vector<std::string>& jobs) {
  std::vector<std::string> out;
  for (const std::string& job : jobs)
    for (const auto& [index, task] : tasks_of(job))
      if (task.held()) out.push_back(index == kNoIndex ? job : job + "_" + std::to_string(index));
  return out;
}

std::map<int, Task> tasks_of(const Folder& folder, int round) {
  std::map<int, Task> out;
  for (const Jobs::Array& array : read_jobs(folder.round(round, "jobs")).arrays)
    for (const auto& [index, task] : tasks_of(array.id))
      if (index != kNoIndex) out[array.first + index] = task;
  return out;
}

bool cancelled_waiting(const Folder& folder, int round) {
  const auto waited = [](const auto& entry) {
    return entry.second.state == "CANCELLED" && entry.second.host.empty();
  };
  return std::ranges::any_of(read_jobs(folder.round(round, "jobs")).arrays, [&](const Jobs::Array& array) {
    return std::ranges::any_of(tasks_of(array.id), waited);
  });
}

std::vector<std::int64_t> queued_pieces(const Folder& folder, int shards, int over) {
  std::set<std::int64_t> out;
  for (int number = 1; number <= folder.last_round(); ++number) {
    if (number == over || std::filesystem::exists(folder.round(number, "over"))) continue;
    const std::map<int, Task> tasks = tasks_of(folder, number);
    if (std::ranges::none_of(tasks, [](const auto& entry) { return entry.second.active(); })) continue;
    const Round round = read_round(folder, number);
    for (const auto& [bundle, task] : tasks) {
      if (!task.active()) continue;
      for (const std::int64_t piece : round.bundle(bundle)) {
        if (round.settings.shards == shards) out.insert(piece);
        // Cut otherwise: all of the frame counts.
        const std::int64_t frame = piece / round.settings.shards;
        for (int i = 0; round.settings.shards != shards && i < shards; ++i) out.insert(frame * shards + i);
      }
    }
  }
  return {out.begin(), out.end()};
}

namespace {

/// The partitions that jobs may go to; empty for the site's default.
std::set<std::string> partitions_of(const Settings& settings) {
  std::string names = settings.partition;
  const char* usual = std::getenv("SBATCH_PARTITION");
  if (names.empty() && usual != nullptr) names = usual;
  for (const std::string& option : settings.sbatch)
    if (option.starts_with("--partition=")) names = option.substr(option.find('=') + 1);
  std::set<std::string> out;
  std::istringstream in(names);
  for (std::string name; std::getline(in, name, ',');) out.insert(name);
  return out;
}

/// What sinfo tells of them, a line each; of each node, where asked so.
std::vector<std::string> of_partitions(const Settings& settings, const std::string& format, bool nodes) {
  if (!has_slurm()) return {};
  std::vector<std::string> words = {"sinfo", "--noheader", "--all", "--format=%P|" + format};
  if (nodes) words.emplace_back("--Node");
  const Captured said = ask(words);
  const std::set<std::string> wanted = partitions_of(settings);
  std::vector<std::string> out;
  std::istringstream lines(said.output);
  for (std::string line; said.end.good() && std::getline(lines, line);) {
    const std::size_t bar = line.find('|');
    if (bar == line.npos || bar == 0) continue;
    const bool usual = line[bar - 1] == '*';
    if (wanted.empty() ? usual : wanted.contains(line.substr(0, bar - (usual ? 1 : 0))))
      out.push_back(line.substr(bar + 1));
  }
  return out;
}

/// Minutes of "infinite", "1-00:00:00", "2:00:00", "30:00" or "30"; 0 for no limit.
int minutes_of(const std::string& limit) {
  int days = 0, hours = 0, minutes = 0;
  if (std::sscanf(limit.c_str(), "%d-%d:%d", &days, &hours, &minutes) >= 2)
    return 1440 * days + 60 * hours + minutes;
  if (std::ranges::count(limit, ':') == 2)
    return std::sscanf(limit.c_str(), "%d:%d", &hours, &minutes) == 2 ? 60 * hours + minutes : 0;
  return std::sscanf(limit.c_str(), "%d", &minutes) == 1 ? minutes : 0;
}

}  // namespace

int slots(const Settings& settings) {
  int all = 0;
  for (const std::string& cores : of_partitions(settings, "%C", false)) {
    int allocated = 0, idle = 0;  // of allocated/idle/other/total
    if (std::sscanf(cores.c_str(), "%d/%d/", &allocated, &idle) == 2) all += allocated + idle;
  }
  const int out = all / std::max(settings.threads, 1);
  return settings.max_running > 0 ? std::min(out, settings.max_running) : out;
}

Nodes nodes_of(const Settings& settings) {
  Nodes out;
  for (const std::string& node : of_partitions(settings, "%c/%m", true)) {
    int cores = 0, memory_mb = 0;
    if (std::sscanf(node.c_str(), "%d/%d", &cores, &memory_mb) != 2) continue;
    out.least_cores = out.least_cores == 0 ? cores : std::min(out.least_cores, cores);
    if (memory_mb > 1) out.most_memory_mb = std::max(out.most_memory_mb, memory_mb);  // 1: not configured
  }
  for (const std::string& limit : of_partitions(settings, "%l", false))
    if (const int minutes = minutes_of(limit); minutes > 0)
      out.most_minutes = out.most_minutes == 0 ? minutes : std::min(out.most_minutes, minutes);
  return out;
}

int largest_array() {
  constexpr int kUsual = 1001;  // Slurm's own default
  if (!has_slurm()) return kUsual;
  const auto [end, text, complaints] = ask({"scontrol", "show", "config"});
  const std::size_t at = text.find("MaxArraySize"), number = text.find_first_of("0123456789", at);
  const int found = end.good() && at != text.npos && number != text.npos ? std::atoi(&text[number]) : kUsual;
  return std::max(found, 1);
}

}  // namespace nullcone::cluster
