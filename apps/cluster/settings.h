// What a user asks of nullcone-submit, kept beside the work for the steps that come later.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/base/json.h"

namespace nullcone::cluster {

struct Settings {
  // What is traced.
  std::string frames;  ///< a list; empty: all of the sequence
  int shards = 1;      ///< pieces a frame
  int threads = 1;     ///< of a task
  std::string isa;     ///< of the kernel; empty: the best of each host

  // What is asked of the scheduler.
  std::string partition, account, qos;
  std::vector<std::string> sbatch;   ///< further options, as they are
  std::string launcher;              ///< shell words before our tools, as of a container
  int memory_mb = -1, minutes = -1;  ///< of a task; -1: as measured, 0: not asked for
  int per_task = 0;                  ///< pieces; 0: as measured
  int max_running = 0;               ///< tasks at once; 0: as many as the scheduler likes
  int tries = 3;                     ///< of a piece that fails
  int retry_delay_s = 30;            ///< before a failed piece is tried again
  std::string trial = "here";        ///< where a piece is measured: here, queue, none

  // What is made of the datasets.
  bool pictures = false;
  std::vector<std::string> looks;  ///< none: the scene's own
  std::string movie;               ///< empty: none
  double fps = 25;
};

nlohmann::json settings_to_json(const Settings& settings);
/// Throws InputError.
Settings read_settings(JsonObject root);

}  // namespace nullcone::cluster
