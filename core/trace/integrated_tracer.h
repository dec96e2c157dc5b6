// A scene traced along integrated rays: needs nothing of a metric but g.
#pragma once

#include "core/trace/recorder.h"

NULLCONE_KERNEL_BEGIN

template <Metric M>
class IntegratedTracer final : public Tracer {
 public:
  IntegratedTracer(const M& metric, const Scene& scene)
      : rules_(scene),
        wanted_(scene.records.channels),
        camera_{scene.camera, {metric, scene.observer}},
        observation_{scene.observer.event},
        departure_{camera_.from, has_film(scene.camera)},
        objects_(new MarchObject<M>[rules_.objects]),
        tubes_(new std::unique_ptr<TubePart[]>[rules_.objects]),
        clocks_(new Clock[rules_.objects]),
        distortions_(new double[rules_.objects]()) {
    setting_ = {
        {metric}, scene.accuracy,        std::min(scene.max_lookback, kFar), objects_.get(), 0, rules_.sky, 0,
        kFar,     scene.records.max_hits};
    setting_.earliest = observation_[0] - std::min(scene.max_lookback_t, kFar);
  }

  /// Makes the objects ready; false, with the reason, for the first that cannot be traced.
  bool place_objects(const Scene& scene, Unfit& unfit) {
    unfit.thing = Unfit::Thing::observer;
    unfit.reason =
        "stands where no observer of this frame can be; near and in a black hole, try \"frame\": \"normal\"";
    double sum = 0;
    for (const auto& e : camera_.from.tetrad.e)
      for (const double component : e.c) sum += component;
    if (!std::isfinite(sum)) return false;
    for (std::size_t i = 0; i < rules_.objects; ++i) {
      unfit.thing = Unfit::Thing::object;
      unfit.number = i;
      const Object& object = scene.objects[i];
      const auto number = static_cast<std::uint32_t>(i + 1);
      if (rules_.is_sky(number)) continue;
      const bool placed =
          with_shape(object.shape, [&](const auto& shape) { return place(object, shape, number, unfit); });
      if (!placed) return false;
    }
    return light_.place(setting_, scene, unfit);
  }

  void trace_band(int first_line, int lines, const BandRoom& room) const override {
    constexpr std::size_t kChunk = 2048;  // rays whose columns stay in the second-level cache
    CameraRays<M> camera = camera_;
    camera.first_line = first_line;
    const auto pixels = static_cast<std::size_t>(lines) * static_cast<std::size_t>(camera.camera.width);
    BandRays rays(pixels, departure_.from_film);
    aim<Wide>(camera, setting_.lookback, rays);
    with_stepper<Wide>(setting_.accuracy.integrator, [&](auto& stepper) {
      for (std::size_t first = 0; first < pixels; first += kChunk) {
        Flights flights(std::min(kChunk, pixels - first));
        launch(stepper, rays, first, flights);
        write(stepper, flights, find_crossings(stepper, flights), first, camera, room);
      }
    });
  }

  double tau_origin(std::size_t object) const override { return clocks_[object].at_observation; }
  std::uint64_t light_doubts() const override { return light_.doubts(); }
  std::uint32_t object_about_lamp(std::size_t lamp) const override { return light_.object_about(lamp); }
  double lamp_tau_origin(std::size_t lamp) const override { return light_.tau_origin(lamp); }
  double distortion(std::size_t object) const override { return distortions_[object]; }

