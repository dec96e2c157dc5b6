// The spectra of what a dataset's crossings show under a look.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>

#include "core/record/dataset.h"
#include "postrender/look.h"

namespace nullcone::view {

/// Emitted and observed spectra of the crossings [first, end), as docs/viewer.md has them: of all that the
/// object wears at the time of emission (time slices, fades, keyframes) what has a spectrum, times its
/// intensity. An observed one is g^p L(g lambda) as the effects say, all 0 where g is not positive and
/// finite. Without an entry: crossings that show no spectrum of their own (`display`, `total_radiance`, lit
/// surfaces, materials, and three spectra under anything but one colour), and all where the look needs
/// channels that the dataset lacks. Not counted: opacities, and textures as filters. At most 32 entries.
nlohmann::ordered_json spectra_of(const Dataset& dataset, const postrender::Look& look, std::size_t first,
                                  std::size_t end);

}  // namespace nullcone::view
