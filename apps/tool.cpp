#include "apps/tool.h"

#include <OpenEXR/OpenEXRConfig.h>
#include <oneapi/tbb/version.h>
#include <boost/version.hpp>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <new>

#include "core/base/error.h"
#include "core/base/version.h"
#include "metrics/registry.h"

namespace nullcone {

namespace {

/// Version, commit, instruction set and libraries.
std::string about(const CLI::App& app) {
  const std::string boost =
      std::to_string(BOOST_VERSION / 100000) + "." + std::to_string(BOOST_VERSION / 100 % 1000);
  return app.get_name() + " " + version() + "\ncommit " + commit() + "\ninstruction set " +
         std::string(find_spacetime("minkowski").isa()) +
         "\nOpenEXR " OPENEXR_VERSION_STRING ", oneTBB " TBB_VERSION_STRING ", Boost " + boost +
         ", CLI11 " CLI11_VERSION;
}

int complain(const CLI::App& app, const std::string& message, int status) {
  std::cerr << app.get_name() << ": " << message << '\n';
  return status;
}

}  // namespace

ToolOptions& add_common_options(CLI::App& app, ToolOptions& options) {
  app.add_flag("-q,--quiet", options.quiet, "No progress or notes on standard error");
  app.add_option("--threads", options.threads, "Number of threads (default: all cores)")
      ->check(CLI::Range(0, 4096));
  app.set_version_flag("--version", about(app));
  return options;
}

int run_tool(CLI::App& app, int argc, char** argv, const std::function<int()>& work) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too large is an error to report, not a death
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    return complain(app, printable(error.what(), 600) + " (see --help)", 2);
  }
  try {
    const int status = work();
    std::cout.flush();
    // What was flushed in vain before is gone, and only the flag tells.
    const bool written = std::cout && std::ferror(stdout) == 0;
    return written ? status : complain(app, "standard output: cannot write", 1);
  } catch (const InputError& error) {
    return complain(app, error.what(), 2);
  } catch (const std::bad_alloc&) {
    return complain(app, "out of memory", 1);
  } catch (const std::exception& error) {
    return complain(app, error.what(), 1);
  }
}

}  // namespace nullcone
