// Shadows along integrated rays: how much of a lamp's light comes past the objects.
#pragma once

#include "core/trace/illumination.h"
#include "core/trace/march.h"

NULLCONE_KERNEL_BEGIN

/// The objects of a scene as light on its way to a surface meets them: it goes on behind all of them, and
/// each surface takes the part `opacity` of it.
template <Metric M>
class Shades {
 public:
  void place(const MarchSetting<M>& setting, const Scene& scene) {
    setting_ = setting;
    objects_.reset(new MarchObject<M>[setting.count]);
    opacity_.reset(new double[scene.objects.size() + 1]);
    for (std::size_t i = 0; i < setting.count; ++i) {
      objects_[i] = setting.objects[i];
      objects_[i].ends_rays = false;
    }
    for (std::size_t i = 0; i < scene.objects.size(); ++i) opacity_[i + 1] = scene.objects[i].opacity;
    setting_.objects = objects_.get();
    setting_.max_hits = 0;
  }

  double opacity(std::uint32_t number) const { return opacity_[number]; }

  /// What is left of the light along connections, for the lanes that are wanted. `own`: the object that is
  /// lit; `body`: one that does not stand in the way, 0 for none.
  template <class S, class Stepper>
  S let_through(Stepper& stepper, const LitPoint<S>& lit, const Connection<S>& c, const Mask<S>& wanted,
                std::uint32_t own, std::uint32_t body) const {
    std::array<bool, Lanes<S>::count> asked{};
    Lanes<S>::store(wanted, asked.data());
    std::array<double, Lanes<S>::count> through{};
    std::array<std::size_t, Lanes<S>::count> lane_of_ray{};
    std::size_t rays = 0;
    for (std::size_t lane = 0; lane < asked.size(); ++lane)
      if (asked[lane]) lane_of_ray[rays++] = lane;
    if (rays == 0) return S(1.0);
    Flights flights(rays);
    Trails trails(setting_, rays);
    for (std::size_t ray = 0; ray < rays; ++ray) {
      through[lane_of_ray[ray]] = 1;
      launch<Stepper>(lane_of(lit, lane_of_ray[ray]), lane_of(c, lane_of_ray[ray]), own, body, ray, flights,
                      trails);
    }
    march<S>(stepper, setting_, flights, &trails);
    for (std::size_t i = 0; i < trails.found.size(); ++i) {
      const StepCrossing& met = trails.found[i];
      if (met.lambda + met.delta < flights.limit[met.ray])
        through[lane_of_ray[met.ray]] *= 1 - opacity_[met.number];
    }
    return Lanes<S>::load(through.data());
  }

 private:
  template <class Stepper>
  void launch(const LitPoint<double>& lit, const Connection<double>& c, std::uint32_t own, std::uint32_t body,
              std::size_t ray, Flights& flights, Trails& trails) const {
    const M& metric = setting_.system.metric;
    const Vec4<double> k = static_tetrad(metric, lit.event).to_chart(c.past);
    const State<double> y = to_state(Phase<double>{lit.event, metric.g(lit.event) * k}),
                        dy = setting_.system.rate(y);
    for (std::size_t i = 0; i < 8; ++i) flights.y[i][ray] = y[i];
    flights.growth[ray] = kGrowth;
    flights.limit[ray] = (1 - 1e-9) * c.lambda;  // what holds the lamp is not in its way
    flights.h[ray] = first_step<Stepper::kRoots>(metric, y, dy, setting_.accuracy.rtol);
    const Vec3<double> axis = turning_axis(spatial(lit.event), spatial(to_phase(dy).x));
    for (std::size_t i = 0; i < 3; ++i) flights.axis[i][ray] = axis[i];
    for (std::size_t i = 0; i < setting_.count; ++i) {
      const MarchObject<M>& object = setting_.objects[i];
      const std::size_t at = i * trails.rays + ray;
      const double from = object.number == own ? leaving(lit, c) : 0;
      trails.after[at] = object.number == body ? kFar : from;
      trails.side[at] = object.holds(lit.event + from * k, k) ? -1 : 1;
    }
  }

  MarchSetting<M> setting_;
  std::unique_ptr<MarchObject<M>[]> objects_;
  std::unique_ptr<double[]> opacity_;  ///< by the object's number, from 1
};

NULLCONE_KERNEL_END
