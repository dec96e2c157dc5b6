// Tracing the pieces of a bundle, one nullcone-trace after the other; what a task of an array does.
#pragma once

#include "apps/cluster/plan.h"

namespace nullcone::cluster {

/// The command that traces a piece.
std::vector<std::string> trace_command(const Folder& folder, const Settings& settings, std::int64_t piece);

/// One try of a piece; what it says goes into the file of `log`, which is open for appending. `stop`: as of
/// run_child().
Attempt trace_piece(const Folder& folder, const Settings& settings, std::int64_t piece,
                    const EventLog& events, int log, const std::function<bool()>& stop);

/// A bundle of a round; what is said goes into its log. The exit status: 0 when all its pieces are there, 1
/// when some failed, 3 when it was stopped.
int trace_bundle(const Folder& folder, int round, int bundle);

}  // namespace nullcone::cluster
