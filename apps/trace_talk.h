// What nullcone-trace says on standard error while it works.
#pragma once

#include <atomic>
#include <chrono>
#include <string>

#include "core/record/dataset.h"
#include "core/trace/trace_scene.h"

namespace nullcone {

/// Of one dataset. Rate and time left about five times a second.
class TraceTalk {
 public:
  explicit TraceTalk(bool quiet) : quiet_(quiet) {}

  Progress progress();
  Note notes() const;
  void resumed(const std::string& path, int lines) const;
  void summary(const Manifest& manifest, std::size_t hits, const std::string& path) const;
  double seconds() const;

 private:
  bool quiet_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::atomic<double> last_ = 0;
};

}  // namespace nullcone
