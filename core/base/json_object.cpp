#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/base/error.h"
#include "core/base/json.h"

namespace nullcone {

using nlohmann::json;

namespace {

std::string short_number(double value) {
  std::ostringstream out;
  out.precision(12);
  out << value;
  return out.str();
}

}  // namespace

json JsonSurvey::complete(json document, const std::string& pointer) const {
  for (const auto& [place, text] : values)
    if (place.starts_with(pointer))
      document[json::json_pointer(place.substr(pointer.size()))] = json::parse(text);
  return document;
}

JsonObject::JsonObject(const json& value, std::string place, std::string pointer, JsonSurvey* survey)
    : value_(&value), place_(std::move(place)), pointer_(std::move(pointer)), survey_(survey) {
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

std::string JsonObject::pointer_to(std::string_view key) const {
  return pointer_ + "/" + escape_pointer(key);
}

void JsonObject::note(std::string_view key, const json& value) const {
  if (survey_ != nullptr) survey_->values.emplace_back(pointer_to(key), canonical_json(value));
}

bool JsonObject::has(std::string_view key) const {
  asked_.emplace(key);
  return value_->contains(std::string(key));
}

bool JsonObject::is_text(std::string_view key) const {
  return has(key) && value_->at(std::string(key)).is_string();
}

const json& JsonObject::at(std::string_view key) {
  known_.emplace(key);
  const auto found = value_->find(std::string(key));
  if (found == value_->end()) refuse(key, "missing");
  return *found;
}

JsonObject JsonObject::object(std::string_view key) { return {at(key), place_, pointer_to(key), survey_}; }

JsonObject JsonObject::empty_object(std::string_view key) const {
  static const json kEmpty = json::object();
  note(key, kEmpty);
  return {kEmpty, place_, pointer_to(key), survey_};
}

JsonObject JsonObject::object_or_empty(std::string_view key) {
  known_.emplace(key);
  return has(key) ? object(key) : empty_object(key);
}

JsonObject JsonObject::object_or_true(std::string_view key) {
  const json& value = at(key);
  return value.is_boolean() && value.get<bool>() ? empty_object(key) : object(key);
}

std::vector<JsonObject> JsonObject::objects(std::string_view key) {
  const json& list = at(key);
  if (!list.is_array()) refuse(key, std::string("expected a list […], found ") + list.type_name());
  std::vector<JsonObject> out;
  for (std::size_t i = 0; i < list.size(); ++i)
    out.emplace_back(list[i], place_, pointer_to(key) + "/" + std::to_string(i), survey_);
  return out;
}

std::string JsonObject::text(std::string_view key) {
  const json& value = at(key);
  if (!value.is_string()) refuse(key, std::string("expected a text \"…\", found ") + value.type_name());
  return value.get<std::string>();
}

std::string JsonObject::text(std::string_view key, std::string fallback) {
  known_.emplace(key);
  if (has(key)) return text(key);
  note(key, fallback);
  return fallback;
}

std::string JsonObject::word(std::string_view key, const std::vector<std::string>& allowed) {
  if (survey_ != nullptr) survey_->words[pointer_to(key)] = allowed;
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
  if (has(key)) return word(key, allowed);
  if (survey_ != nullptr) survey_->words[pointer_to(key)] = allowed;
  note(key, fallback);
  return fallback;
}

std::string JsonObject::name(std::string_view key, std::set<std::string>& taken) {
  const std::string name = text(key);
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  bool fits = !name.empty() && name.size() <= 32 && letter(name[0]);
  for (const char c : name) fits = fits && (letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-');
  if (!fits)
    refuse(key,
           "expected a letter and up to 31 letters, digits, '_' or '-', found '" + printable(name, 40) + "'");
  if (!taken.insert(name).second) refuse(key, "'" + name + "' names two of them; expected different names");
  return name;
}

bool JsonObject::boolean(std::string_view key, bool fallback) {
  known_.emplace(key);
  if (survey_ != nullptr) survey_->words[pointer_to(key)] = {"true", "false"};
  if (!has(key)) note(key, fallback);
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
  if (has(key)) return number(key, least, most);
  if (std::isfinite(fallback)) note(key, fallback);  // JSON has no infinity: such an entry stays open
  return fallback;
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

std::vector<std::vector<double>> JsonObject::rows(std::string_view key, std::size_t count, double least,
                                                  double most) {
  const json& list = at(key);
  if (!list.is_array()) refuse(key, std::string("expected a list […], found ") + list.type_name());
  std::vector<std::vector<double>> out(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string place = std::string(key) + "/" + std::to_string(i);
    if (!list[i].is_array() || list[i].size() != count)
      refuse(place, "expected a list of " + std::to_string(count) + " numbers");
    for (std::size_t k = 0; k < count; ++k)
      out[i].push_back(checked(list[i][k], place + "/" + std::to_string(k), least, most));
  }
  return out;
}

std::vector<double> JsonObject::numbers_or(std::string_view key, const std::vector<double>& fallback,
                                           double least, double most) {
  known_.emplace(key);
  if (has(key)) return numbers(key, fallback.size(), least, most);
  note(key, fallback);
  return fallback;
}

std::vector<std::string> JsonObject::keys() const {
  std::vector<std::string> out;
  for (const auto& [key, value] : value_->items()) out.push_back(key);
  return out;
}

void JsonObject::finish() const {
  if (survey_ != nullptr) {
    std::set<std::string>& keys = survey_->keys[pointer_];
    keys.insert(known_.begin(), known_.end());
    keys.insert(asked_.begin(), asked_.end());
  }
  for (const auto& [key, value] : value_->items()) {
    if (known_.contains(key)) continue;
    // Of the keys that were only asked for, those that are there are refused too.
    std::set<std::string> possible(known_.begin(), known_.end());
    std::ranges::copy_if(asked_, std::inserter(possible, possible.end()),
                         [&](const std::string& name) { return !value_->contains(name); });
    std::string list;
    for (const std::string& name : possible) list += (list.empty() ? "" : ", ") + name;
    refuse(escape_pointer(key), "unknown key; expected one of " + list);
  }
}

}  // namespace nullcone
