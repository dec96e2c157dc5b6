// Strict reading of JSON: unknown, missing, duplicate and out-of-range entries are refused with their place.
#pragma once

#include <limits>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace nullcone {

/// A key as a step of a JSON pointer (RFC 6901).
std::string escape_pointer(std::string_view key);

/// Parses text. `place` (a file's name) stands before every complaint. Syntax errors are reported with line
/// and column, duplicate keys with their JSON pointer, nesting deeper than 64 is refused. UTF-8 only.
nlohmann::json parse_json(std::string_view text, const std::string& place);

/// Reads and parses a file of at most `largest` bytes.
nlohmann::json parse_json_file(const std::string& path, std::size_t largest = std::size_t{64} << 20);

/// The canonical text of a document: sorted keys, no white space, shortest round-trip numbers.
std::string canonical_json(const nlohmann::json& document);

/// What readers of a document asked for, besides what stands in it; for telling people what they may say.
/// Pointers begin at the top of the document.
struct JsonSurvey {
  /// What entries amount to that are left out (their defaults), or that are not yet told in full, in the
  /// order in which they were read.
  std::vector<std::pair<std::string, std::string>> values;  ///< pointer and JSON text
  std::map<std::string, std::set<std::string>> keys;        ///< of objects: what they may hold
  std::map<std::string, std::vector<std::string>> words;    ///< of texts: the allowed ones

  /// `document` with all values in it. `pointer` is the place of `document` in the one that was read.
  nlohmann::json complete(nlohmann::json document, const std::string& pointer = "") const;
};

/// An object of the document that is being read, with its JSON pointer. Each accessor marks its key as known;
/// `finish()` refuses whatever was not asked for.
class JsonObject {
 public:
  /// `value` must outlive this reader and be an object. `place` is "file" and `pointer` "/objects/0". Readers
  /// of inner objects write into the same survey.
  JsonObject(const nlohmann::json& value, std::string place, std::string pointer,
             JsonSurvey* survey = nullptr);

  bool has(std::string_view key) const;
  bool is_text(std::string_view key) const;
  /// The raw value of a required key.
  const nlohmann::json& at(std::string_view key);
  JsonObject object(std::string_view key);
  /// The same for one that may be left out: then it is empty, so that each of its entries has its default.
  JsonObject object_or_empty(std::string_view key);
  /// The same for one that may be `true` instead of an object.
  JsonObject object_or_true(std::string_view key);
  std::vector<JsonObject> objects(std::string_view key);  ///< a list of objects
  std::string text(std::string_view key);
  std::string text(std::string_view key, std::string fallback);
  /// One of the allowed words; the complaint lists them.
  std::string word(std::string_view key, const std::vector<std::string>& allowed);
  std::string word(std::string_view key, const std::vector<std::string>& allowed, std::string fallback);
  /// A name [A-Za-z][A-Za-z0-9_-]{0,31} that is not yet `taken`, and is from now on.
  std::string name(std::string_view key, std::set<std::string>& taken);
  bool boolean(std::string_view key, bool fallback);
  /// A finite number within [least, most].
  double number(std::string_view key, double least = -kBig, double most = kBig);
  double number_or(std::string_view key, double fallback, double least = -kBig, double most = kBig);
  /// A finite number greater than zero.
  double positive(std::string_view key);
  long integer(std::string_view key, long least, long most);
  /// A list of exactly `count` finite numbers within [least, most].
  std::vector<double> numbers(std::string_view key, std::size_t count, double least = -kBig,
                              double most = kBig);
  std::vector<double> numbers_or(std::string_view key, const std::vector<double>& fallback,
                                 double least = -kBig, double most = kBig);

  /// A list of lists of exactly `count` such numbers each.
  std::vector<std::vector<double>> rows(std::string_view key, std::size_t count, double least = -kBig,
                                        double most = kBig);

  /// For the survey: what the entry amounts to.
  void note(std::string_view key, const nlohmann::json& value) const;

  std::vector<std::string> keys() const;
  /// Refuses every key that nobody asked for, naming those that exist.
  void finish() const;

  /// "file: /objects/0/shape", for complaints about this object or one of its entries.
  std::string where(std::string_view key = {}) const;
  [[noreturn]] void refuse(std::string_view key, std::string_view message) const;

  static constexpr double kBig = std::numeric_limits<double>::max();

 private:
  double checked(const nlohmann::json& value, std::string_view key, double least, double most) const;

  std::string pointer_to(std::string_view key) const;
  JsonObject empty_object(std::string_view key) const;

  const nlohmann::json* value_;
  std::string place_, pointer_;
  JsonSurvey* survey_;
  mutable std::set<std::string, std::less<>> asked_;  ///< whether they are there, at least
  std::set<std::string, std::less<>> known_;
};

}  // namespace nullcone
