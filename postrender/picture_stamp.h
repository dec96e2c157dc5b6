// Fingerprints in picture files, by which an interrupted sequence knows what it has.
#pragma once

#include <string>
#include <vector>

namespace nullcone::postrender {

/// The fingerprint that write_picture() was given when it wrote this file; empty where there is none, or the
/// file is not there, or not whole (cut off by a copy, say).
std::string fingerprint_of_picture(const std::string& path);

/// What stands in the file's comment: PNG text, JPEG comment, or EXR attribute.
std::string fingerprint_comment(const std::string& fingerprint);

/// Size and time of a file, for fingerprints; throws InputError where it cannot be looked at.
std::string stamp_of_file(const std::string& path);
/// The same, or a word where there is no such file.
std::string stamp_if_there(const std::string& path);

/// Whether `path` is at least as new as all of `inputs`.
bool is_newer(const std::string& path, const std::vector<std::string>& inputs);

}  // namespace nullcone::postrender
