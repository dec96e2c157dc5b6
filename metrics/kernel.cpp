// One spacetime for one instruction set: compiled once for each pair, see CMakeLists.txt.
#include NULLCONE_METRIC_HEADER

#include "core/trace/kernel.h"
#include "core/trace/hamilton.h"

NULLCONE_KERNEL_BEGIN

using M = NULLCONE_METRIC;

#ifdef NULLCONE_ONE_LANE
using Wide = double;  // the same numbers, one ray at a time: for comparison
#else
using Wide = Pack;
#endif

M make_metric(std::span<const double> values) {
  M metric;
  std::size_t i = 0;
  std::apply([&](const auto&... parameter) { ((metric.*parameter.member = values[i++]), ...); },
             M::parameters);
  return metric;
}

template <class PlacingOrBody>
Matrix3<double> axes_of(const PlacingOrBody& placing) {
  return {Vec3<double>{placing.axes[0]}, Vec3<double>{placing.axes[1]}, Vec3<double>{placing.axes[2]}};
}

/// The shape and placing of an object, resolved to types once.
template <class Shape>
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
  LocalFrame<M> frame{metric,
                      rests ? Vec4<double>{} : event,
                      four_velocity(Vec3<double>{placing.worldline.velocity}),
                      placing.gyroscope_axes,
                      {},
                      axes};
  if (frame.gyroscope) frame.prepare();
  const LocalBody<M> body{frame, make_orbit(frame, ball)};
  if constexpr (Shape::isotropic)
    if (rests)
      return Placed<RestPlacing<M>, LocalBody<M>, Shape>{{metric, event, true, axes, ball}, body, shape};
  return Placed<MovingPlacing<M>, LocalBody<M>, Shape>{{frame, body.orbit, Shape::isotropic}, body, shape};
}

/// Whether every point of the bounding sphere can move with the object: its 4-velocity must be timelike.
template <class Body>
bool moves_timelike(const M& metric, const Body& body, double ball) {
  using D = Dual<double, 1>;
  for (int n = 0; n < 64; ++n) {
    const Vec4<D> x = body.event(D::variable(0.0, 0), convert<D>(ball * golden_point(n, 64)));
    const auto event = Vec4<double>::map([&](std::size_t i) { return x[i].v; });
    const auto u = Vec4<double>::map([&](std::size_t i) { return x[i].d[0]; });
    if (!(inner(metric.g(event), u, u) > 0)) return false;
  }
  return true;
}

