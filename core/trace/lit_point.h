// A point of a surface on which light falls.
#pragma once

#include "core/trace/records.h"

NULLCONE_KERNEL_BEGIN

/// A crossing as its surface sees it, in the scene's chart; vectors by their components in the static tetrad
/// there.
template <class S>
struct LitPoint {
  Vec4<S> event;
  Vec4<S> u;       ///< the surface's 4-velocity
  Vec4<S> normal;  ///< lower components of its unit normal on the side that is seen
  S rounding;      ///< what rounding leaves of the place, as a length

  /// Frequency at the surface of light whose past-directed tangent is `past`.
  S frequency(const Vec4<S>& past) const {
    return past[1] * u[1] + past[2] * u[2] + past[3] * u[3] - past[0] * u[0];
  }
  /// cos(alpha) times that frequency; alpha: between the light that comes in and the normal.
  S steepness(const Vec4<S>& past) const { return dot(normal, past); }
};

/// Stands for the placing of what is traced in the scene's own chart.
struct InChart {
  template <class S>
  Vec4<S> scene_vector(const Vec4<S>&, const Vec4<S>& v) const {
    return v;
  }
};

/// Of crossings on a placing's paths.
template <class S, Metric M, class Placing>
LitPoint<S> lit_point(const M& metric, const Crossed<S>& crossed, const Placing& placing) {
  // The ray came from the side that is seen: there the shape's function falls along it, into the past.
  const S outward = select(crossed.rising < S(0.0), S(1.0), S(-1.0)) / crossed.steepness;
  const Vec4<S> u = local_components(crossed.g, static_tetrad(metric, crossed.at.event), crossed.u);
  const Vec4<S>& event = crossed.emitted;
  return {event, placing.scene_vector(event, u), placing.scene_vector(event, outward * crossed.slope),
          S(4e-15) * (norm(spatial(event)) + abs(crossed.record.Z))};
}

/// One lane of many.
template <class S>
LitPoint<double> lane_of(const LitPoint<S>& point, std::size_t lane) {
  const auto of = [&](const Vec4<S>& v) {
    return Vec4<double>::map([&](std::size_t i) { return Lanes<S>::get(v[i], lane); });
  };
  return {of(point.event), of(point.u), of(point.normal), Lanes<S>::get(point.rounding, lane)};
}

NULLCONE_KERNEL_END
