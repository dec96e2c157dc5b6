// What nullcone-geodesic prints.
#pragma once

#include <ostream>

#include "apps/geodesic_inquiry.h"

namespace nullcone {

void write_json(const Inquiry& inquiry, std::ostream& out);

/// One table for all members, a row a point; the crossing of a pixel's ray stands in the row of its point.
void write_csv(const Inquiry& inquiry, std::ostream& out);

}  // namespace nullcone
