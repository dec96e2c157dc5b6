// A scene traced along integrated rays: needs nothing of a metric but g.
#pragma once

#include "core/trace/march.h"

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
    const Matrix4<S> g = system->metric.g(x);
    const Tetrad<S> tetrad = static_tetrad(system->metric, x);
    const auto local = Vec4<S>::map([&](std::size_t a) {
      const S along = inner(g, k, tetrad.e[a]);
      return a == 0 ? along : -along;
    });
    return {x, k, local};
  }
};

template <Metric M>
class IntegratedTracer final : public Tracer {
 public:
  IntegratedTracer(const M& metric, const Scene& scene)
      : camera_(scene.camera),
        observation_{scene.observer.event},
        u_camera_(four_velocity(Vec3<double>{scene.observer.velocity})),
        tetrad_(observer_tetrad(metric, observation_, scene.observer.frame)),
        objects_(new MarchObject<M>[scene.objects.size()]),
        origins_(new double[scene.objects.size()]()),
        distortions_(new double[scene.objects.size()]()) {
    setting_ = {{metric}, scene.accuracy, std::min(scene.max_lookback, kFar), objects_.get(), 0, {}, 0, kFar};
    numbers_ = static_cast<std::uint32_t>(scene.objects.size());
  }

  /// Makes the objects ready; false, with the reason, for the first that cannot be traced.
  bool place_objects(const Scene& scene, Unfit& unfit) {
    unfit.object = Unfit::kObserver;
    unfit.reason =
        "stands where no observer of this frame can be; near and in a black hole, try \"frame\": \"normal\"";
    double sum = 0;
    for (const auto& e : tetrad_.e)
      for (const double component : e.c) sum += component;
    if (!std::isfinite(sum)) return false;
    for (std::size_t i = 0; i < numbers_; ++i) {
      unfit.object = i;
      const Object& object = scene.objects[i];
      const auto number = static_cast<std::uint32_t>(i + 1);
      if (object.shape.type == ShapeType::sky) {
        setting_.sky[object.shape.sky - 1U] = number;
        continue;
      }
      const bool placed =
          with_shape(object.shape, [&](const auto& shape) { return place(object, shape, number, unfit); });
      if (!placed) return false;
    }
    return true;
  }

  void trace_band(int first_line, int lines, const BandRoom& room) const override {
    constexpr std::size_t kChunk = 2048;  // rays whose columns stay in the second-level cache
    const auto pixels = static_cast<std::size_t>(lines) * static_cast<std::size_t>(camera_.width);
    BandRays rays(pixels);
    aim<Wide>(camera_, u_camera_, first_line, setting_.lookback, rays);
    with_stepper<Wide>(setting_.accuracy.integrator, [&](auto& stepper) {
      for (std::size_t first = 0; first < pixels; first += kChunk) {
        Flights flights(std::min(kChunk, pixels - first));
        launch(stepper, rays, first, flights);
        march<Wide>(stepper, setting_, flights);
        const HitRoom to = room.hits.extend(flights.count);
        room.hits.keep(
            write(stepper, flights, static_cast<std::uint32_t>(first), to.hits, room.rays.data() + first));
      }
    });
  }

  double tau_origin(std::size_t object) const override { return origins_[object]; }
  double distortion(std::size_t object) const override { return distortions_[object]; }

 private:
  /// An object that rests in the chart or, where the spacetime has isometries, moves on a geodesic.
  template <class S>
  bool place(const Object& object, const S& shape, std::uint32_t number, Unfit& unfit) {
    const Vec4<double> event{object.placing.worldline.event};
    const M& metric = setting_.system.metric;
    if (object.placing.type == PlacingType::coordinate) {
      const ChartBody<M> body{metric, event, axes_of(object.placing)};
      return keep(Marched<FixedMap, ChartBody<M>, S>{{spatial(event), body.axes, 1}, body, shape}, object,
                  number, observation_[0] - event[0], unfit);
    }
    if constexpr (HasIsometry<M>) {
      const LocalBody<M> body = local_body(metric, event, object.placing, shape.bounding_radius());
      unfit.reason =
          "moves, and its rigid frame does not reach far; with integrated paths it must be at rest";
      if (!object.placing.worldline.is_static() && body.orbit.farthest < kFar) return false;
      const double rate = metric.mean_rate(four_velocity(Vec3<double>{object.placing.worldline.velocity}));
      return keep(Marched<LocalMap<M>, LocalBody<M>, S>{{body}, body, shape}, object, number,
                  (observation_[0] - event[0]) / rate, unfit);
    } else {
      unfit.reason =
          "moves or turns like a gyroscope; in a spacetime without isometries an object must be at "
          "rest, with \"axes\": \"static\"";
      if (!object.placing.worldline.is_static() || object.placing.gyroscope_axes) return false;
      const TangentBody body = tangent_body(metric, event, axes_of(object.placing));
      distortions_[number - 1] = distortion_of(metric, body, shape.bounding_radius());
      const FixedMap map{
          spatial(event), product(body.axes, body.from_chart),
          stretch_of({spatial(body.tetrad.e[1]), spatial(body.tetrad.e[2]), spatial(body.tetrad.e[3])})};
      return keep(Marched<FixedMap, TangentBody, S>{map, body, shape}, object, number,
                  body.first_guess(observation_), unfit);
    }
  }