 private:
  /// An object that rests in the chart or, where the spacetime has isometries, moves on a geodesic.
  template <class S>
  bool place(const Object& object, const S& shape, std::uint32_t number, Unfit& unfit) {
    const Placing placing = from_observation<M>(object.placing, observation_[0]);
    const Vec4<double> event{placing.worldline.event};
    const double since = observation_[0] - object.placing.worldline.event[0];
    const M& metric = setting_.system.metric;
    if (object.course) {
      const double ball = shape.bounding_radius();
      const CourseBody<M> body =
          body_on_course(metric, *object.course, object.placing, ball, tubes_[number - 1]);
      distortions_[number - 1] = distortion_of(body, ball);
      CourseBody<M> seen = body;
      if (S::isotropic) seen.spin.rate = 0;
      return keep(Marched<CourseMap<M>, CourseBody<M>, S>{{seen, ball}, body, shape}, object, number,
                  clock_of(body, observation_[0]), unfit);
    }
    if (object.placing.type == PlacingType::coordinate) {
      const ChartBody<M> body{metric, event, axes_of(object.placing)};
      return keep(Marched<FixedMap, ChartBody<M>, S>{{spatial(event), body.axes, 1}, body, shape}, object,
                  number, clock_of<M>(object.placing, since), unfit);
    }
    if constexpr (HasIsometry<M>) {
      const LocalBody<M> body = local_body(metric, event, placing, shape.bounding_radius());
      const double rate = metric.mean_rate(four_velocity(Vec3<double>{object.placing.worldline.velocity}));
      return keep(Marched<LocalMap<M>, LocalBody<M>, S>{{body}, body, shape}, object, number,
                  clock_of<M>(object.placing, since / rate), unfit);
    } else {
      const TangentBody body = tangent_body(metric, event, axes_of(object.placing));
      distortions_[number - 1] = distortion_of(metric, body, shape.bounding_radius());
      const FixedMap map{
          spatial(event), product(body.axes, body.from_chart),
          stretch_of({spatial(body.tetrad.e[1]), spatial(body.tetrad.e[2]), spatial(body.tetrad.e[3])})};
      return keep(Marched<FixedMap, TangentBody, S>{map, body, shape}, object, number,
                  clock_of<M>(object.placing, 1 / body.tetrad.e[0][0] * since), unfit);
    }
  }

  template <class Body, class Map, class S>
  bool keep(const Marched<Map, Body, S>& marched, const Object& object, std::uint32_t number,
            const Clock& clock, Unfit& unfit) {
    unfit.reason = fault_of(setting_.system.metric, marched.body, marched.shape, object.shape, observation_);
    if (unfit.reason) return false;
    const double ball = marched.shape.bounding_radius();
    MarchObject<M>& made = objects_[setting_.count++];
    made.number = number, made.ends_rays = rules_.ends_rays(number), made.ball = ball;
    if constexpr (std::is_same_v<Map, CourseMap<M>>) {
      const Tube& tube = marched.body.tube;
      made.centre = tube.centre, made.chart_ball = tube.radius;
      for (std::size_t i = 0; i < tube.count; ++i) keep_rays_for(tube.parts[i].centre, tube.parts[i].radius);
    } else if constexpr (std::is_same_v<Map, FixedMap>) {
      made.centre = marched.map.centre;
      made.chart_ball = marched.map.stretch * ball;
      keep_rays_for(made.centre, made.chart_ball);
    } else {
      const double far = object.placing.worldline.is_static() ? 1 : 1e12;  // what moves may be met far away
      for (int n = 0; n < 64; ++n) {  // a little room, for the ball is round only to first order
        const Vec3<double> there = spatial(marched.body.event(0.0, ball * golden_point(n, 64)));
        keep_rays_for(Vec3<double>{}, far * (1.2 * norm(there) + ball));
      }
    }
    made.marched = marched;
    clocks_[number - 1] = clock;
    return true;
  }
  /// No ray may escape before it has passed a ball that holds an object or a part of its way. Of one that
  /// holds the origin, where a spacetime may have another infinity, a millionth of its radius about that is
  /// left out.
  void keep_rays_for(const Vec3<double>& centre, double radius) {
    const double distance = norm(centre);
    setting_.reach = std::max(setting_.reach, distance + radius);
    setting_.inside = std::min(setting_.inside, std::max(distance - radius, 1e-6 * radius));
  }

  template <class Stepper>
  void launch(Stepper&, const BandRays& rays, std::size_t first, Flights& flights) const {
    for (std::size_t i = 0; i < flights.count; ++i) {
      flights.list[i] = static_cast<std::uint32_t>(first + i);
      if (!rays.exists(first + i)) flights.status[i] = Status::outside;
    }
    for (std::size_t i = 0; i < flights.count; i += Lanes<Wide>::count) {
      const Group<Wide> from(flights.list.get(), i, flights.count);
      Group<Wide> group = from;
      for (std::size_t& ray : group.ray) ray -= first;
      RayStart<Wide> start{{}, from.load_k(rays)};
      if (departure_.from_film) start.event = from.load_start(rays);
      const State<Wide> y = departure_.state(start);
      group.store(Wide(kGrowth), flights.growth);
      store(group, y, flights.y);
      const Vec3<Wide> axis =
          turning_axis(spatial(to_phase(y).x), spatial(to_phase(setting_.system.rate(y)).x));
      for (std::size_t c = 0; c < 3; ++c) group.store(axis[c], flights.axis[c]);
      group.store(first_step<Stepper::kRoots>(setting_.system.metric, y, setting_.system.rate(y),
                                              setting_.accuracy.rtol),
                  flights.h);
    }
    if (departure_.from_film) look_about(flights);
  }

