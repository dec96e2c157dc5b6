// Which channels of a dataset a look reads.
#pragma once

#include <string>

#include "core/record/dataset.h"
#include "postrender/look.h"

namespace nullcone::postrender {

/// All channels that change the pictures of a look: only these need be read of a dataset with this manifest.
/// Some of them it may lack: footprints come from `duv`, else from neighbours of the same `order`, else from
/// neighbours alone; where no effect is on, `shift` only blackens what has none.
ChannelSet needed_channels(const Look& look, const Manifest& manifest);

/// Throws InputError for the first channel that is not in `there` and without which the look cannot be shown:
/// "place: has no channel 'shift', which the look needs for /effects/doppler; ...".
void check_channels(const Look& look, const Manifest& manifest, ChannelSet there, const std::string& place);

}  // namespace nullcone::postrender
