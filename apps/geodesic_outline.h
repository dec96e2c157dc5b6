// What stands in the x-y plane beside the rays: objects and landmarks.
#pragma once

#include "apps/geodesic_inquiry.h"
#include "apps/geodesic_svg.h"

namespace nullcone {

/// Radius of a ball about the origin of its frame that holds a shape.
double ball_of(const Shape& shape);

/// The outlines of a scene's objects, projected along z: of those at rest where they are, of others where
/// they are at the chart time `time`. To first order in the object's size.
std::vector<Stroke> object_outlines(const Inquiry& inquiry, double time);

/// A circle about the axis that belongs to the spacetime: a horizon's equator, a throat, Gödel's radius.
std::vector<Stroke> landmarks(const Inquiry& inquiry);

}  // namespace nullcone
