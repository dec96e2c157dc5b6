// What became of the pieces of a chain of rounds.
#pragma once

#include <map>

#include "apps/cluster/plan.h"

namespace nullcone::cluster {

/// All tries at this scene, of whatever round.
std::vector<Attempt> attempts_at(const Folder& folder, const std::string& scene_sha256);

/// The tries of a chain up to one of its rounds, whose tasks are over. A try without an end was killed with
/// its task. The pieces of a task that never said anything count as tried once.
class History {
 public:
  History(const Folder& folder, const std::vector<Attempt>& attempts, const Round& round);

  int failures(std::int64_t piece) const;
  /// Of a piece that has failures.
  const Attempt& last(std::int64_t piece) const { return last_.at(piece); }
  /// How these pieces ended in the last round.
  std::vector<Attempt> last_round(const std::vector<std::int64_t>& pieces) const;
  /// Whether tasks of the last round were told to end when half of their time or more was over.
  bool out_of_time() const { return out_of_time_; }

 private:
  void add(Attempt attempt);
  void add_silent_tasks(const Folder& folder, const Round& round);

  int number_;
  bool out_of_time_ = false;
  std::map<std::int64_t, Attempt> last_;
  std::map<std::int64_t, int> failures_;
};

}  // namespace nullcone::cluster
