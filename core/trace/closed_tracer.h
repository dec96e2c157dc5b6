// A scene traced along closed-form paths: one object after the other, exact windows and bounds.
#pragma once

#include "core/trace/closed_shadow.h"
#include "core/trace/details.h"
#include "core/trace/hamilton.h"
#include "core/trace/objects.h"
#include "core/trace/time_limit.h"

NULLCONE_KERNEL_BEGIN

/// The shape and placing of an object, resolved to types once. `margin`: how much larger than the shape the
/// ball is outside of which the search does not look.
template <Metric M, class Shape>
AnyPlaced<M> place(const M& metric, const Placing& placing, const Course* course, const Shape& shape,
                   double margin, std::unique_ptr<TubePart[]>& tube) {
  const double ball = shape.bounding_radius(), wide = margin * ball;
  if (course != nullptr) {
    const CourseBody<M> body = body_on_course(metric, *course, placing, wide, tube);
    CourseBody<M> seen = body;
    if (Shape::isotropic) seen.spin.rate = 0;
    return Placed<CoursePlacing<M>, CourseBody<M>, Shape>{{seen, wide}, body, shape};
  }
  const Vec4<double> event{placing.worldline.event};
  const Matrix3<double> axes = axes_of(placing);
  if (placing.type == PlacingType::coordinate)
    return Placed<RestPlacing<M>, ChartBody<M>, Shape>{
        {metric, event, false, axes, wide}, {metric, event, axes}, shape};

  if (stands_still(placing))
    return Placed<RestPlacing<M>, RestBody, Shape>{{metric, event, true, axes, wide}, {axes}, shape};

  // The frame of an object at rest stands in its own chart, at the origin.
  const bool rests = placing.worldline.is_static() && Shape::isotropic;
  const LocalBody<M> body = local_body(metric, rests ? Vec4<double>{} : event, placing, ball);
  if constexpr (Shape::isotropic)
    if (rests)
      return Placed<RestPlacing<M>, LocalBody<M>, Shape>{{metric, event, true, axes, wide}, body, shape};
  return Placed<MovingPlacing<M>, LocalBody<M>, Shape>{
      {body.frame, body.orbit, Shape::isotropic, wide}, body, shape};
}

template <Metric M>
class ClosedTracer final : public Tracer {
 public:
  ClosedTracer(const M& metric, const Scene& scene)
      : metric_(metric),
        rules_(scene),
        wanted_(scene.records.channels),
        camera_{scene.camera, {metric, scene.observer}},
        observation_{scene.observer.event},
        lookback_(scene.max_lookback),
        lookback_t_(scene.max_lookback_t),
        objects_(new AnyPlaced<M>[rules_.objects]),
        tubes_(new std::unique_ptr<TubePart[]>[rules_.objects]),
        clocks_(new Clock[rules_.objects]),
        opacities_(new double[rules_.objects]),
        light_rules_(scene.lights),
        lamps_(new PlacedLamp<LampLine<M>>[light_rules_.lamps]) {}

  /// Makes the objects ready; false, with the reason, for the first that cannot be traced.
  bool place_objects(const Scene& scene, Unfit& unfit) {
    // Where rays go on behind a surface, rounding must not carry them past the ball before they have left.
    const double margin = rules_.onward ? 1.001 : 1;
    for (std::size_t i = 0; i < rules_.objects; ++i) {
      const Object& object = scene.objects[i];
      unfit.number = i;
      double rate = 1;
      if (object.placing.type == PlacingType::local)
        rate = metric_.mean_rate(four_velocity(Vec3<double>{object.placing.worldline.velocity}));
      clocks_[i] = clock_of<M>(object.placing, (observation_[0] - object.placing.worldline.event[0]) / rate);
      opacities_[i] = object.opacity;
      if (object.shape.type == ShapeType::sky) continue;
      const Placing placing =
          object.course ? object.placing : from_observation<M>(object.placing, observation_[0]);
      objects_[i] = with_shape(object.shape, [&](const auto& shape) {
        return place(metric_, placing, object.course.get(), shape, margin, tubes_[i]);
      });
      with_type(objects_[i], [&](const auto& placed) {
        if constexpr (requires { placed.body.tube; }) clocks_[i] = clock_of(placed.body, observation_[0]);
      });
      if (!with_type(objects_[i], [&](const auto& placed) { return check(placed, object.shape, unfit); }))
        return false;
    }
    return place_lamps(metric_, scene.lights, observation_[0], lamps_.get(), unfit);
  }

  void trace_band(int first_line, int lines, const BandRoom& room) const override {
    CameraRays<M> camera = camera_;
    camera.first_line = first_line;
    BandRays rays(static_cast<std::size_t>(lines) * static_cast<std::size_t>(camera.camera.width),
                  has_film(camera.camera));
    aim<Wide>(camera, lookback_, rays);
    if (lookback_t_ < kFar) end_in_the_past<Wide>(metric_, observation_, lookback_t_, rays);
    for_each_object(true, [&](const auto& placed, std::uint32_t number) {
      search<Wide>(placed, number, observation_, rays);
    });
    write(camera, rays, find_crossings(rays), room);
  }

