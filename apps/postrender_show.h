// nullcone-postrender --show: one channel of a dataset in false colours, or as numbers.
#pragma once

#include <chrono>
#include <string>

#include "apps/tool.h"

namespace nullcone {

/// What every picture needs, whatever it shows.
struct PostrenderOptions {
  ToolOptions common;
  std::string data, picture;
  int bits = 8;
  bool json = false;
};

/// Seconds from one step to the next.
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> passed = now - last_;
    last_ = now;
    return passed.count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

struct Seconds {
  double read = 0, render = 0, write = 0;
};

/// One line on standard error.
void report_times(const PostrenderOptions& options, int width, int height, const Seconds& seconds);

/// Writes the picture of channel `name`; only that channel is read. `range` is "a,b", or empty. Returns the
/// exit status; throws InputError for a channel or range that there is not.
int show_channel(const PostrenderOptions& options, const std::string& name, const std::string& range);

}  // namespace nullcone
