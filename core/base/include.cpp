#include "core/base/include.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/base/json.h"

namespace nullcone {

using nlohmann::json;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostBytes = std::size_t{64} << 20, kLongestChain = 16, kMostLevels = 64;
constexpr int kMostIncludes = 10'000, kMostParts = 1'000'000;

bool is_within(const fs::path& file, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

/// Of a regular file and of no other: reading a device may never end, or do something. Nothing for others,
/// and for what cannot be read; more than `most` bytes where there are more.
std::optional<std::string> text_of(const fs::path& path, std::size_t most) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return std::nullopt;
  const int file = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (file < 0) return std::nullopt;
  struct stat found {};
  bool whole = ::fstat(file, &found) == 0 && S_ISREG(found.st_mode);
  std::string out;
  std::vector<char> block(1 << 16);
  while (whole && out.size() <= most) {
    const ssize_t count = ::read(file, block.data(), block.size());
    whole = count >= 0;
    if (count <= 0) break;
    out.append(block.data(), static_cast<std::size_t>(count));
  }
  ::close(file);
  return whole ? std::optional(std::move(out)) : std::nullopt;
}

/// An object by the name `include` in a look has an object under that key.
bool is_include(const json& value) {
  return value.is_object() && value.contains("include") && !value["include"].is_object();
}

class Including {
 public:
  explicit Including(const std::string& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) {
      chain_.push_back({path, {}});
      return;
    }
    chain_.push_back({path, fs::canonical(path, error)});
    folder_ = fs::canonical(fs::absolute(path).parent_path(), error);
  }

  /// A file's document. The schema is that of the file, and known beside it.
  WholeJson whole(json document, std::size_t depth) {
    if (document.is_object() && document.contains("$schema") && document["$schema"].is_string())
      document.erase("$schema");
    return resolve(std::move(document), "", depth);
  }

 private:
  struct File {
    std::string name;  ///< for complaints, and to find what stands beside it
    fs::path real;
  };

  [[noreturn]] void refuse(const std::string& pointer, const std::string& message) const {
    throw InputError(chain_.back().name + ": " + (pointer.empty() ? "/" : pointer), message);
  }

  WholeJson resolve(json value, const std::string& pointer, std::size_t depth) {
    if (depth > kMostLevels) refuse(pointer, "nested deeper than 64 levels, with what is included");
    if (is_include(value)) return resolve_include(std::move(value), pointer, depth, false);
    if (value.is_array()) return resolve_list(std::move(value), pointer, depth);
    WholeJson out{std::move(value), {chain_.back().name, pointer}};
    if (!out.document.is_object()) return out;
    for (auto& [name, inner] : out.document.items()) {
      if (!inner.is_structured()) continue;
      const std::string key = escape_pointer(name);
      WholeJson part = resolve(std::move(inner), pointer + "/" + key, depth + 1);
      inner = std::move(part.document);
      put(out.origin, key, std::move(part.origin));
    }
    return out;
  }

