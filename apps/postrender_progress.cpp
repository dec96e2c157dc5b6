#include "apps/postrender_progress.h"

#include <tbb/info.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/json.h"

namespace nullcone {

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void print_line(const nlohmann::json& line) {
  std::printf("%s\n", canonical_json(line).c_str());
  std::fflush(stdout);
}

}  // namespace

int thread_count(const PostrenderOptions& options) {
  return options.common.threads > 0 ? options.common.threads : tbb::info::default_concurrency();
}

SequenceProgress::~SequenceProgress() {
  if (line_open_) std::fputc('\n', stderr);
}

void SequenceProgress::skipped(const postrender::FrameFiles& files) {
  const std::lock_guard lock(mutex_);
  ++skipped_;
  if (options_.json) print_line({{"frame", files.frame}, {"picture", files.picture}, {"skipped", true}});
  show();
}

void SequenceProgress::rendered(const postrender::FrameFiles& files, const postrender::Image& image,
                                double seconds) {
  const std::lock_guard lock(mutex_);
  ++rendered_;
  if (options_.json)
    print_line({{"frame", files.frame},
                {"picture", files.picture},
                {"skipped", false},
                {"width", image.width},
                {"height", image.height},
                {"white_cd_m2", image.white_cd_m2},
                {"seconds", seconds}});
  show();
}

/// About five times a second, where somebody looks.
void SequenceProgress::show() {
  if (options_.common.quiet || seconds_since(shown_) < 0.2) return;
  shown_ = std::chrono::steady_clock::now();
  line_open_ = true;
  const double rate = static_cast<double>(rendered_) / seconds_since(start_);
  const std::size_t done = skipped_ + rendered_;
  std::fprintf(stderr, "\r%zu of %zu frames, %.1f frames/s, %.0f s left   ", done, all_, rate,
               static_cast<double>(all_ - done) / std::max(rate, 1e-9));
}

void SequenceProgress::finish(bool whole) {
  const double seconds = seconds_since(start_);
  const double rate = static_cast<double>(rendered_) / std::max(seconds, 1e-9);
  if (options_.json)
    print_line({{"frames", all_},
                {"rendered", rendered_},
                {"skipped", skipped_},
                {"whole", whole},
                {"seconds", seconds}});
  const char* start = std::exchange(line_open_, false) ? "\r" : "";
  if (!whole)
    std::fprintf(stderr,
                 "%snullcone-postrender: interrupted after %zu of %zu frames; the same command goes on\n",
                 start, rendered_ + skipped_, all_);
  else if (!options_.common.quiet)
    std::fprintf(stderr, "%s%zu frames: %zu rendered, %zu skipped, %.2f s, %.1f frames/s   \n", start, all_,
                 rendered_, skipped_, seconds, rate);
}

}  // namespace nullcone