class SceneTracer final : public Tracer {
 public:
  SceneTracer(const M& metric, const Scene& scene)
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
      if (object.shape.type == ShapeType::quad)
        objects_[i] =
            place(metric_, object.placing, Quad{0.5 * object.shape.edges[0], 0.5 * object.shape.edges[1]});
      else
        objects_[i] = place(metric_, object.placing, Sphere{object.shape.radius, object.shape.dome});
      if (!with_type(objects_[i], [&](const auto& placed) { return check(placed, object.shape, unfit); }))
        return false;
    }
    return true;
  }

  std::size_t trace_band(int first_line, int lines, const BandRoom& room) const override {
    const auto pixels = static_cast<std::size_t>(lines) * static_cast<std::size_t>(camera_.width);
    BandRays rays(pixels);
    aim<Wide>(camera_, u_camera_, first_line, lookback_, rays);
    for (std::size_t i = 0; i < count_; ++i) {
      const auto number = static_cast<std::uint32_t>(i + 1);
      if (number == sky_) continue;
      with_type(objects_[i],
                [&](const auto& placed) { search<Wide>(placed, number, observation_, resolution_, rays); });
    }
    return write(rays, room);
  }

  double tau_origin(std::size_t object) const override { return origins_[object]; }

 private:
  template <class P>
  bool check(const P& placed, const Shape& shape, Unfit& unfit) {
    if constexpr (requires { placed.placing.orbit; })
      if (!placed.placing.orbit.fits()) {
        unfit.reason = "is too large for its speed: a rigid local frame does not reach that far";
        unfit.limit = placed.placing.orbit.largest_ball();
        return false;
      }
    if (!moves_timelike(metric_, placed.body, placed.shape.bounding_radius())) {
      unfit.reason = "is too large: parts of it would have to move faster than light";
      return false;
    }
    const Vec4<double> observer =
        placed.placing.path(placed.placing.launch(observation_), u_camera_).at(0.0).event;
    const double tau = local_time(placed.body, observer, placed.body.first_guess(observer));
    const Vec3<double> here = placed.body.local(observer, tau).second;
    if (placed.shape.hides(here)) {
      unfit.reason = shape.type == ShapeType::quad ? "holds the observer in its surface"
                     : shape.dome
                         ? "is a dome, but the observer stands outside it"
                         : "holds the observer; a sphere that is seen from inside needs \"dome\": true";
      return false;
    }
    return true;
  }

  /// Records of all rays that met object `number`, each at its place in `hits`.
  void record_object(std::uint32_t number, BandRays& rays, const std::uint32_t* place,
                     HitRecord* hits) const {
    std::size_t listed = 0;
    for (std::size_t i = 0; i < rays.count; ++i)
      if (rays.nearest[i] == number) rays.list[listed++] = static_cast<std::uint32_t>(i);
    const double origin = origins_[number - 1];
    for (std::size_t i = 0; i < listed; i += Lanes<Wide>::count) {
      const Group<Wide> group(rays.list.get(), i, listed);
      const Recorded<Wide> r = with_type(objects_[number - 1], [&](const auto& placed) {
        return record(metric_, placed, observation_, group.load_k(rays), group.load(rays.limit));
      });
      for (std::size_t lane = 0; lane < group.filled; ++lane)
        hits[place[group.ray[lane]]] = {static_cast<std::uint32_t>(group.ray[lane]),
                                        number,
                                        static_cast<std::uint32_t>(Lanes<Wide>::get(r.order, lane)),
                                        Lanes<Wide>::get(r.Z, lane),
                                        Lanes<Wide>::get(r.u, lane),
                                        Lanes<Wide>::get(r.v, lane),
                                        Lanes<Wide>::get(r.shift, lane),
                                        Lanes<Wide>::get(r.t, lane),
                                        Lanes<Wide>::get(r.tau, lane) - origin,
                                        Lanes<Wide>::get(r.mu, lane)};
    }
  }

  std::size_t write(BandRays& rays, const BandRoom& room) const {
    const bool sky_is_seen = sky_ != 0 && !(lookback_ < kFar);
    const std::unique_ptr<std::uint32_t[]> place(new std::uint32_t[rays.count]);  // of a ray's record
    std::uint32_t hits = 0;
    for (std::size_t i = 0; i < rays.count; ++i) {
      place[i] = hits;
      hits += rays.nearest[i] != 0 || sky_is_seen;
    }
    for (std::uint32_t number = 1; number <= count_; ++number)
      if (number != sky_) record_object(number, rays, place.get(), room.hits.data());

    std::size_t kept = 0;  // records whose numbers broke down are dropped
    for (std::size_t i = 0; i < rays.count; ++i) {
      Status status = lookback_ < kFar ? Status::lookback_reached : Status::sky;
      if (rays.nearest[i] != 0) {
        const HitRecord& hit = room.hits[place[i]];
        status = finite(hit) ? Status::hit : Status::not_finite;
        if (status == Status::hit) room.hits[kept++] = hit;
      } else if (sky_is_seen) {
        const Vec4<double> past = {{rays.k[0][i], rays.k[1][i], rays.k[2][i], rays.k[3][i]}};
        room.hits[kept++] = sky_record(past, static_cast<std::uint32_t>(i));
      }
      if (rays.doubtful[i]) status = Status::step_limit;
      room.rays[i] = {static_cast<std::uint32_t>(status), static_cast<std::uint32_t>(rays.steps[i]), 0.0F,
                      0.0F};
    }
    return kept;
  }

  static bool finite(const HitRecord& hit) {
    return std::isfinite(hit.Z + hit.u + hit.v + hit.shift + hit.t + hit.tau + hit.mu);
  }

  /// The sky at infinity, by direction in the static frame: infinitely far and long ago.
  HitRecord sky_record(const Vec4<double>& past, std::uint32_t pixel) const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const auto uv = Sphere::uv(spatial(past));
    return {pixel, sky_, 0, kInfinity, uv[0], uv[1], -1 / past[0], -kInfinity, -kInfinity, 1};
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

