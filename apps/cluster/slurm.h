// What Slurm says: which tasks wait, run or are over, and how many can run at once.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/cluster/plan.h"

namespace nullcone::cluster {

/// The jobs of a round, as the script that submitted them wrote down.
struct Jobs {
  struct Array {
    std::string id;
    int first = 0;  ///< its task 0 has this bundle
  };
  std::vector<Array> arrays;
  std::string finish;

  std::vector<std::string> ids() const;
};
/// `path`: "RRR.jobs". None if it is not there.
Jobs read_jobs(const std::string& path);

/// Whether there is a Slurm to be asked from here.
bool has_slurm();

struct Task {
  std::string state;   ///< in Slurm's words
  std::string host;    ///< empty where it never began
  std::string reason;  ///< why it waits

  /// Whether it may still work.
  bool active() const;
  /// "JobHeldUser", "launch failed requeued held": until somebody releases it.
  bool held() const { return active() && reason.find("eld") != std::string::npos; }
};

/// Of a job, by array index; kNoIndex for what is no array, and for those that ended before they began, which
/// Slurm keeps as one. Empty where Slurm has forgotten the job, and where
/// there is no Slurm to ask. Throws WorkError where it does not answer.
inline constexpr int kNoIndex = -1;
std::map<int, Task> tasks_of(const std::string& job);
bool any_active(const std::vector<std::string>& jobs);
/// Of these jobs, the tasks that wait until somebody releases them: "12_3", as scontrol names them.
std::vector<std::string> held_tasks(const std::vector<std::string>& jobs);

/// Whether tasks of the round were cancelled before they began.
bool cancelled_waiting(const Folder& folder, int round);

/// The tasks of a round by their bundles.
std::map<int, Task> tasks_of(const Folder& folder, int round);

/// The pieces that waiting and running tasks have, of all rounds but those that are over; so is `over`, whose
/// last tasks may still be told as completing.
std::vector<std::int64_t> queued_pieces(const Folder& folder, int shards, int over = 0);

/// Tasks that can run at once on the partition; 0 if that is not known.
int slots(const Settings& settings);
/// Of the partition; 0 if that is not known.
struct Nodes {
  int least_cores = 0, most_memory_mb = 0, most_minutes = 0;
};
Nodes nodes_of(const Settings& settings);
/// So many tasks an array may have.
int largest_array();

}  // namespace nullcone::cluster
