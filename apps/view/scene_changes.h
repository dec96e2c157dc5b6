// Other numbers in a scene, as the page of the viewer asks for them.
#pragma once

#include <nlohmann/json.hpp>

#include "core/scene/read_scene.h"

namespace nullcone::view {

/// Puts `changes` (null: none) into `scene`, a document that read_scene() takes; `metric` is its spacetime.
/// All entries may be left out:
///   metric     {a parameter: number}
///   observer   {event, velocity}
///   camera     {azimuth_deg, elevation_deg, roll_deg, fov_deg, resolution}
///   objects    {name: {event, velocity, radius}}; of what is fixed in the chart, the place in `event` counts
/// Objects keep their axes when they begin or cease to move, and take along the lamps whose bodies they are,
/// where both have the same worldline. Throws InputError for what is not an entry, or
/// of another kind; whether the numbers make a scene, read_scene() must say.
void apply_changes(const nlohmann::json& changes, const MetricDescription& metric, nlohmann::json& scene);

/// Resolutions that may be asked for: pixels a side, and in all.
inline constexpr double kLeastSide = 16, kMostSide = 4096, kMostPixels = 1 << 22;

/// A picture of every `step`-th pixel, with one sample each.
void make_coarser(nlohmann::json& scene, int step);

}  // namespace nullcone::view
