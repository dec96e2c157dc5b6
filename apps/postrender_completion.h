// nullcone-postrender --completion: scripts by which shells complete its command line.
#pragma once

#include <string>

#include "apps/tool.h"

namespace nullcone {

/// Prints the script for "bash" or "zsh", made from the options that `app` has. What --set may hold, the
/// script asks the tool itself for (--complete-set). The exit status; throws InputError for other shells.
int print_completion(const CLI::App& app, const std::string& shell);

}  // namespace nullcone
