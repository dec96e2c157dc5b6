// The query of a request, read strictly.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace nullcone::view {

/// "a=1&b=two", percent-decoded. Throws InputError for what is no query, keys that stand twice, and from
/// finish() for keys that nobody asked for.
class Query {
 public:
  /// `target`: path and query.
  explicit Query(std::string_view target);

  bool has(std::string_view key) const { return values_.contains(key); }
  std::string text(std::string_view key);
  std::string text(std::string_view key, std::string fallback);
  int integer(std::string_view key, int least, int most);
  int integer(std::string_view key, int least, int most, int fallback);
  /// Finite, or nothing where the key is missing or empty.
  std::optional<double> number(std::string_view key);
  void finish() const;

 private:
  struct Value {
    std::string text;
    bool asked = false;
  };
  std::map<std::string, Value, std::less<>> values_;
};

}  // namespace nullcone::view
