// What is there of a sequence, what is missing, and what shall be done about that.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/cluster/plan.h"
#include "apps/trace_frames.h"

namespace nullcone::cluster {

/// The state of the datasets, all of them read.
struct Survey {
  std::vector<std::int64_t> missing;  ///< pieces
  double progress = 0;                ///< pieces that are there, parts of them too
};
/// Nothing when we are stopped.
std::optional<Survey> survey(const TraceFrames& frames, int shards, int threads);

/// Merges the shards of frames that have all of them, and removes these then. Complaints go to standard
/// error.
void merge_shards(const TraceFrames& frames, int shards, int threads);

/// What others do, or want.
struct Others {
  std::vector<std::int64_t> queued = {};  ///< pieces of tasks that wait or run, ascending
  Capacity capacity = {};
  bool cancelled = false;  ///< tasks were cancelled before they began
  int threads = 1;         ///< that we may take to read datasets
};

struct Verdict {
  enum class Next {
    complete,     ///< all frames are there
    again,        ///< `round` shall be done
    wait,         ///< what is missing is in other rounds, which are not over
    end,          ///< nothing more is tried
    interrupted,  ///< we were stopped
  };
  Next next = Next::complete;
  Round round = {};
  std::vector<Attempt> given_up = {};  ///< the last attempts of pieces that failed as often as may be
  bool more_memory = false;            ///< some of `round` may have failed for want of it
  std::string why = {};                ///< of an end
};

/// What comes after a round; or first of all, after one of the next number without pieces, which says what is
/// asked for.
Verdict judge(const Folder& folder, const TraceFrames& frames, const Round& before, const Others& others);

/// Writes cluster/failed.txt: what was given up, with its last words and the command that reproduces it.
/// Returns the text.
std::string report(const Folder& folder, const Settings& settings, const std::vector<Attempt>& given_up);

}  // namespace nullcone::cluster
