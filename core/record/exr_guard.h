// A look at the header of an OpenEXR file before a library believes it: no length, window or count in it may
// ask for more memory than the file's own size can justify.
#pragma once

#include <string>

namespace nullcone {

/// Throws InputError for a header that lies, or is cut off.
void check_exr_header(const std::string& path);

}  // namespace nullcone
