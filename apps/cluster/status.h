// How far a sequence is: from the headers of its datasets, what its tasks wrote down, and the scheduler.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "apps/cluster/folder.h"

namespace nullcone::cluster {

struct HostStatus {
  std::string isa;  ///< of its last frame
  int frames = 0;
  double core_seconds = 0, most = 0;  ///< of all its frames, and of the slowest
};

struct SlowFrame {
  int frame = 0;
  double core_seconds = 0;
  std::string host;
};

struct Status {
  int frames = 0;  ///< that are asked for
  int done = 0;    ///< by their headers
  int running = 0, waiting = 0;
  int failed = 0;           ///< that were given up
  int pictures = -1;        ///< that are there and new; -1 where none are asked for
  int tries_failed = 0;     ///< in the last chain of rounds
  int round = 0;            ///< the last
  bool working = false;     ///< somebody traces, waits or plans
  double core_seconds = 0;  ///< of the frames that are done
  double per_minute = 0;    ///< frames; 0 if not known
  double left_s = 0;        ///< at that rate
  std::vector<SlowFrame> slowest;
  std::vector<std::string> held;  ///< tasks that wait for `scontrol release`
  std::map<std::string, HostStatus> hosts;
};

/// Throws InputError where there is no sequence.
Status status_of(const Folder& folder);

std::string status_text(const Folder& folder, const Status& status);
std::string status_json(const Status& status);

/// Prints the status; with seconds, again and again until nobody works any more. Exit status 0; 1 if that
/// leaves frames missing.
int show_status(const Folder& folder, double every_s, bool json);

}  // namespace nullcone::cluster
