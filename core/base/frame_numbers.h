// Numbers of frames, and names of files with a number in them: "picture.####.png".
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace nullcone {

/// Frames from a list such as "0-249", "0-249:5" (every fifth) or "3,7,9-12", in that order. Throws
/// InputError for what is no such list, frames that stand twice, and more than a million of them.
std::vector<int> parse_frames(const std::string& text);

/// Whether there is a # in the name.
bool has_number(const std::string& pattern);

/// The name with the run of # replaced by the frame's number, padded with zeros to as many digits. Throws
/// InputError "option: ..." where # stands in two places.
std::string numbered(const std::string& pattern, int frame, const std::string& option);

/// Different numbers in any order as a list of runs, ascending: "0-3,7". Empty for none.
std::string runs_of(std::vector<std::int64_t> numbers);

}  // namespace nullcone
