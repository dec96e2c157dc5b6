#include "apps/cluster/events.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/base/version.h"
#include "core/record/whole_file.h"

namespace nullcone::cluster {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// The task of a scheduler that we are, as "17_4"; empty without one.
std::string job_of_self() {
  const std::string array = variable("SLURM_ARRAY_JOB_ID"), task = variable("SLURM_ARRAY_TASK_ID");
  return array.empty() ? variable("SLURM_JOB_ID") : array + "_" + task;
}

/// Lines that do not fit were torn by a full disk or a crash; they are passed over.
class Reader {
 public:
  Reader(std::vector<Attempt>& out, int round, std::string bundle)
      : out_(out), round_(round), bundle_(std::move(bundle)) {}

  void line(const std::string& text) {
    const json event = json::parse(text, nullptr, false);
    if (!event.is_object()) return;
    try {
      event.at("event") == "begin" ? begin(event) : end(event);
    } catch (const json::exception&) {  // torn
    }
  }

 private:
  void begin(const json& event) {
    Attempt attempt;
    attempt.round = round_, attempt.bundle = bundle_;
    event.at("piece").get_to(attempt.piece), event.at("shards").get_to(attempt.shards);
    event.at("host").get_to(attempt.host), event.at("job").get_to(attempt.job);
    event.at("time").get_to(attempt.begun), event.at("log").get_to(attempt.log_begin);
    open_[attempt.piece] = out_.size();
    out_.push_back(std::move(attempt));
  }
  void end(const json& event) {
    const auto found = open_.find(event.at("piece").get<std::int64_t>());
    if (found == open_.end()) return;
    Attempt attempt = out_[found->second];
    const std::string outcome = event.at("outcome").get<std::string>();
    attempt.outcome = outcome == "done"     ? Outcome::done
                      : outcome == "failed" ? Outcome::failed
                                            : Outcome::interrupted;
    event.at("memory").get_to(attempt.memory), event.at("status").get_to(attempt.status);
    event.at("signal").get_to(attempt.signal), event.at("peak_bytes").get_to(attempt.peak_bytes);
    event.at("seconds").get_to(attempt.seconds), event.at("core_seconds").get_to(attempt.core_seconds);
    event.at("time").get_to(attempt.ended), event.at("log").get_to(attempt.log_end);
    out_[found->second] = std::move(attempt);
    open_.erase(found);
  }

  std::vector<Attempt>& out_;
  int round_;
  std::string bundle_;
  std::map<std::int64_t, std::size_t> open_;
};

void read_events(const Folder& folder, int round, std::vector<Attempt>& out) {
  std::error_code error;
  for (fs::directory_iterator entry(folder.bundle(round, ""), error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().extension() != ".jsonl") continue;
    Reader reader(out, round, entry->path().stem().string());
    std::ifstream in(entry->path());
    for (std::string line; std::getline(in, line);) reader.line(line);
  }
}

}  // namespace

EventLog::EventLog(const Folder& folder, int round, std::string bundle)
    : path_(folder.bundle(round, bundle + ".jsonl")), bundle_(std::move(bundle)), round_(round) {}

void EventLog::begin(Attempt& attempt) const {
  attempt.round = round_, attempt.bundle = bundle_;
  attempt.host = host_name(), attempt.job = job_of_self(), attempt.begun = now();
  append(json{{"event", "begin"},
              {"piece", attempt.piece},
              {"shards", attempt.shards},
              {"host", attempt.host},
              {"job", attempt.job},
              {"time", attempt.begun},
              {"log", attempt.log_begin}}
             .dump());
}

void EventLog::end(Attempt& attempt) const {
  attempt.ended = now();
  const char* outcome = attempt.outcome == Outcome::done     ? "done"
                        : attempt.outcome == Outcome::failed ? "failed"
                                                             : "interrupted";
  append(json{{"event", "end"},
              {"piece", attempt.piece},
              {"outcome", outcome},
              {"memory", attempt.memory},
              {"status", attempt.status},
              {"signal", attempt.signal},
              {"peak_bytes", attempt.peak_bytes},
              {"seconds", attempt.seconds},
              {"core_seconds", attempt.core_seconds},
              {"time", attempt.ended},
              {"log", attempt.log_end}}
             .dump());
}

void EventLog::append(const std::string& line) const {
  const Descriptor file(path_, O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW);
  const std::string text = "\n" + line + "\n";                               // after a torn line, too
  if (file && ::write(file.number(), text.data(), text.size()) < 0) return;  // the dataset itself tells
}

std::vector<Attempt> read_attempts(const Folder& folder, int first_round, int last_round) {
  std::vector<Attempt> out;
  for (int round = first_round; round <= last_round; ++round) read_events(folder, round, out);
  std::ranges::stable_sort(out, {}, [](const Attempt& attempt) {  // clocks of hosts differ, rounds do not
    return std::pair(attempt.round, attempt.begun);
  });
  return out;
}

std::vector<std::string> last_words(const Folder& folder, const Attempt& attempt, std::size_t lines) {
  constexpr std::uint64_t kMost = 8192;
  std::ifstream in(folder.bundle(attempt.round, attempt.bundle + ".log"), std::ios::binary);
  in.seekg(0, std::ios::end);
  const auto size = in ? static_cast<std::uint64_t>(in.tellg()) : 0;
  const std::uint64_t end = attempt.log_end > 0 ? std::min(attempt.log_end, size) : size;
  const std::uint64_t begin = std::max(std::min(attempt.log_begin, end), end - std::min(end, kMost));
  std::string text(end - begin, '\0');
  in.seekg(static_cast<std::streamoff>(begin));
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  std::vector<std::string> out;
  std::istringstream parts(text);
  for (std::string line; std::getline(parts, line);)
    if (!line.empty()) out.push_back(line);
  if (out.size() > lines) out.erase(out.begin(), out.end() - static_cast<std::ptrdiff_t>(lines));
  return out;
}

}  // namespace nullcone::cluster
