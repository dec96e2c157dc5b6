// Writes the records of integrated rays.
#pragma once

#include "core/trace/illuminator.h"
#include "core/trace/neighbours.h"

NULLCONE_KERNEL_BEGIN

/// The ray through a step's start, by its exact states: what a crossing is polished on.
template <class S, class Stepper, Metric M>
struct StepPath {
  Stepper* stepper;
  const HamiltonSystem<M>* system;
  State<S> y, dy;

  PathPoint<S> at(const S& delta) const {
    const State<S> here = stepper->move(*system, y, dy, delta);
    const Vec4<S> x = to_phase(here).x, k = to_phase(system->rate(here)).x;
    const Vec4<S> local = local_components(system->metric.g(x), static_tetrad(system->metric, x), k);
    return {x, k, local};
  }
};

/// Writes the records of the crossings of a chunk of rays.
template <class Stepper, Metric M>
struct Recorder {
  Stepper* stepper;
  const MarchSetting<M>* setting;
  const Departure<M>* departure;
  const CameraRays<M>* camera;
  Wanted wanted;
  std::size_t first;  ///< ray of the chunk within the band
  const Flights* flights;
  const Pool<StepCrossing>* crossings;
  const Illuminator<M>* light;

  State<Wide> load_y(const Group<Wide>& group) const {
    return State<Wide>::map(
        [&](std::size_t c) { return group.gather([&](std::size_t i) { return (*crossings)[i].y[c]; }); });
  }
  std::array<RayStart<Wide>, 4> beside(const Group<Wide>& group) const {
    return camera->beside(group, kBesideIntegrated,
                          [&](std::size_t i) { return first + (*crossings)[i].ray; });
  }

  /// How many caustics lie before X, or (for the sky) before infinity in the direction X.
  Wide order_of(const Group<Wide>& group, const Vec3<Wide>& X) const {
    if constexpr (!is_central<M>()) return Wide(0.0);
    const auto axis = Vec3<Wide>::map([&](std::size_t c) {
      return group.gather([&](std::size_t i) { return flights->axis[c][(*crossings)[i].ray]; });
    });
    return Turning<Wide>{axis, group.gather([&](std::size_t i) { return (*crossings)[i].turns; })}.at(X);
  }

  /// Of a group of crossings with one object, whose proper times count from `origin`.
  template <class Object>
  void record(const Object& object, double origin, const Group<Wide>& group, const HitRoom& to) const {
    const State<Wide> y = load_y(group);
    const StepPath<Wide, Stepper, M> path{stepper, &setting->system, y, setting->system.rate(y)};
    Crossed<Wide> crossed =
        record_crossing(setting->system.metric, path, object.body, object.shape,
                        group.gather([&](std::size_t i) { return (*crossings)[i].delta; }),
                        [](const Vec4<Wide>& event) { return event; });
    crossed.record.Z = crossed.record.Z + group.gather([&](std::size_t i) { return (*crossings)[i].lambda; });
    crossed.record.order = order_of(group, spatial(crossed.emitted));
    const std::uint32_t number = (*crossings)[group.ray[0]].number;
    scatter(crossed.record, group, number, departure->from.event[0], origin, to.hits);
    if (to.lights)
      light->illuminate(lit_point(setting->system.metric, crossed, InChart{}), group, number,
                        departure->from.event[0], to);
    if (!to.details || !wanted.any()) return;

    Detailed<Wide> detailed;
    if (wanted.directions) {
      find_directions(crossed, object.body, object.shape, detailed);
      detailed.P = spatial(crossed.emitted - convert<Wide>(departure->from.event));
    }
    if (wanted.duv)
      detailed.duv =
          change_of_uv(crossed, object.body, object.shape,
                       event_change(*stepper, *setting, *departure, beside(group), crossed.record.Z));
    scatter(detailed, group, to.details);
  }

  /// Of a group of rays that have escaped to one sky, whose Ending is `end`.
  void record_sky(std::uint32_t number, double end, const Group<Wide>& group, const HitRoom& to) const {
    std::array<Vec3<double>, Group<Wide>::kWidth> direction{};
    for (std::size_t lane = 0; lane < group.filled; ++lane) {
      const State<double> y{(*crossings)[group.ray[lane]].y};
      direction[lane] =
          sky_direction(setting->system.metric, to_phase(y), to_phase(setting->system.rate(y)), end);
    }
    const auto far = Vec3<Wide>::map([&](std::size_t c) {
      std::array<double, Group<Wide>::kWidth> values{};
      for (std::size_t lane = 0; lane < group.filled; ++lane) values[lane] = direction[lane][c];
      return Lanes<Wide>::load(values.data());
    });
    const Wide order = order_of(group, far);
    for (std::size_t lane = 0; lane < group.filled; ++lane) {
      HitRecord& hit = to.hits[group.ray[lane]];
      hit = sky_record(direction[lane], -1 / (*crossings)[group.ray[lane]].y[4], number);
      hit.order = static_cast<std::uint32_t>(Lanes<Wide>::get(order, lane));
    }
    if (!to.details || !wanted.any()) return;

    EventChange<Wide> change{};
    if (wanted.duv) change = direction_change(*stepper, *setting, *departure, beside(group), end);
    for (std::size_t lane = 0; lane < group.filled; ++lane) {
      const auto of_lane = [&](std::size_t i) {
        return Vec3<double>::map([&](std::size_t c) { return Lanes<Wide>::get(change[i][c + 1], lane); });
      };
      to.details[group.ray[lane]] = sky_detail(normalised(direction[lane]), {of_lane(0), of_lane(1)});
    }
  }
};

NULLCONE_KERNEL_END
