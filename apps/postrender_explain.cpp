#include "apps/postrender_explain.h"

#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/postrender_frame.h"
#include "core/base/error.h"
#include "core/base/json.h"

namespace nullcone {

namespace pr = postrender;
using nlohmann::json;

namespace {

pr::LookInFull read_in_full(const PostrenderOptions& options, std::string* pointer = nullptr) {
  if (options.looks.size() > 1) throw InputError("--look", "expected one look to explain");
  const pr::FrameFiles files = pr::files_of({options.data, options.looks, ""}, {options.frame}).front();
  const Manifest manifest = read_manifest(files.data);
  const LookDocuments documents = read_documents(manifest, files, options.settings);
  pr::LookInFull out;
  pr::look_at(documents.front(), manifest, options.frame, &out);
  if (pointer != nullptr) *pointer = documents.front().source.pointer;
  return out;
}

/// Its own lines for objects, one line for lists of numbers.
std::string pretty(const json& value, const std::string& margin = "") {
  const auto inner = [&](const auto& items, auto&& text_of, char open, char close) {
    std::string out(1, open);
    for (bool first = true; const auto& item : items) {
      out += (first ? "\n  " : ",\n  ") + margin + text_of(item);
      first = false;
    }
    return out + "\n" + margin + close;
  };
  const auto flat = [](const json& item) { return item.is_primitive(); };
  if (value.is_object() && !value.empty())
    return inner(
        value.items(),
        [&](const auto& item) {
          return json(item.key()).dump() + ": " + pretty(item.value(), margin + "  ");
        },
        '{', '}');
  if (value.is_array() && !std::ranges::all_of(value, flat))
    return inner(
        value, [&](const json& item) { return pretty(item, margin + "  "); }, '[', ']');
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// All paths and values that begin with what is written so far.
class Completer {
 public:
  Completer(const pr::LookInFull& look, std::string top)
      : document_(json::parse(look.text)), survey_(look.survey), top_(std::move(top)) {}

  void print(const std::string& written) const {
    const std::size_t equals = written.find('=');
    const std::string path = written.substr(0, equals);
    const char step = path.find('/') == path.npos ? '.' : '/';
    const std::size_t last = path.rfind(step);
    const std::string before = last == path.npos ? "" : path.substr(0, last + 1);
    std::string pointer = step == '/' ? path : "/" + path;
    for (char& c : pointer) c = c == step ? '/' : c;
    if (pointer.starts_with("//")) pointer.erase(0, 1);
    if (equals != written.npos)
      print_values(pointer, path + "=");
    else
      print_steps(pointer.substr(0, pointer.rfind('/')), before, step);
  }

 private:
  const json* find(const std::string& pointer) const {
    try {
      const json::json_pointer place(pointer);
      return document_.contains(place) ? &document_.at(place) : nullptr;
    } catch (const json::exception&) {  // not even a pointer
      return nullptr;
    }
  }
  bool goes_on(const std::string& pointer) const {
    const json* there = find(pointer);
    return survey_.keys.contains(top_ + pointer) || (there && (there->is_object() || is_list(*there)));
  }
  /// Of numbers that are picked one by one, or of objects.
  static bool is_list(const json& value) {
    return value.is_array() && !value.empty() && !value[0].is_number();
  }

  void print_steps(const std::string& pointer, const std::string& before, char step) const {
    std::set<std::string> keys;
    if (const auto found = survey_.keys.find(top_ + pointer); found != survey_.keys.end())
      keys = found->second;
    if (const json* there = find(pointer); there != nullptr) {
      if (there->is_object())
        for (const auto& [key, value] : there->items()) keys.insert(key);
      if (there->is_array())
        for (std::size_t i = 0; i < there->size(); ++i) keys.insert(std::to_string(i));
    }
    for (const std::string& key : keys)
      std::cout << before << key << (goes_on(pointer + "/" + escape_pointer(key)) ? step : '=') << '\n';
  }
  void print_values(const std::string& pointer, const std::string& before) const {
    const auto words = survey_.words.find(top_ + pointer);
    if (words != survey_.words.end())
      for (const std::string& word : words->second) std::cout << before << word << '\n';
    const json* now = find(pointer);
    if (words == survey_.words.end() && now != nullptr && now->is_primitive())
      std::cout << before << (now->is_string() ? now->get<std::string>() : now->dump()) << '\n';
  }

  json document_;
  const JsonSurvey& survey_;
  std::string top_;  ///< of the look in the survey's pointers
};

}  // namespace

int explain_look(const PostrenderOptions& options) {
  std::cout << pretty(json::parse(read_in_full(options).text)) << '\n';
  return 0;
}

int complete_set(const PostrenderOptions& options) {
  std::string top;
  const pr::LookInFull look = read_in_full(options, &top);
  Completer(look, top).print(options.complete_set);
  return 0;
}

}  // namespace nullcone
