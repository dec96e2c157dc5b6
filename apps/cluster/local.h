// The rounds of a sequence on one machine, without a scheduler.
#pragma once

#include "apps/cluster/rounds.h"

namespace nullcone::cluster {

/// Does rounds until all is there or nothing more is tried; then the pictures. `round` says what is asked
/// for. `jobs`: processes at once. The exit status.
int work_locally(const Folder& folder, const TraceFrames& frames, Round round, int jobs, bool quiet);

}  // namespace nullcone::cluster
