// From a scene that is read to one dataset.
#pragma once

#include <optional>
#include <string>

#include "apps/trace_job.h"
#include "apps/trace_options.h"

namespace nullcone {

/// What becomes of the partial file of an interrupted run.
enum class Resume {
  no,          ///< it stays as it is, or is replaced
  if_it_fits,  ///< one of another scene or version, or a damaged one, is left aside with a note
  must_fit     ///< such a one throws InputError
};

struct TraceRun {
  bool whole = false;    ///< else a partial file is there, since `stop_wanted`
  int traced_lines = 0;  ///< of the window
  int lines = 0;         ///< the window
  Effort effort;         ///< of this run alone
};

/// Traces the scene, or a shard of it, into `output`. `place` stands before complaints; `note` is told of
/// doubts. Throws InputError and WorkError.
TraceRun trace_to(const std::string& output, Scene scene, const std::string& place,
                  const std::optional<Shard>& shard, Resume resume, const TraceOptions& options,
                  const Note& note);

}  // namespace nullcone