  /// Of rays that start at a film: which do so where there is no observer, which are too early already, and
  /// which start inside of objects.
  void look_about(Flights& flights) const {
    flights.inside.reset(new double[setting_.count * flights.count]());
    for (std::size_t i = 0; i < flights.count; ++i) {
      const auto y = State<double>::map([&](std::size_t c) { return flights.y[c][i]; });
      double sum = 0;
      for (const double component : y.c) sum += component;
      if (!std::isfinite(sum)) flights.status[i] = Status::outside;
      if (flights.status[i] == Status::outside) continue;
      if (y[0] < setting_.earliest) flights.status[i] = Status::lookback_reached;
      const Vec4<double> tangent = to_phase(setting_.system.rate(y)).x;
      for (std::size_t k = 0; k < setting_.count; ++k)
        flights.inside[k * flights.count + i] = objects_[k].holds(to_phase(y).x, tangent) ? 1 : 0;
    }
  }

  /// Follows the rays to their ends; all crossings ray by ray, the sky among them.
  template <class Stepper>
  Pool<StepCrossing> find_crossings(Stepper& stepper, Flights& flights) const {
    Trails trails(setting_, flights, rules_.onward ? flights.count : 0);
    march<Wide>(stepper, setting_, flights, rules_.onward ? &trails : nullptr);
    for (std::uint32_t i = 0; i < flights.count; ++i) {
      const bool sky = flights.status[i] == Status::sky;
      if (flights.object[i] == 0 || (rules_.onward && !sky)) continue;
      trails.found.push({flights, i, flights.object[i], flights.delta[i]});
    }
    return rules_.onward ? by_ray(trails.found, flights.count) : std::move(trails.found);
  }

  template <class Stepper>
  void write(Stepper& stepper, Flights& flights, const Pool<StepCrossing>& crossings, std::size_t first,
             const CameraRays<M>& camera, const BandRoom& room) const {
    const Recorder<Stepper, M> recorder{&stepper, &setting_, &departure_, &camera, wanted_,
                                        first,    &flights,  &crossings,  &light_};
    const auto record_objects = [&](std::uint32_t number, const std::uint32_t* list, std::size_t listed,
                                    const HitRoom& to) {
      std::size_t k = 0;
      while (objects_[k].number != number) ++k;
      with_type(objects_[k].marched, [&](const auto& object) {
        for (std::size_t i = 0; i < listed; i += Lanes<Wide>::count)
          recorder.record(object, clocks_[number - 1].origin, Group<Wide>(list, i, listed), to);
      });
    };
    const auto record_sky = [&](std::uint32_t number, const std::uint32_t* list, std::size_t listed,
                                const HitRoom& to) {
      const auto end = as_scalar<double>(number == setting_.sky[0] ? Ending::sky : Ending::second_sky);
      for (std::size_t i = 0; i < listed; i += Lanes<Wide>::count)
        recorder.record_sky(number, end, Group<Wide>(list, i, listed), to);
    };
    const HitRoom to = room.hits.extend(crossings.size());
    room.hits.keep(write_records(crossings, rules_, static_cast<std::uint32_t>(first), to,
                                 flights.status.get(), record_objects, record_sky));
    for (std::size_t i = 0; i < flights.count; ++i) {
      RayRecord& record = room.rays[first + i];
      record = {static_cast<std::uint32_t>(flights.status[i]), 0, 0, 0};
      if (flights.status[i] == Status::outside) continue;
      const auto y = State<double>::map([&](std::size_t c) { return flights.y[c][i]; });
      const double drift = std::fabs(square_of_momentum(to_phase(y), to_phase(setting_.system.rate(y))));
      // What the steps estimated and what the drift betrays, together, follow the true error better than
      // either.
      record.steps = static_cast<std::uint32_t>(flights.steps[i]);
      record.error = static_cast<float>(std::sqrt(flights.error[i] * drift));
      record.drift = static_cast<float>(drift);
    }
  }

  RecordRules rules_;
  Wanted wanted_;
  CameraRays<M> camera_;
  Vec4<double> observation_;
  Departure<M> departure_;
  std::unique_ptr<MarchObject<M>[]> objects_;
  std::unique_ptr<std::unique_ptr<TubePart[]>[]> tubes_;  ///< of those on courses
  std::unique_ptr<Clock[]> clocks_;
  std::unique_ptr<double[]> distortions_;
  MarchSetting<M> setting_;
  Illuminator<M> light_;
};

NULLCONE_KERNEL_END
