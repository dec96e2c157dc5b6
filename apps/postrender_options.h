// What nullcone-postrender is asked for, and the clock of its reports.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "apps/tool.h"

namespace nullcone {

struct PostrenderOptions {
  ToolOptions common;
  std::string data, picture;
  std::vector<std::string> looks, settings;
  int bits = 0;  ///< a component; 0: the usual of the file
  bool json = false;
  // One channel in place of a look.
  std::string show, range;
  // Sequences.
  int frame = 0;       ///< of a single picture
  std::string frames;  ///< empty: a single picture
  bool overwrite = false;
  std::string movie;
  double fps = 25;
  // Instead of a picture.
  bool explain = false;
  std::string completion, complete_set;
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

}  // namespace nullcone