  template <class Body, class Map, class S>
  bool keep(const Marched<Map, Body, S>& marched, const Object& object, std::uint32_t number, double origin,
            Unfit& unfit) {
    unfit.reason = fault_of(setting_.system.metric, marched.body, marched.shape, object.shape, observation_);
    if (unfit.reason) return false;
    const double ball = marched.shape.bounding_radius();
    const double far = object.placing.worldline.is_static() ? 1 : 1e12;  // what moves may be met far away
    for (int n = 0; n < 64; ++n) {  // a little room, for the ball is round only to first order
      const double distance = norm(spatial(marched.body.event(0.0, ball * golden_point(n, 64))));
      setting_.reach = std::max(setting_.reach, far * (1.2 * distance + ball));
      setting_.inside = std::max(std::min(setting_.inside, 0.8 * distance - ball), 0.0);
    }
    MarchObject<M>& made = objects_[setting_.count++];
    made = {number, ball, {}, -1, {marched}};
    if constexpr (std::is_same_v<Map, FixedMap>) {
      made.centre = marched.map.centre;
      made.chart_ball = marched.map.stretch * ball;
    }
    origins_[number - 1] = origin;
    return true;
  }

  template <class Stepper>
  void launch(Stepper&, const BandRays& rays, std::size_t first, Flights& flights) const {
    const M& metric = setting_.system.metric;
    const Matrix4<double> g = metric.g(observation_);
    Matrix4<Wide> lowered;  // rows: g e_a
    for (std::size_t a = 0; a < 4; ++a) lowered[a] = convert<Wide>(g * tetrad_.e[a]);
    for (std::size_t i = 0; i < flights.count; ++i) flights.list[i] = static_cast<std::uint32_t>(first + i);
    for (std::size_t i = 0; i < flights.count; i += Lanes<Wide>::count) {
      const Group<Wide> from(flights.list.get(), i, flights.count);
      Group<Wide> group = from;
      for (std::size_t& ray : group.ray) ray -= first;
      const Vec4<Wide> k = from.load_k(rays);
      Phase<Wide> start{convert<Wide>(observation_), {}};
      for (std::size_t a = 0; a < 4; ++a) start.p = start.p + k[a] * lowered[a];
      const State<Wide> y = to_state(start);
      group.store(Wide(kGrowth), flights.growth);
      store(group, y, flights.y);
      group.store(first_step<Stepper::kRoots>(metric, y, setting_.system.rate(y), setting_.accuracy.rtol),
                  flights.h);
    }
  }

  template <class Stepper>
  std::size_t write(Stepper& stepper, Flights& flights, std::uint32_t first_pixel, HitRecord* hits,
                    RayRecord* rays) const {
    const auto record_object = [&](std::uint32_t number, const std::uint32_t* list, std::size_t listed,
                                   const std::uint32_t* place, HitRecord* to) {
      std::size_t k = 0;
      while (objects_[k].number != number) ++k;
      with_type(objects_[k].marched, [&](const auto& object) {
        for (std::size_t i = 0; i < listed; i += Lanes<Wide>::count) {
          const Group<Wide> group(list, i, listed);
          const State<Wide> y = load(group, flights.y);
          const StepPath<Wide, Stepper, M> path{&stepper, &setting_.system, y, setting_.system.rate(y)};
          Recorded<Wide> r =
              record_crossing(setting_.system.metric, path, object.body, object.shape,
                              group.load(flights.delta), [](const Vec4<Wide>& event) { return event[0]; });
          r.Z = r.Z + group.load(flights.lambda);
          scatter(r, group, number, observation_[0], origins_[number - 1], place, to);
        }
      });
    };
    const auto record_sky = [&](std::size_t i, std::uint32_t number) {
      const auto y = State<double>::map([&](std::size_t c) { return flights.y[c][i]; });
      const auto end = as_scalar<double>(number == setting_.sky[0] ? Ending::sky : Ending::second_sky);
      const auto direction =
          sky_direction(setting_.system.metric, to_phase(y), to_phase(setting_.system.rate(y)), end);
      return sky_record(direction, -1 / y[4], number);
    };
    const std::size_t kept = write_records({flights.count, flights.object.get(), flights.status.get()},
                                           numbers_, first_pixel, hits, record_object, record_sky);
    for (std::size_t i = 0; i < flights.count; ++i) {
      const auto y = State<double>::map([&](std::size_t c) { return flights.y[c][i]; });
      const double drift = std::fabs(square_of_momentum(to_phase(y), to_phase(setting_.system.rate(y))));
      // What the steps estimated and what the drift betrays, together, follow the true error better than
      // either.
      rays[i] = {static_cast<std::uint32_t>(flights.status[i]), static_cast<std::uint32_t>(flights.steps[i]),
                 static_cast<float>(std::sqrt(flights.error[i] * drift)), static_cast<float>(drift)};
    }
    return kept;
  }

  Camera camera_;
  Vec4<double> observation_, u_camera_;
  Tetrad<double> tetrad_;
  std::unique_ptr<MarchObject<M>[]> objects_;
  std::unique_ptr<double[]> origins_, distortions_;
  MarchSetting<M> setting_;
  std::uint32_t numbers_ = 0;
};

NULLCONE_KERNEL_END
