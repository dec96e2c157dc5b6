#include "apps/view/query.h"

#include <charconv>
#include <cmath>

#include "core/base/error.h"

namespace nullcone::view {

namespace {

[[noreturn]] void refuse(std::string_view key, const std::string& message) {
  throw InputError("?" + printable(key, 40), message);
}

std::string decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i] == '+' ? ' ' : text[i];
      continue;
    }
    unsigned value = 0;
    const char* end = text.data() + std::min(text.size(), i + 3);
    const auto read = std::from_chars(text.data() + i + 1, end, value, 16);
    if (i + 2 >= text.size() || read.ec != std::errc() || read.ptr != end)
      refuse("", "expected two hex digits after %");
    out += static_cast<char>(value);
    i += 2;
  }
  return out;
}

}  // namespace

Query::Query(std::string_view target) {
  const std::size_t mark = target.find('?');
  if (mark == target.npos) return;
  std::string_view rest = target.substr(mark + 1);
  while (!rest.empty()) {
    const std::string_view pair = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(rest.size(), pair.size() + 1));
    const std::size_t equals = pair.find('=');
    if (equals == pair.npos) refuse(pair, "expected key=value");
    const std::string key = decoded(pair.substr(0, equals));
    if (!values_.emplace(key, Value{decoded(pair.substr(equals + 1))}).second) refuse(key, "stands twice");
  }
}

std::string Query::text(std::string_view key) {
  const auto found = values_.find(key);
  if (found == values_.end()) refuse(key, "is missing");
  found->second.asked = true;
  return found->second.text;
}

std::string Query::text(std::string_view key, std::string fallback) {
  return has(key) ? text(key) : std::move(fallback);
}

int Query::integer(std::string_view key, int least, int most) {
  const std::string written = text(key);
  int value = 0;
  const auto [end, error] = std::from_chars(written.data(), written.data() + written.size(), value);
  if (error != std::errc() || end != written.data() + written.size() || value < least || value > most)
    refuse(key, "expected a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  return value;
}

int Query::integer(std::string_view key, int least, int most, int fallback) {
  return has(key) ? integer(key, least, most) : fallback;
}

std::optional<double> Query::number(std::string_view key) {
  const std::string written = text(key, "");
  if (written.empty()) return {};
  double value = 0;
  const auto [end, error] = std::from_chars(written.data(), written.data() + written.size(), value);
  if (error != std::errc() || end != written.data() + written.size() || !std::isfinite(value))
    refuse(key, "expected a finite number");
  return value;
}

void Query::finish() const {
  for (const auto& [key, value] : values_)
    if (!value.asked) refuse(key, "is not asked for");
}

}  // namespace nullcone::view
