// nullcone-trace over the frames of a sequence: what is finished stays, and the rest is traced or listed.
#pragma once

#include "apps/trace_options.h"

namespace nullcone {

/// Traces the frames that are asked for and not finished yet. The exit status: 3 when it was stopped.
int trace_frames(const TraceOptions& options);

/// Prints the frames (with shards: the tasks, frame times shards plus shard from 0) that are not finished, as
/// a list of runs; traces nothing.
int print_missing(const TraceOptions& options);

}  // namespace nullcone
