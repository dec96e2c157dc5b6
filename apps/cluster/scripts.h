// The shell scripts of a round: what a task of the array does, what comes after it, and how both are
// submitted.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "apps/cluster/plan.h"

namespace nullcone::cluster {

/// Names and texts; nothing is written yet.
using Scripts = std::vector<std::pair<std::string, std::string>>;

/// What the site has, and the sequence.
struct Site {
  int largest_array = 1001;
  int finish_threads = 1;                ///< of the step that reads all datasets
  int most_minutes = 0;                  ///< that a job may ask for; 0 if nobody knows
  int frames = 1;                        ///< in all
  std::vector<std::string> others = {};  ///< jobs for which the finish step waits, too
};

/// array.sh, finish.sh and submit.sh. The last calls sbatch and writes RRR.jobs; it needs nothing but a shell
/// and Slurm.
Scripts round_scripts(const Folder& folder, const Round& round, const Site& site);

/// pictures.sh, movie.sh and pictures.submit.sh for these frames, in so many tasks.
Scripts picture_scripts(const Folder& folder, const Settings& settings, const std::vector<int>& frames,
                        int tasks);

/// Writes them. Throws WorkError.
void write_scripts(const Scripts& scripts);

}  // namespace nullcone::cluster
