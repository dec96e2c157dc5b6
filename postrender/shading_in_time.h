// When an object or a lamp looks otherwise: from a look's time slices to a shading's.
#pragma once

#include <utility>
#include <vector>

#include "postrender/coats.h"
#include "postrender/look_appearance.h"

namespace nullcone::postrender {

/// The appearance `usual` and what the slices make of it; `add(appearance)` gives the number of each.
template <class Add>
ObjectShading shading_in_time(double tau_origin, const AppearanceLook& usual,
                              const std::vector<TimeSliceLook>& time_slices, const Add& add) {
  const std::size_t first = add(usual);
  std::vector<Slice> slices;
  for (const TimeSliceLook& slice : time_slices) {
    const AppearanceLook whole = inherited(slice.appearance, usual);
    slices.push_back(slice.when);
    slices.back().appearance = add(whole);
    slices.back().timeline = whole.spectrum_in_time.timeline;
  }
  return {tau_origin, first, SliceTable(std::move(slices)), usual.spectrum_in_time.timeline};
}

}  // namespace nullcone::postrender
