// Errors: a user's mistake is not a bug.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace nullcone {

/// Wrong input. Ends as one line "place: message" and exit status 2.
/// `place` names the file and the JSON pointer, or line and column, or the option.
class InputError : public std::runtime_error {
 public:
  InputError(std::string_view place, std::string_view message);
};

/// The input was right but the work could not be done (disk full, file unreadable). Exit status 1.
class WorkError : public std::runtime_error {
 public:
  WorkError(std::string_view place, std::string_view message);
};

/// Text from outside, made safe for one line of a terminal: control characters replaced, length bounded.
std::string printable(std::string_view text, std::size_t longest = 120);

}  // namespace nullcone