class Kernel final : public Spacetime {
 public:
  std::string_view isa() const override { return NULLCONE_ISA_NAME; }
  MetricDescription description() const override {
    MetricDescription out{M::name, {}, skies_of<M>()};
    const M defaults;
    std::apply(
        [&](const auto&... p) {
          (out.parameters.push_back({p.name, defaults.*p.member, p.least, p.most}), ...);
        },
        M::parameters);
    return out;
  }
  double default_lookback(std::span<const double> values) const override {
    return make_metric(values).default_lookback();
  }

  std::array<Event, 4> static_tetrad(std::span<const double> values, const Event& event) const override {
    const auto tetrad = NULLCONE_ISA::static_tetrad(make_metric(values), Vec4<double>{event});
    return {tetrad.e[0].c, tetrad.e[1].c, tetrad.e[2].c, tetrad.e[3].c};
  }
  std::vector<GeodesicPoint> geodesic(std::span<const double> values, const Event& event, const Event& k,
                                      std::span<const double> lambda) const override {
    const M metric = make_metric(values);
    const auto path = metric.path(Vec4<double>{event}, Vec4<double>{k});
    std::vector<GeodesicPoint> out;
    for (const double l : lambda) {
      const auto P = path.at(l);
      out.push_back({l, P.event.c, P.tangent.c});
    }
    return out;
  }
  double walk(std::span<const double> values, const Event& event, const Event& k, double step,
              std::size_t count) const override {
    const M metric = make_metric(values);
    const auto path = metric.path(convert<Wide>(Vec4<double>{event}), convert<Wide>(Vec4<double>{k}));
    std::array<double, Lanes<Wide>::count> first{};
    for (std::size_t lane = 0; lane < first.size(); ++lane) first[lane] = static_cast<double>(lane) * step;
    Wide lambda = Lanes<Wide>::load(first.data()), sum(0.0);
    for (std::size_t i = 0; i < count; i += first.size()) {
      const Vec4<Wide> x = path.at(lambda).event;
      sum = sum + ((x[0] + x[1]) + (x[2] + x[3]));
      lambda = lambda + Wide(step * static_cast<double>(first.size()));
    }
    Lanes<Wide>::store(sum, first.data());
    double total = 0;
    for (const double lane : first) total += lane;
    return total;
  }
  std::vector<NamedValue> conserved(std::span<const double> values,
                                    const GeodesicPoint& point) const override {
    std::vector<NamedValue> out;
    for (const auto& [name, value] :
         make_metric(values).conserved(Vec4<double>{point.event}, Vec4<double>{point.tangent}))
      out.push_back({name, value});
    return out;
  }

  std::unique_ptr<Tracer> prepare(std::span<const double> values, const Scene& scene,
                                  Unfit& unfit) const override {
    auto tracer = std::make_unique<SceneTracer>(make_metric(values), scene);
    if (!tracer->place_objects(scene, unfit)) return nullptr;
    return tracer;
  }
};

NULLCONE_KERNEL_END

namespace nullcone {

const Spacetime& NULLCONE_FACTORY() {
  static const NULLCONE_ISA::Kernel kernel;
  return kernel;
}

}  // namespace nullcone
