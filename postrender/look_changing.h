// What a look says about numbers that change with the time of emission.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "postrender/changing.h"
#include "postrender/look_place.h"

namespace nullcone::postrender {

/// Range of a number, ends included.
struct Bounds {
  double least = -JsonObject::kBig, most = JsonObject::kBig;
};

/// The JSON pointer of an entry inside its file.
std::string pointer_of(const JsonObject& in, std::string_view key, const LookSource& source);

/// A number, or keyframes by t or tau whose values all lie within the bounds and whose times are at most
/// 1e100.
Number parse_number(JsonObject& in, std::string_view key, const LookSource& source, const Bounds& bounds);
Number parse_number_or(JsonObject& in, std::string_view key, const LookSource& source, double fallback,
                       const Bounds& bounds);
/// A list of `count` of them.
std::vector<Number> parse_numbers(JsonObject& in, std::string_view key, const LookSource& source,
                                  std::size_t count, const Bounds& bounds);

/// An entry as it is at the nodes of all its keyframes by t or tau: at their times and evenly between.
struct Nodes {
  Timeline timeline;
  std::vector<nlohmann::json> values;  ///< one a node; the entry itself if nothing changes
};

/// Between two neighbouring times of the keyframes stand `steps` nodes, fewer where there would be more than
/// 16384 of them, but not less than 4. Numbers under keys in `whole` are rounded. Throws InputError for
/// numbers that go by different clocks, and for more than 4096 times.
Nodes at_nodes(const nlohmann::json& entry, std::size_t steps, const std::vector<std::string>& whole,
               const std::string& place, const std::string& pointer);

}  // namespace nullcone::postrender
