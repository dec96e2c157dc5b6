// A picture of false colours with a legend below it.
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>

#include "core/record/dataset.h"
#include "postrender/color_bar.h"
#include "postrender/false_color.h"
#include "postrender/image.h"

namespace nullcone::postrender {

/// The numbers that occur among values of categories.
std::set<std::uint32_t> categories_in(std::span<const float> values);
/// What such a number means: of the channel `status` that of a Status, of `id` the object's name.
std::string category_name(const std::string& channel, std::uint32_t number, const Manifest& manifest);

/// The values of a channel (one a pixel of the manifest's window) in the colours of `scale`; below them its
/// name, unit and meaning, a bar with ticks, or the names of the categories. At least 360 pixels wide.
Image false_color_picture(const ColorScale& scale, const ChannelInfo& channel, const Manifest& manifest,
                          std::span<const float> values);

}  // namespace nullcone::postrender
