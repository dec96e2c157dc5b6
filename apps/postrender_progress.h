// What a sequence tells while it runs: progress on standard error, a line of JSON a frame on standard output.
#pragma once

#include <cstddef>
#include <mutex>

#include "apps/postrender_options.h"
#include "postrender/frames.h"
#include "postrender/image.h"

namespace nullcone {

/// The number of threads that the options ask for.
int thread_count(const PostrenderOptions& options);

/// Any number of threads may tell it.
class SequenceProgress {
 public:
  SequenceProgress(const PostrenderOptions& options, std::size_t all) : options_(options), all_(all) {}
  /// Complaints begin a line of their own.
  ~SequenceProgress();
  SequenceProgress(const SequenceProgress&) = delete;
  SequenceProgress& operator=(const SequenceProgress&) = delete;

  void skipped(const postrender::FrameFiles& files);
  void rendered(const postrender::FrameFiles& files, const postrender::Image& image, double seconds);
  /// The summary.
  void finish(bool whole);

 private:
  void show();

  const PostrenderOptions& options_;
  const std::size_t all_;
  std::mutex mutex_;
  std::size_t skipped_ = 0, rendered_ = 0;
  bool line_open_ = false;  ///< of the progress
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), shown_ = start_;
};

}  // namespace nullcone
