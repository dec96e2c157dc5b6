// Memory of raw pictures that were sent, for those to come: new pages from the system cost 1.5 ms a picture
// of 1280 x 1024.
#pragma once

#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace nullcone::view {

/// Any number of threads may use it.
class Buffers {
 public:
  /// Whatever was in it is still there.
  std::string take() {
    const std::scoped_lock lock(mutex_);
    if (free_.empty()) return {};
    std::string out = std::move(free_.back());
    free_.pop_back();
    return out;
  }
  void give(std::string bytes) {
    const std::scoped_lock lock(mutex_);
    if (bytes.size() >= kLeast && bytes.size() <= kMost && free_.size() < kCount)
      free_.push_back(std::move(bytes));
  }

 private:
  static constexpr std::size_t kLeast = 100'000, kMost = 20'000'000, kCount = 4;
  std::mutex mutex_;
  std::vector<std::string> free_;
};

}  // namespace nullcone::view
