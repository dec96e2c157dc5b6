#include "postrender/look_path.h"

#include <charconv>
#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace nullcone::postrender {

using nlohmann::json;

namespace {
constexpr std::size_t kDeepestPath = 32;
}  // namespace

std::vector<std::string> split_path(const std::string& path, const std::string& place) {
  const bool pointer = path.find('/') != std::string::npos;
  std::vector<std::string> keys = {{}};
  for (std::size_t i = pointer && path[0] == '/' ? 1 : 0; i < path.size(); ++i) {
    const bool escaped =
        pointer && path[i] == '~' && i + 1 < path.size() && (path[i + 1] == '0' || path[i + 1] == '1');
    if (path[i] == (pointer ? '/' : '.')) {
      keys.emplace_back();
    } else if (escaped) {
      keys.back() += path[++i] == '0' ? '~' : '/';
    } else {
      keys.back() += path[i];
    }
  }
  for (const std::string& key : keys)
    if (key.empty()) throw InputError(place, "an empty step in the path; expected path=value");
  if (keys.size() > kDeepestPath) throw InputError(place, "the path is deeper than 32 steps");
  return keys;
}

const json* find_entry(const json& document, const std::vector<std::string>& keys) {
  const json* at = &document;
  for (const std::string& key : keys) {
    std::size_t index = 0;
    if (at->is_object() && at->contains(key)) {
      at = &(*at)[key];
    } else if (at->is_array() &&
               std::from_chars(key.data(), key.data() + key.size(), index).ptr == key.data() + key.size() &&
               index < at->size()) {
      at = &(*at)[index];
    } else {
      return nullptr;
    }
  }
  return at;
}

}  // namespace nullcone::postrender
