// One channel of a dataset in false colours, and the legend that a page draws.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/record/dataset.h"

namespace nullcone::view {

struct ChannelView {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  ///< 3 bytes a pixel, sRGB
  nlohmann::ordered_json legend;
};

/// As nullcone-postrender --show has it, without its margin. Throws InputError for channels and ranges that
/// there are not.
ChannelView view_channel(const Dataset& dataset, const std::string& name,
                         const std::optional<std::pair<double, double>>& range);

/// Names, units and meanings of all that view_channel() can show of a dataset.
nlohmann::ordered_json channel_list(const Manifest& manifest);

}  // namespace nullcone::view
