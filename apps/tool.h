// What every tool shares: common options, and how errors end a program.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace nullcone {

struct ToolOptions {
  bool quiet = false;
  int threads = 0;  ///< 0: as many as there are cores
};

/// Adds --quiet, --threads and --version.
ToolOptions& add_common_options(CLI::App& app, ToolOptions& options);

/// Parses the command line, then runs `work`. Exit 0: done; 1: the work failed; 2: the input or the command
/// line is wrong. Complaints are one line on standard error.
int run_tool(CLI::App& app, int argc, char** argv, const std::function<int()>& work);

}  // namespace nullcone
