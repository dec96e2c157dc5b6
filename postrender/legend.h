// A picture of false colours with a legend below it.
#pragma once

#include <span>

#include "core/record/dataset.h"
#include "postrender/color_bar.h"
#include "postrender/false_color.h"
#include "postrender/image.h"

namespace nullcone::postrender {

/// The values of a channel (one a pixel of the manifest's window) in the colours of `scale`; below them its
/// name, unit and meaning, a bar with ticks, or the names of the categories. At least 360 pixels wide.
Image false_color_picture(const ColorScale& scale, const ChannelInfo& channel, const Manifest& manifest,
                          std::span<const float> values);

}  // namespace nullcone::postrender
