// What the functions of the API share.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "apps/view/encode.h"
#include "apps/view/http_server.h"
#include "apps/view/query.h"
#include "core/base/error.h"

namespace nullcone::view {

/// Refused with a status of its own.
struct Refused {
  int status;
  std::string message;
};

template <class Json>
Answer answer_of(const Json& body) {
  return {200, "application/json", body.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

inline Format format_of(Query& query) {
  const std::string name = query.text("format", "raw");
  const std::optional<Format> format = find_format(name);
  if (!format) throw InputError("?format", "expected raw, jpeg, webp or png");
  return *format;
}

inline int scale_of(Query& query) {
  const int scale = query.integer("scale", 1, 4, 1);
  if (scale == 3) throw InputError("?scale", "expected 1, 2 or 4");
  return scale;
}

inline std::string size_text(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace nullcone::view
