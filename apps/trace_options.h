// What nullcone-trace is asked for.
#pragma once

#include <string>

#include "apps/tool.h"

namespace nullcone {

struct TraceOptions {
  ToolOptions common;
  std::string scene, from, output, isa, shard;
  bool resume = false;
  // Sequences.
  bool sequence = false;  ///< whether frames are asked for
  int frame = 0;          ///< the only one, without `frames`
  std::string frames;
  bool overwrite = false;
  bool missing = false;
  int shards = 0;  ///< of --missing; 0: whole frames
};

}  // namespace nullcone
