// What became of each try to trace a piece, written down by the task that tried; a line of JSON an event.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/cluster/child.h"
#include "apps/cluster/folder.h"

namespace nullcone::cluster {

enum class Outcome { open, done, failed, interrupted };

/// One try of a piece.
struct Attempt {
  std::int64_t piece = 0;
  int shards = 1, round = 0;
  std::string bundle, host, job;    ///< bundle: "7", or "local"
  double begun = 0, ended = 0;      ///< seconds since 1970
  Outcome outcome = Outcome::open;  ///< open: it runs, or its task was killed before it could tell
  bool memory = false;              ///< it failed for want of memory, or may have
  int status = 0, signal = 0;
  std::uint64_t peak_bytes = 0;
  double seconds = 0, core_seconds = 0;
  std::uint64_t log_begin = 0, log_end = 0;  ///< its part of the bundle's log, in bytes
};

/// The events of one bundle. A full disk loses lines, never more: each is appended by one call.
class EventLog {
 public:
  EventLog(const Folder& folder, int round, std::string bundle);
  /// Fills in when, where and by whom.
  void begin(Attempt& attempt) const;
  void end(Attempt& attempt) const;

 private:
  void append(const std::string& line) const;

  std::string path_, bundle_;
  int round_;
};

/// All attempts of a run of rounds, round by round in the order of their beginnings.
std::vector<Attempt> read_attempts(const Folder& folder, int first_round, int last_round);

/// The last lines of what an attempt said, at most so many; empty without a log.
std::vector<std::string> last_words(const Folder& folder, const Attempt& attempt, std::size_t lines);

}  // namespace nullcone::cluster