  double tau_origin(std::size_t object) const override { return clocks_[object].at_observation; }
  std::uint64_t light_doubts() const override { return 0; }
  std::uint32_t object_about_lamp(std::size_t lamp) const override {
    const Vec4<double> event = lamps_[lamp].lines[0].event(lamps_[lamp].clock.origin);
    for (std::uint32_t number = 1; number <= rules_.objects; ++number) {
      if (rules_.is_sky(number) || number == lamps_[lamp].body || opacities_[number - 1] < 1) continue;
      const bool holds = with_type(objects_[number - 1], [&](const auto& placed) {
        const auto path = placed.placing.path(placed.placing.launch(event), Vec4<double>{{1, 0, 0, 0}});
        return holds_event(placed.body, placed.shape, path.at(0.0).event);
      });
      if (holds) return number;
    }
    return 0;
  }
  double lamp_tau_origin(std::size_t lamp) const override { return lamps_[lamp].clock.at_observation; }
  double distortion(std::size_t) const override { return 0; }

 private:
  template <class P>
  bool check(const P& placed, const Shape& shape, Unfit& unfit) {
    if constexpr (requires { placed.placing.orbit; })
      if (!placed.placing.orbit.fits()) {
        unfit.reason = "is too large for its speed: a rigid local frame does not reach that far";
        unfit.limit = placed.placing.orbit.largest_ball();
        return false;
      }
    const auto launch = placed.placing.launch(observation_);
    const Vec4<double> observer = placed.placing.path(launch, camera_.from.u).at(0.0).event;
    unfit.reason = fault_of(metric_, placed.body, placed.shape, shape, observer);
    return unfit.reason == nullptr;
  }

  /// Whether rays end before they escape.
  bool is_bounded() const { return lookback_ < kFar || lookback_t_ < kFar; }

  /// f(placed, number) for the objects at which rays end, or for the others.
  template <class F>
  void for_each_object(bool ends_rays, F&& f) const {
    for (std::uint32_t number = 1; number <= rules_.objects; ++number)
      if (!rules_.is_sky(number) && rules_.ends_rays(number) == ends_rays)
        with_type(objects_[number - 1], [&](const auto& placed) { f(placed, number); });
  }

  /// All crossings, ray by ray: the nearest with an opaque surface, which is known already, what lies before
  /// it, and the sky behind.
  Pool<Crossing> find_crossings(BandRays& rays) const {
    const auto add_ends = [&](Pool<Crossing>& found) {
      for (std::uint32_t i = 0; i < rays.count; ++i)
        if (rays.nearest[i] != 0)
          found.push({i, rays.nearest[i], rays.limit[i]});
        else if (!is_bounded() && rules_.sky[0] != 0 && rays.exists(i))
          found.push({i, rules_.sky[0], rays.limit[i]});
    };
    if (!rules_.onward) {
      Pool<Crossing> found(rays.count);
      add_ends(found);
      return found;
    }
    Onwards onwards(rays);
    for_each_object(false, [&](const auto& placed, std::uint32_t number) {
      search_onward<Wide>(placed, number, observation_, rays, onwards);
    });
    add_ends(onwards.found);
    return by_ray(onwards.found, rays.count);
  }

  void write(const CameraRays<M>& camera, const BandRays& rays, const Pool<Crossing>& crossings,
             const BandRoom& room) const {
    const std::unique_ptr<Status[]> status(new Status[rays.count]);
    for (std::size_t i = 0; i < rays.count; ++i)
      status[i] = !rays.exists(i) ? Status::outside : is_bounded() ? Status::lookback_reached : Status::sky;
    const auto record_objects = [&](std::uint32_t number, const std::uint32_t* list, std::size_t listed,
                                    const HitRoom& to) {
      with_type(objects_[number - 1], [&](const auto& placed) {
        for (std::size_t i = 0; i < listed; i += Lanes<Wide>::count)
          record(placed, camera, rays, crossings, Group<Wide>(list, i, listed), to);
      });
    };
    const auto record_sky = [&](std::uint32_t number, const std::uint32_t* list, std::size_t listed,
                                const HitRoom& to) {
      for (std::size_t n = 0; n < listed; ++n) {
        const std::size_t i = list[n], ray = crossings[i].ray;
        const Vec3<double> direction = {{rays.k[1][ray], rays.k[2][ray], rays.k[3][ray]}};
        to.hits[i] = sky_record(direction, -1 / rays.k[0][ray], number);
        if (to.details && wanted_.any()) to.details[i] = detail_of_sky(camera, ray, direction);
      }
    };
    const HitRoom to = room.hits.extend(crossings.size());
    room.hits.keep(write_records(crossings, rules_, 0, to, status.get(), record_objects, record_sky));
    for (std::size_t i = 0; i < rays.count; ++i)
      room.rays[i] = {static_cast<std::uint32_t>(rays.doubtful[i] ? Status::step_limit : status[i]),
                      static_cast<std::uint32_t>(rays.steps[i]), 0.0F, 0.0F};
  }

