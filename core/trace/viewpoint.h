// Where an observer stands and how he moves, and events beside him in his rest frame: where the rays of a
// film start.
#pragma once

#include "core/base/boost.h"
#include "core/trace/hamilton.h"

NULLCONE_KERNEL_BEGIN

/// The event at which a ray starts, and its past-directed tangent there: see Viewpoint::frame_beside.
template <class S>
struct RayStart {
  Vec4<S> event, past;
};

template <Metric M>
struct Viewpoint {
  M metric;
  Vec4<double> event, u;  ///< u: the 4-velocity, in the tetrad of the frame
  ObserverFrame frame;
  Tetrad<double> tetrad;  ///< of the frame, at the event

  Viewpoint(const M& of, const Observer& observer)
      : metric(of),
        event{observer.event},
        u(four_velocity(Vec3<double>{observer.velocity})),
        frame(observer.frame),
        tetrad(observer_tetrad(metric, event, frame)) {}

  /// The frame in which tangents of rays that start beside the observer are given.
  ObserverFrame frame_beside() const { return HasIsometry<M> ? ObserverFrame::at_rest : frame; }

  /// The ray from the place X of the observer's rest frame whose tangent is `past` (in the tetrad of the
  /// frame) there as it is here. Where there are isometries, X is what the one of the observer's event makes
  /// of the boosted (0, X), as for rigid objects, and carries the chart's static tetrad along. Else, to first
  /// order: X^i e_i is added to the event, and the tetrad is that of the frame there.
  template <class S>
  RayStart<S> aside(const Vec3<S>& X, const Vec4<S>& past) const {
    const Vec4<S> place = boost(opposite(convert<S>(u)), Vec4<S>{{S(0.0), X[0], X[1], X[2]}});
    const Vec4<S> here = convert<S>(event);
    if constexpr (HasIsometry<M>) {
      const Vec4<S> there = metric.from_origin(here, in_static_tetrad(place));
      return {there, turned_about_e3(conj(metric.turn(here, there)), in_static_tetrad(past))};
    } else {
      return {here + to_chart(place), past};
    }
  }

  /// Of a ray that starts beside the observer: the tangent's covariant components in the chart. Not finite
  /// where there is no observer of the frame.
  template <class S>
  Vec4<S> momentum(const RayStart<S>& ray) const {
    return metric.g(ray.event) * observer_tetrad(metric, ray.event, frame_beside()).to_chart(ray.past);
  }

 private:
  template <class S>
  Vec4<S> to_chart(const Vec4<S>& local) const {
    return Tetrad<S>{
        {convert<S>(tetrad.e[0]), convert<S>(tetrad.e[1]), convert<S>(tetrad.e[2]), convert<S>(tetrad.e[3])}}
        .to_chart(local);
  }
  template <class S>
  Vec4<S> in_static_tetrad(const Vec4<S>& local) const {
    if (frame == ObserverFrame::at_rest) return local;
    const Vec4<S> here = convert<S>(event);
    return local_components(metric.g(here), static_tetrad(metric, here), to_chart(local));
  }
};

NULLCONE_KERNEL_END
