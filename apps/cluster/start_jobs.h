// Rounds and pictures as jobs of Slurm.
#pragma once

#include <string>

#include "apps/cluster/lock.h"
#include "apps/cluster/rounds.h"

namespace nullcone::cluster {

struct Submitting {
  const SubmissionLock& lock;
  bool scripts_only = false;  ///< somebody else runs the scripts that submit
  std::string next = {};      ///< a file in which such a script is named for the shell that called us
};

/// Writes the round's plan and scripts, and submits it. A round without pieces only comes back when the jobs
/// of other rounds are over. Throws WorkError.
void start_round(const Folder& folder, const TraceFrames& frames, const Round& round, const Submitting& how);

/// The pictures that are asked for, unless they are there. Throws WorkError.
void start_pictures(const Folder& folder, const TraceFrames& frames, const Settings& settings,
                    const Submitting& how);

/// Scripts as they would be written for the round.
void print_scripts(const Folder& folder, const TraceFrames& frames, const Round& round);

/// Cancels all jobs of the folder that wait or run; no round up to now is followed by another. Throws
/// InputError and WorkError.
int cancel(const Folder& folder);
/// Whether that was done after the round was planned.
bool is_cancelled(const Folder& folder, int round);

}  // namespace nullcone::cluster