  /// Writes the records of a group of crossings with one object, and what else is asked for.
  template <class P>
  void record(const P& placed, const CameraRays<M>& camera, const BandRays& rays,
              const Pool<Crossing>& crossings, const Group<Wide>& group, const HitRoom& to) const {
    const auto ray_of = [&](std::size_t i) -> std::size_t { return crossings[i].ray; };
    const auto past = Vec4<Wide>::map(
        [&](std::size_t c) { return group.gather([&](std::size_t i) { return rays.k[c][ray_of(i)]; }); });
    const auto& placing = placed.placing;
    const auto launch = placing.launch(observation_);
    const auto path_of = [&](const RayStart<Wide>& ray) {
      return rays.from_film() ? placing.path(placing.launch(ray.event), ray.past)
                              : placing.path(launch, ray.past);
    };
    RayStart<Wide> start{{}, past};
    for (std::size_t c = 0; rays.from_film() && c < 4; ++c)
      start.event[c] = group.gather([&](std::size_t i) { return rays.start[c][ray_of(i)]; });
    const auto path = path_of(start);
    Crossed<Wide> crossed =
        record_crossing(metric_, path, placed.body, placed.shape,
                        group.gather([&](std::size_t i) { return crossings[i].lambda; }),
                        [&](const Vec4<Wide>& event) { return placing.scene_event(event); });
    crossed.record.order = metric_.caustics(-(past[0] * crossed.record.Z), past[3] / past[0]);
    const std::uint32_t number = crossings[group.ray[0]].number;
    scatter(crossed.record, group, number, observation_[0], clocks_[number - 1].origin, to.hits);
    if (to.lights) light_up(lit_point(metric_, crossed, placing), group, number, to);
    if (!to.details || !wanted_.any()) return;

    Detailed<Wide> detailed;
    if (wanted_.directions) {
      find_directions(crossed, placed.body, placed.shape, detailed);
      detailed.P = spatial(crossed.emitted - convert<Wide>(observation_));
    }
    if (wanted_.duv) {
      const auto beside = camera.beside(group, kBeside, ray_of);
      const auto event = [&](std::size_t i) { return path_of(beside[i]).at(crossed.here.lambda).event; };
      const Wide scale(0.5 / kBeside);
      detailed.duv = change_of_uv(crossed, placed.body, placed.shape,
                                  {scale * (event(0) - event(1)), scale * (event(2) - event(3))});
    }
    scatter(detailed, group, to.details);
  }

  /// Writes what the lamps send to a group of crossings with object number `own`.
  void light_up(const LitPoint<Wide>& lit, const Group<Wide>& group, std::uint32_t own,
                const HitRoom& to) const {
    const auto let_through = [&](const Connection<Wide>& c, const Mask<Wide>& wanted, std::uint32_t body) {
      Wide through(1.0);
      if (!light_rules_.shadows) return through;
      const Wide limit =
          select(wanted, Wide(1 - 1e-9) * c.lambda, Wide(0.0));  // what holds the lamp is not in its way
      for (std::uint32_t number = 1; number <= rules_.objects; ++number) {
        if (number == body || rules_.is_sky(number)) continue;
        const Wide start = number == own ? leaving(lit, c) : Wide(0.0);
        const Wide until = select(through > Wide(0.0), limit, Wide(0.0));
        through = through * with_type(objects_[number - 1], [&](const auto& placed) {
                    return let_past(placed, opacities_[number - 1], lit, c, start, until);
                  });
      }
      return through;
    };
    illuminate(metric_, lamps_.get(), light_rules_, lit, group, observation_[0], let_through, to);
  }

  HitDetail detail_of_sky(const CameraRays<M>& camera, std::size_t ray, const Vec3<double>& direction) const {
    const auto list = static_cast<std::uint32_t>(ray);
    const auto beside = camera.beside(Group<double>(&list, 0, 1), kBeside, [](std::size_t i) { return i; });
    const double scale = 0.5 / kBeside;
    return sky_detail(direction, {scale * spatial(beside[0].past - beside[1].past),
                                  scale * spatial(beside[2].past - beside[3].past)});
  }

  /// Part of a pixel by which neighbouring rays stand aside: differences are good to its square.
  static constexpr double kBeside = 0.0625;

  M metric_;
  RecordRules rules_;
  Wanted wanted_;
  CameraRays<M> camera_;
  Vec4<double> observation_;
  double lookback_, lookback_t_;
  std::unique_ptr<AnyPlaced<M>[]> objects_;
  std::unique_ptr<std::unique_ptr<TubePart[]>[]> tubes_;  ///< of those on courses
  std::unique_ptr<Clock[]> clocks_;
  std::unique_ptr<double[]> opacities_;
  LightRules light_rules_;
  std::unique_ptr<PlacedLamp<LampLine<M>>[]> lamps_;
};

NULLCONE_KERNEL_END
