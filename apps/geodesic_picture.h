// The picture of an inquiry: its rays, the scene's objects and the landmarks of the spacetime, seen along z.
#pragma once

#include "apps/geodesic_inquiry.h"
#include "apps/geodesic_svg.h"

namespace nullcone {

/// `killing`: the field that carries the rays, drawn as small arrows; none where empty.
Drawing picture_of(const Inquiry& inquiry, const std::string& killing);

/// Writes the file whole or not at all; throws WorkError.
void write_picture(const Drawing& drawing, const std::string& path);

}  // namespace nullcone
