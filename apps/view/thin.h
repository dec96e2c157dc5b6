// A coarser copy of a dataset, for pictures while something is dragged.
#pragma once

#include "core/record/dataset.h"

namespace nullcone::view {

/// How many of `count` pixels in a row remain if every `step`-th is taken.
int thinned(int count, int step);

/// Every `step`-th pixel along and across, from the middle of the first `step` on, with the one sample that
/// is nearest its centre (of equally near ones, the upper left); all channels. Pixels of the copy are `step`
/// pixels wide, and so are their footprints (duv). Throws InputError for a step beyond 1 to 1024, and where
/// there are several samples a pixel without the channel that tells them apart.
Dataset thin(const Dataset& dataset, int step);

}  // namespace nullcone::view
