// From a scene to jobs: the plan is what is missing in the folder, and asking again plans only what is
// missing then.
#pragma once

#include "apps/cluster/rounds.h"

namespace nullcone::cluster {

struct SubmitOptions {
  std::string scene, output;
  Settings settings;
  bool replace = false;       ///< frames of another scene may be there
  bool dry_run = false;       ///< only print the scripts
  bool scripts_only = false;  ///< write them, for somebody else to submit
  bool local = false;         ///< no scheduler
  int jobs = 0;               ///< processes at once, without a scheduler; 0: one a core
  bool quiet = false;
};

/// Submits what is missing; without a scheduler, does it. The exit status.
int submit(const SubmitOptions& options);

/// The step after a round: merges, verifies, and submits what is missing still, or the pictures. What cannot
/// be done is tried again for some minutes.
int finish_round(const Folder& folder, int round, int threads);

}  // namespace nullcone::cluster
