#include "core/base/json.h"

#include <cmath>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/base/error.h"

namespace nullcone {

using nlohmann::json;

namespace {

constexpr std::size_t kDeepest = 64;

std::string escape_pointer(std::string_view key) {
  std::string out;
  for (const char c : key) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return out;
}

std::string short_number(double value) {
  std::ostringstream out;
  out.precision(12);
  out << value;
  return out.str();
}

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

json parse_json(std::string_view text, const std::string& place) {
  DuplicateGuard guard(place);
  const std::size_t nul = text.find('\0');  // the parser would take it for the end
  if (nul != std::string_view::npos)
    throw InputError(place + ": " + line_and_column(text, nul + 1), "not valid JSON: a zero byte");
  try {
    return json::parse(text, std::ref(guard));
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

JsonObject::JsonObject(const json& value, std::string place, std::string pointer)
    : value_(&value), place_(std::move(place)), pointer_(std::move(pointer)) {
  if (!value.is_object())
    throw InputError(place_ + ": " + (pointer_.empty() ? "/" : pointer_),
                     std::string("expected an object {…}, found ") + value.type_name());
}

std::string JsonObject::where(std::string_view key) const {
  std::string pointer = pointer_;
  if (!key.empty()) pointer += "/" + std::string(key);
  return place_ + ": " + (pointer.empty() ? "/" : pointer);
}

void JsonObject::refuse(std::string_view key, std::string_view message) const {
  throw InputError(where(key), message);
}

bool JsonObject::has(std::string_view key) const { return value_->contains(std::string(key)); }

bool JsonObject::is_text(std::string_view key) const {
  return has(key) && value_->at(std::string(key)).is_string();
}

const json& JsonObject::at(std::string_view key) {
  known_.emplace(key);
  const auto found = value_->find(std::string(key));
  if (found == value_->end()) refuse(key, "missing");
  return *found;
}

JsonObject JsonObject::object(std::string_view key) {
  return {at(key), place_, pointer_ + "/" + escape_pointer(key)};
}

std::vector<JsonObject> JsonObject::objects(std::string_view key) {
  const json& list = at(key);
  if (!list.is_array()) refuse(key, std::string("expected a list […], found ") + list.type_name());
  std::vector<JsonObject> out;
  for (std::size_t i = 0; i < list.size(); ++i)
    out.emplace_back(list[i], place_, pointer_ + "/" + escape_pointer(key) + "/" + std::to_string(i));
  return out;
}

std::string JsonObject::text(std::string_view key) {
  const json& value = at(key);
  if (!value.is_string()) refuse(key, std::string("expected a text \"…\", found ") + value.type_name());
  return value.get<std::string>();
}

std::string JsonObject::text(std::string_view key, std::string fallback) {
  known_.emplace(key);
  return has(key) ? text(key) : std::move(fallback);
}

std::string JsonObject::word(std::string_view key, const std::vector<std::string>& allowed) {
  const std::string found = text(key);
  std::string list;
  for (const std::string& choice : allowed) {
    if (found == choice) return found;
    list += (list.empty() ? "" : ", ") + choice;
  }
  refuse(key, "'" + printable(found, 40) + "' is unknown; expected one of " + list);
}

std::string JsonObject::word(std::string_view key, const std::vector<std::string>& allowed,
                             std::string fallback) {
  known_.emplace(key);
  return has(key) ? word(key, allowed) : std::move(fallback);
}

std::string JsonObject::name(std::string_view key, std::set<std::string>& taken) {
  const std::string name = text(key);
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  bool fits = !name.empty() && name.size() <= 32 && letter(name[0]);
  for (const char c : name) fits = fits && (letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-');
  if (!fits)
    refuse(key,
           "expected a letter and up to 31 letters, digits, '_' or '-', found '" + printable(name, 40) + "'");
  if (!taken.insert(name).second) refuse(key, "'" + name + "' names two objects; expected different names");
  return name;
}

bool JsonObject::boolean(std::string_view key, bool fallback) {
  known_.emplace(key);
  if (!has(key)) return fallback;
  const json& value = at(key);
  if (!value.is_boolean()) refuse(key, std::string("expected true or false, found ") + value.type_name());
  return value.get<bool>();
}

double JsonObject::checked(const json& value, std::string_view key, double least, double most) const {
  if (!value.is_number()) refuse(key, std::string("expected a number, found ") + value.type_name());
  const double number = value.get<double>();
  if (!std::isfinite(number)) refuse(key, "expected a finite number");
  if (number < least || number > most)
    refuse(key, "is " + short_number(number) + "; expected a number from " + short_number(least) + " to " +
                    short_number(most));
  return number;
}

double JsonObject::number(std::string_view key, double least, double most) {
  return checked(at(key), key, least, most);
}

double JsonObject::number_or(std::string_view key, double fallback, double least, double most) {
  known_.emplace(key);
  return has(key) ? number(key, least, most) : fallback;
}

double JsonObject::positive(std::string_view key) {
  const double value = number(key);
  if (!(value > 0)) refuse(key, "is " + short_number(value) + "; expected a number greater than 0");
  return value;
}

long JsonObject::integer(std::string_view key, long least, long most) {
  const double value = number(key, static_cast<double>(least), static_cast<double>(most));
  if (value != std::floor(value)) refuse(key, "is " + short_number(value) + "; expected a whole number");
  return static_cast<long>(value);
}

std::vector<double> JsonObject::numbers(std::string_view key, std::size_t count, double least, double most) {
  const json& list = at(key);
  if (!list.is_array() || list.size() != count)
    refuse(key, "expected a list of " + std::to_string(count) + " numbers");
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i)
    out.push_back(checked(list[i], std::string(key) + "/" + std::to_string(i), least, most));
  return out;
}

std::vector<double> JsonObject::numbers_or(std::string_view key, const std::vector<double>& fallback,
                                           double least, double most) {
  known_.emplace(key);
  return has(key) ? numbers(key, fallback.size(), least, most) : fallback;
}

std::vector<std::string> JsonObject::keys() const {
  std::vector<std::string> out;
  for (const auto& [key, value] : value_->items()) out.push_back(key);
  return out;
}

void JsonObject::finish() const {
  for (const auto& [key, value] : value_->items()) {
    if (known_.contains(key)) continue;
    std::string list;
    for (const std::string& name : known_) list += (list.empty() ? "" : ", ") + name;
    refuse(escape_pointer(key), "unknown key; expected one of " + list);
  }
}

}  // namespace nullcone
