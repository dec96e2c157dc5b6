// nullcone-geodesic --connect: all light that reaches an event from a source at rest.
#pragma once

#include <ostream>

#include "apps/geodesic_options.h"

namespace nullcone {

/// Finds it and prints it, as JSON or as a table. Throws InputError for what makes no sense.
void connect_events(const GeodesicOptions& options, std::ostream& out);

}  // namespace nullcone
