// A round of work: which pieces, in which bundles, with how much memory and time.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/cluster/events.h"
#include "apps/cluster/folder.h"
#include "apps/cluster/settings.h"

namespace nullcone::cluster {

/// A piece is a frame, or a shard of one: number = frame * shards + (shard - 1).
struct Piece {
  int frame = 0, shard = 1;
};
inline Piece piece_of(std::int64_t number, int shards) {
  return {static_cast<int>(number / shards), static_cast<int>(number % shards) + 1};
}

/// What one piece takes, measured.
struct Cost {
  double seconds = 0;            ///< of a task
  std::uint64_t peak_bytes = 0;  ///< of memory
  bool known() const { return seconds > 0; }
};
/// The most of what finished pieces took, in all the tries that they took.
Cost measured_cost(const std::vector<Attempt>& attempts, int shards);

/// One array of tasks and the step that comes after it.
struct Round {
  int number = 1;
  int chain = 1;  ///< the round in which its user asked for it; what came before is forgiven
  Settings settings;
  std::string scene_sha256;          ///< of the sequence without its look
  std::vector<std::int64_t> pieces;  ///< ascending
  int bundles = 1;  ///< bundle k has the pieces k, k + bundles, ...: so all take as long; 0: no tasks
  int memory_mb = 0, minutes = 0;  ///< of a task; 0: not asked for
  double piece_s = 0;              ///< what a piece takes; 0: not known
  int delay_s = 0;                 ///< before it begins
  bool trial = false;              ///< one piece, to measure it
  double begun = 0;                ///< seconds since 1970
  double progress = 0;             ///< pieces that were there then, parts of them too

  std::vector<std::int64_t> bundle(int number) const;
};

/// Whether two rounds were asked for in the same words.
bool same_request(const Round& a, const Round& b);

std::string round_to_json(const Round& round);
/// Throws InputError.
Round read_round(const Folder& folder, int number);

/// What can be had; 0 if nobody knows.
struct Capacity {
  int slots = 0;      ///< tasks that can run at once
  int memory_mb = 0;  ///< of one
  int minutes = 0;
};

/// What the round before has taught.
struct Needs {
  bool memory = false;           ///< pieces may have failed for want of it
  std::uint64_t peak_bytes = 0;  ///< of these
  bool time = false;             ///< tasks had to end before they were done
};

/// Bundles, memory and time for the pieces.
/// `before`: the last round of the chain, if there is one.
void size_round(Round& round, const Cost& cost, const Capacity& capacity, const Round* before,
                const Needs& needs);

}  // namespace nullcone::cluster
