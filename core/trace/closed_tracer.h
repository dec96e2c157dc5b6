// A scene traced along closed-form paths: one object after the other, exact windows and bounds.
#pragma once

#include "core/trace/closed_search.h"
#include "core/trace/hamilton.h"
#include "core/trace/objects.h"

NULLCONE_KERNEL_BEGIN

/// The shape and placing of an object, resolved to types once.
template <Metric M, class Shape>
AnyPlaced<M> place(const M& metric, const Placing& placing, const Shape& shape) {
  const double ball = shape.bounding_radius();
  const Vec4<double> event{placing.worldline.event};
  const Matrix3<double> axes = axes_of(placing);
  if (placing.type == PlacingType::coordinate)
    return Placed<RestPlacing<M>, ChartBody<M>, Shape>{
        {metric, event, false, axes, ball}, {metric, event, axes}, shape};

  if (placing.worldline.is_static() && !placing.gyroscope_axes)
    return Placed<RestPlacing<M>, RestBody, Shape>{{metric, event, true, axes, ball}, {axes}, shape};

  // The frame of an object at rest stands in its own chart, at the origin.
  const bool rests = placing.worldline.is_static() && Shape::isotropic;
  const LocalBody<M> body = local_body(metric, rests ? Vec4<double>{} : event, placing, ball);
  if constexpr (Shape::isotropic)
    if (rests)
      return Placed<RestPlacing<M>, LocalBody<M>, Shape>{{metric, event, true, axes, ball}, body, shape};
  return Placed<MovingPlacing<M>, LocalBody<M>, Shape>{
      {body.frame, body.orbit, Shape::isotropic}, body, shape};
}

template <Metric M>
class ClosedTracer final : public Tracer {
 public:
  ClosedTracer(const M& metric, const Scene& scene)
      : metric_(metric),
        camera_(scene.camera),
        observation_{scene.observer.event},
        u_camera_(four_velocity(Vec3<double>{scene.observer.velocity})),
        lookback_(scene.max_lookback),
        count_(scene.objects.size()),
        objects_(new AnyPlaced<M>[count_]),
        origins_(new double[count_]) {
    resolution_ = 4e-15 * norm(spatial(observation_));
  }

  /// Makes the objects ready; false, with the reason, for the first that cannot be traced.
  bool place_objects(const Scene& scene, Unfit& unfit) {
    for (std::size_t i = 0; i < count_; ++i) {
      const Object& object = scene.objects[i];
      unfit.object = i;
      origins_[i] = observation_[0] - object.placing.worldline.event[0];
      if (object.shape.type == ShapeType::sky) {
        sky_ = static_cast<std::uint32_t>(i + 1);
        continue;
      }
      if (object.placing.type == PlacingType::local)
        origins_[i] /= metric_.mean_rate(four_velocity(Vec3<double>{object.placing.worldline.velocity}));
      objects_[i] =
          with_shape(object.shape, [&](const auto& shape) { return place(metric_, object.placing, shape); });
      if (!with_type(objects_[i], [&](const auto& placed) { return check(placed, object.shape, unfit); }))
        return false;
    }
    return true;
  }

  void trace_band(int first_line, int lines, const BandRoom& room) const override {
    const auto pixels = static_cast<std::size_t>(lines) * static_cast<std::size_t>(camera_.width);
    BandRays rays(pixels);
    aim<Wide>(camera_, u_camera_, first_line, lookback_, rays);
    for (std::size_t i = 0; i < count_; ++i) {
      const auto number = static_cast<std::uint32_t>(i + 1);
      if (number == sky_) continue;
      with_type(objects_[i],
                [&](const auto& placed) { search<Wide>(placed, number, observation_, resolution_, rays); });
    }
    write(rays, room);
  }

  double tau_origin(std::size_t object) const override { return origins_[object]; }
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
    const Vec4<double> observer = placed.placing.path(launch, u_camera_).at(0.0).event;
    unfit.reason = fault_of(metric_, placed.body, placed.shape, shape, observer);
    return unfit.reason == nullptr;
  }

  void write(BandRays& rays, const BandRoom& room) const {
    const std::unique_ptr<Status[]> status(new Status[rays.count]);
    for (std::size_t i = 0; i < rays.count; ++i) {
      status[i] = lookback_ < kFar ? Status::lookback_reached : Status::sky;
      if (rays.nearest[i] != 0)
        status[i] = Status::hit;
      else if (status[i] == Status::sky)
        rays.nearest[i] = sky_;
    }
    const auto record_object = [&](std::uint32_t number, const std::uint32_t* list, std::size_t listed,
                                   const std::uint32_t* place, HitRecord* hits) {
      with_type(objects_[number - 1], [&](const auto& placed) {
        for (std::size_t i = 0; i < listed; i += Lanes<Wide>::count) {
          const Group<Wide> group(list, i, listed);
          scatter(record(placed, group.load_k(rays), group.load(rays.limit)), group, number, observation_[0],
                  origins_[number - 1], place, hits);
        }
      });
    };
    const auto record_sky = [&](std::size_t i, std::uint32_t number) {
      return sky_record({{rays.k[1][i], rays.k[2][i], rays.k[3][i]}}, -1 / rays.k[0][i], number);
    };
    const HitRoom to = room.hits.extend(rays.count);
    room.hits.keep(write_records({rays.count, rays.nearest.get(), status.get()},
                                 static_cast<std::uint32_t>(count_), 0, to.hits, record_object, record_sky));
    for (std::size_t i = 0; i < rays.count; ++i)
      room.rays[i] = {static_cast<std::uint32_t>(rays.doubtful[i] ? Status::step_limit : status[i]),
                      static_cast<std::uint32_t>(rays.steps[i]), 0.0F, 0.0F};
  }

  template <class P>
  Recorded<Wide> record(const P& placed, const Vec4<Wide>& past, const Wide& found) const {
    const auto& placing = placed.placing;
    const auto path = placing.path(placing.launch(observation_), past);
    Recorded<Wide> out = record_crossing(metric_, path, placed.body, placed.shape, found,
                                         [&](const Vec4<Wide>& event) { return placing.time(event); });
    out.order = metric_.caustics(-(past[0] * out.Z), past[3] / past[0]);
    return out;
  }

  M metric_;
  Camera camera_;
  Vec4<double> observation_, u_camera_;
  double lookback_;
  std::size_t count_;
  std::unique_ptr<AnyPlaced<M>[]> objects_;
  std::unique_ptr<double[]> origins_;
  std::uint32_t sky_ = 0;
  double resolution_ = 0;
};

NULLCONE_KERNEL_END
