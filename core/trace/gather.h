// From what a kernel finds in a band to the columns that a dataset keeps of it.
#pragma once

#include "core/trace/trace_scene.h"

namespace nullcone {

/// Traces a band of scan lines of the picture, sample by sample.
TracedBand trace_band(const Tracer& tracer, const Scene& scene, bool with_details, int first_line);

/// Of each pixel the crossings of all its samples, sorted by Z.
Band gather(const TracedBand& band, const Scene& scene);

}  // namespace nullcone
