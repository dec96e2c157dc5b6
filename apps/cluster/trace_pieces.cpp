#include "apps/cluster/trace_pieces.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <cstdio>

#include "apps/stop_signals.h"
#include "core/base/error.h"
#include "core/record/whole_file.h"

namespace nullcone::cluster {

namespace {

std::uint64_t size_of(int file) {
  struct stat status {};
  return ::fstat(file, &status) == 0 && S_ISREG(status.st_mode) ? static_cast<std::uint64_t>(status.st_size)
                                                                : 0;
}

/// Whether the kernel may have ended it for want of memory, or it said so itself.
bool wants_memory(const Folder& folder, const Attempt& attempt) {
  if (attempt.signal == SIGKILL) return true;
  for (const std::string& line : last_words(folder, attempt, 3))
    if (line.find("out of memory") != line.npos || line.find("of memory, but only") != line.npos) return true;
  return false;
}

}  // namespace

std::vector<std::string> trace_command(const Folder& folder, const Settings& settings, std::int64_t piece) {
  const auto [frame, shard] = piece_of(piece, settings.shards);
  std::vector<std::string> out = {program_folder() + "/nullcone-trace", folder.scene()};
  const auto add = [&](const char* option, const std::string& value) {
    out.emplace_back(option);
    out.push_back(value);
  };
  add("--frame", std::to_string(frame));
  if (settings.shards > 1) add("--shard", std::to_string(shard) + "/" + std::to_string(settings.shards));
  if (!settings.isa.empty()) add("--isa", settings.isa);
  add("--threads", std::to_string(settings.threads));
  add("-o", folder.data());
  return out;
}

Attempt trace_piece(const Folder& folder, const Settings& settings, std::int64_t piece,
                    const EventLog& events, int log, const std::function<bool()>& stop) {
  Attempt attempt;
  attempt.piece = piece, attempt.shards = settings.shards, attempt.log_begin = size_of(log);
  events.begin(attempt);
  std::vector<std::string> command = trace_command(folder, settings, piece);
  command.emplace_back("--quiet");
  const ChildEnd end = run_child(command, {log, log}, stop);
  constexpr int kInterrupted = 3;
  attempt.status = end.status, attempt.signal = end.signal, attempt.peak_bytes = end.peak_bytes;
  attempt.seconds = end.seconds, attempt.core_seconds = end.core_seconds;
  attempt.outcome = end.good() ? Outcome::done
                    : end.stopped || end.status == kInterrupted || end.signal == SIGTERM
                        ? Outcome::interrupted
                        : Outcome::failed;
  attempt.log_end = size_of(log);
  attempt.memory = attempt.outcome == Outcome::failed && wants_memory(folder, attempt);
  events.end(attempt);
  return attempt;
}

int trace_bundle(const Folder& folder, int number, int bundle) {
  catch_stop_signals();
  const Round round = read_round(folder, number);
  if (bundle < 0 || bundle >= round.bundles)
    throw InputError("--bundle", "there is no bundle " + std::to_string(bundle) + "; expected 0 to " +
                                     std::to_string(round.bundles - 1));
  const EventLog events(folder, number, std::to_string(bundle));
  const std::string name = folder.bundle(number, std::to_string(bundle) + ".log");
  const Descriptor log(name, O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW);
  if (!log) throw WorkError(name, "cannot write there");
  bool all = true;
  for (const std::int64_t piece : round.bundle(bundle)) {
    if (stop_wanted) return 3;
    const Attempt attempt =
        trace_piece(folder, round.settings, piece, events, log.number(), [] { return stop_wanted.load(); });
    all = all && attempt.outcome == Outcome::done;
  }
  if (stop_wanted) return 3;
  return all ? 0 : 1;
}

}  // namespace nullcone::cluster
