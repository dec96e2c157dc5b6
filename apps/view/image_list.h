// The images of an object, in the order in which their light set out.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/record/dataset.h"

namespace nullcone::view {

/// Connected regions (by sides and corners) of pixels in which the object is crossed with the same order, be
/// it the nearest crossing or one behind; the earliest mean t first, or without t the farthest. Rows are
/// counted in the whole picture. Where the camera closes on itself the left and the right edge meet; the box
/// of an image across it goes on beyond the right edge. Of more than 200 the largest are told, and how many
/// were `omitted`. Throws InputError for a name that there is not.
nlohmann::ordered_json images_of(const Dataset& dataset, const std::string& object);

}  // namespace nullcone::view
