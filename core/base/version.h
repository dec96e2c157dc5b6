// What this program is, and where it runs.
#pragma once

#include <string>

namespace nullcone {

std::string version();  ///< "0.1.0"
std::string commit();   ///< short hash at configuration time, or "unknown"
/// "nullcone 0.1.0 (commit)" as it stands in files.
std::string code_version();
/// Of this machine, as it names itself.
std::string host_name();

}  // namespace nullcone
