// Other programs as children: what they say, what they cost, and how they end.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace nullcone::cluster {

struct ChildEnd {
  int status = 0;  ///< exit status, where no signal ended it
  int signal = 0;
  bool stopped = false;  ///< it was asked to end
  std::uint64_t peak_bytes = 0;
  double seconds = 0, core_seconds = 0;

  bool good() const { return status == 0 && signal == 0; }
};

/// Open files.
struct Outputs {
  int output, complaints;
};

/// Runs a program with nothing to read. As soon as `stop` says so it gets SIGTERM, once; so it does when we
/// die. Throws WorkError where it cannot be started.
ChildEnd run_child(const std::vector<std::string>& words, const Outputs& to,
                   const std::function<bool()>& stop = {});

struct Captured {
  ChildEnd end;
  std::string output, complaints;
};
Captured capture(const std::vector<std::string>& words);

/// Whether there is such a program on PATH.
bool on_path(const std::string& program);

/// A word for a shell.
std::string quoted(const std::string& word);
/// Words for a shell, as people would write them.
std::string shell_line(const std::vector<std::string>& words);

}  // namespace nullcone::cluster
