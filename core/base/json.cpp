#include "core/base/json.h"

#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace nullcone {

using nlohmann::json;

namespace {

constexpr std::size_t kDeepest = 64;

/// Follows the parser's events, so that a key that stands twice in one object is refused with its pointer.
class DuplicateGuard {
 public:
  explicit DuplicateGuard(std::string place) : place_(std::move(place)) {}

  bool operator()(int /*depth*/, json::parse_event_t event, json& parsed) {
    using Event = json::parse_event_t;
    switch (event) {
      case Event::object_start:
        open(true);
        break;
      case Event::array_start:
        open(false);
        break;
      case Event::key:
        key(parsed.get_ref<const std::string&>());
        break;
      case Event::object_end:
      case Event::array_end:
        levels_.pop_back();
        break;
      case Event::value:
        if (!levels_.empty() && !levels_.back().is_object) ++levels_.back().index;
        break;
    }
    return true;
  }

  /// Of the value that is read next.
  std::string next() {
    if (!levels_.empty() && !levels_.back().is_object) ++levels_.back().index;
    return pointer();
  }

 private:
  struct Level {
    bool is_object;
    long index = -1;
    std::string key;
    std::set<std::string> seen;
  };

  void open(bool is_object) {
    if (!levels_.empty() && !levels_.back().is_object) ++levels_.back().index;
    if (levels_.size() == kDeepest)
      throw InputError(place_ + ": " + pointer(), "nested deeper than 64 levels");
    levels_.push_back({is_object, -1, {}, {}});
  }
  void key(const std::string& name) {
    levels_.back().key = name;
    if (!levels_.back().seen.insert(name).second)
      throw InputError(place_ + ": " + pointer(), "the key stands twice; expected it once");
  }
  std::string pointer() const {
    std::string out;
    for (const Level& level : levels_)
      out += "/" + (level.is_object ? escape_pointer(level.key) : std::to_string(level.index));
    return out;
  }

  std::string place_;
  std::vector<Level> levels_;
};

std::string line_and_column(std::string_view text, std::size_t byte) {
  std::size_t line = 1, column = 1;
  for (std::size_t i = 0; i + 1 < byte && i < text.size(); ++i) {
    ++column;
    if (text[i] == '\n') ++line, column = 1;
  }
  return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

/// nlohmann's message without its "[json.exception…] parse error at line…:" preamble.
std::string tidy(std::string_view what) {
  const auto start = what.find(": ");
  std::string message(start == std::string_view::npos ? what : what.substr(start + 2));
  if (const auto from = message.find("syntax error while parsing "); from == 0) message.erase(0, 27);
  return message;
}

}  // namespace

std::string escape_pointer(std::string_view key) {
  std::string out;
  for (const char c : key) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return out;
}

json parse_json(std::string_view text, const std::string& place) {
  DuplicateGuard guard(place);
  const std::size_t nul = text.find('\0');  // the parser would take it for the end
  if (nul != std::string_view::npos)
    throw InputError(place + ": " + line_and_column(text, nul + 1), "not valid JSON: a zero byte");
  try {
    return json::parse(text, std::ref(guard), true, true);  // comments are skipped
  } catch (const json::parse_error& error) {
    throw InputError(place + ": " + line_and_column(text, error.byte),
                     "not valid JSON: " + tidy(error.what()));
  } catch (const json::out_of_range&) {
    throw InputError(place + ": " + guard.next(), "not valid JSON: a number is too large for a double");
  }
}

json parse_json_file(const std::string& path, std::size_t largest) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(path, "cannot open the file; expected a readable JSON file");
  std::string text;
  std::vector<char> block(1 << 16);
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())), in.gcount() > 0) {
    text.append(block.data(), static_cast<std::size_t>(in.gcount()));
    if (text.size() > largest)
      throw InputError(path, "larger than " + std::to_string(largest >> 20) + " MiB");
  }
  if (in.bad()) throw InputError(path, "cannot read the file");
  return parse_json(text, path);
}

std::string canonical_json(const json& document) {
  return document.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace nullcone