  WholeJson resolve_list(json list, const std::string& pointer, std::size_t depth) {
    WholeJson out{json::array(), {chain_.back().name, pointer}};
    if (std::ranges::none_of(list, [](const json& item) { return item.is_structured(); }))
      return {std::move(list), std::move(out.origin)};
    const auto append = [&](json& item, JsonOrigin origin) {
      put(out.origin, std::to_string(out.document.size()), std::move(origin));
      out.document.push_back(std::move(item));
    };
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::string place = pointer + "/" + std::to_string(i);
      const bool alone = is_include(list[i]) && list[i].size() == 1;
      WholeJson part = alone ? resolve_include(std::move(list[i]), place, depth + 1, true)
                             : resolve(std::move(list[i]), place, depth + 1);
      if (!alone || !part.document.is_array()) {
        append(part.document, std::move(part.origin));
        continue;
      }
      for (std::size_t k = 0; k < part.document.size(); ++k)
        append(part.document[k], part.origin.part(std::to_string(k)));
    }
    return out;
  }

  void put(JsonOrigin& origin, const std::string& key, JsonOrigin part) {
    origin.parts.erase(key);
    const JsonOrigin usual = origin.part(key);
    if (part.file == usual.file && part.pointer == usual.pointer && part.parts.empty()) return;
    if (++parts_ > kMostParts) refuse("", "expected at most 1000000 entries that stand elsewhere");
    origin.parts.emplace(key, std::move(part));
  }

  /// RFC 7386.
  void merge(WholeJson& target, const WholeJson& patch) {
    if (!target.document.is_object()) target = {json::object(), {patch.origin.file, patch.origin.pointer}};
    for (const auto& [name, value] : patch.document.items()) {
      const std::string key = escape_pointer(name);
      if (value.is_null()) {
        target.document.erase(name);
        target.origin.parts.erase(key);
        continue;
      }
      WholeJson part{value, patch.origin.part(key)};
      if (value.is_object()) {
        WholeJson old{json(), target.origin.part(key)};
        if (target.document.contains(name)) old.document = std::move(target.document[name]);
        merge(old, part);
        part = std::move(old);
      }
      target.document[name] = std::move(part.document);
      put(target.origin, key, std::move(part.origin));
    }
  }

  WholeJson resolve_include(json value, const std::string& pointer, std::size_t depth, bool list) {
    const std::string place = pointer + "/include";
    const json name = std::move(value["include"]);
    if (!name.is_string())
      refuse(place, std::string("expected the name of a file \"….json\", found ") + name.type_name());
    value.erase("include");
    WholeJson out = resolve_file(name.get_ref<const std::string&>(), place, depth);
    if (!out.document.is_object() && !(list && out.document.is_array()))
      refuse(place, "'" + printable(out.origin.file) + "' holds " +
                        (out.document.is_array() ? "a list" : out.document.type_name()) +
                        "; expected a file that holds an object {…}" + (list ? " or a list […]" : ""));
    if (!value.empty()) merge(out, resolve(std::move(value), pointer, depth));
    return out;
  }

  /// Checks that it may be read.
  File find(const std::string& name, const std::string& place) const {
    if (!stays_below(name))
      refuse(place,
             "expected the name of a file beside this one or below, found '" + printable(name, 80) + "'");
    if (folder_.empty()) refuse(place, "what is read from a pipe cannot include files");
    const fs::path shown = (fs::path(chain_.back().name).parent_path() / name).lexically_normal();
    std::error_code error;
    const fs::path real = fs::canonical(shown, error);
    if (error) refuse(place, "cannot open '" + printable(shown.string()) + "'; expected a JSON file");
    if (!is_within(real, folder_))
      refuse(place, "'" + printable(shown.string()) + "' leads out of the folder of '" +
                        printable(chain_.front().name) + "'");
    return {shown.string(), real};
  }

  void check_chain(const File& file, const std::string& place) const {
    const auto same = std::ranges::find(chain_, file.real, &File::real);
    if (same != chain_.end()) {
      std::string names;
      for (auto at = same; at != chain_.end(); ++at) names += printable(at->name) + " -> ";
      refuse(place, "includes itself: " + names + printable(file.name));
    }
    if (chain_.size() == kLongestChain) refuse(place, "expected at most 16 files that include one another");
  }

  WholeJson resolve_file(const std::string& name, const std::string& place, std::size_t depth) {
    File file = find(name, place);
    check_chain(file, place);
    if (++count_ > kMostIncludes) refuse(place, "expected at most 10000 files to be included in all");
    const std::optional<std::string> text = text_of(file.real, kMostBytes - bytes_);
    if (!text) refuse(place, "cannot read '" + printable(file.name) + "'; expected a JSON file");
    bytes_ += text->size();
    if (bytes_ > kMostBytes) refuse(place, "expected at most 64 MiB to be included in all");
    json document = parse_json(*text, file.name);
    chain_.push_back(std::move(file));
    WholeJson out = whole(std::move(document), depth);
    chain_.pop_back();
    return out;
  }

 private:
  std::vector<File> chain_;  ///< from the first file to the one that is read now
  fs::path folder_;          ///< real; empty for what is no file
  std::size_t bytes_ = 0;
  int count_ = 0, parts_ = 0;
};

}  // namespace

JsonOrigin JsonOrigin::part(const std::string& key) const {
  const auto found = parts.find(key);
  if (found != parts.end()) return found->second;
  return {file, pointer + "/" + key, {}};
}

InputError JsonOrigin::told(const InputError& error, const std::string& place) const {
  const std::string what = error.what();
  const std::size_t begin = what.find(": /");
  if (begin == what.npos || file.empty() || !what.starts_with(place)) return error;
  // What follows the name before the pointer, as " (frame 7)", stays.
  const std::string beside = what.substr(place.size(), begin - place.size());
  if (!beside.empty() && !beside.starts_with(" (")) return error;
  const std::size_t end = std::min(what.find(": ", begin + 3), what.size());
  JsonOrigin at = *this;
  for (std::size_t step = begin + 3; step < end;) {
    const std::size_t next = std::min(what.find('/', step), end);
    at = at.part(what.substr(step, next - step));
    step = next + 1;
  }
  return {at.file + beside + ": " + (at.pointer.empty() ? "/" : at.pointer),
          end == what.size() ? "" : what.substr(end + 2)};
}

bool stays_below(std::string_view path) {
  const fs::path parts(path);
  return !path.empty() && path.find('\0') == path.npos && parts.is_relative() &&
         std::ranges::find(parts, "..") == parts.end();
}

WholeJson include_files(json document, const std::string& path) {
  WholeJson out = Including(path).whole(std::move(document), 1);
  out.path = path;
  return out;
}

}  // namespace nullcone
