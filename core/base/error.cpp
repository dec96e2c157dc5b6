#include "core/base/error.h"

namespace nullcone {

namespace {
std::string one_line(std::string_view place, std::string_view message) {
  return printable(place, 400) + ": " + printable(message, 600);
}
}  // namespace

InputError::InputError(std::string_view place, std::string_view message)
    : std::runtime_error(one_line(place, message)) {}

WorkError::WorkError(std::string_view place, std::string_view message)
    : std::runtime_error(one_line(place, message)) {}

std::string printable(std::string_view text, std::size_t longest) {
  std::string out;
  for (const char c : text) {
    if (out.size() >= longest) return out + "…";
    const auto byte = static_cast<unsigned char>(c);
    out += (byte < 0x20 || byte == 0x7f) ? '?' : c;
  }
  return out;
}

}  // namespace nullcone
