// One planner at a time in a folder, on any host.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "apps/cluster/folder.h"

namespace nullcone::cluster {

/// Held from construction to destruction as the file cluster/lock, which is made by link(2), atomic on
/// network file systems too. It says who holds it, and its time is renewed while he lives. A lock is stale,
/// and taken over, when its process is known to be dead (on this host), or its time is old (on others).
class SubmissionLock {
 public:
  /// Waits so long for another holder. Throws WorkError, which says who that is.
  SubmissionLock(const Folder& folder, double patience_s);
  ~SubmissionLock();
  SubmissionLock(const SubmissionLock&) = delete;
  SubmissionLock& operator=(const SubmissionLock&) = delete;

  /// False when it was taken over by somebody who held us for dead.
  bool held() const;

 private:
  void renew();

  std::string path_;
  std::mutex mutex_;
  std::condition_variable end_;
  bool ending_ = false;
  std::thread renewal_;
};

/// Whether somebody who lives holds it.
bool is_locked(const Folder& folder);

}  // namespace nullcone::cluster
