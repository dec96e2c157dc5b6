// Objects among integrated rays: where a ray is in their frame, and where a step first meets them.
#pragma once

#include "core/trace/any_shape.h"
#include "core/trace/course_ray.h"
#include "core/trace/objects.h"
#include "core/trace/with_type.h"

NULLCONE_KERNEL_BEGIN

/// Where an event on a ray is in the object's frame, and how fast it moves there.
template <class S>
struct Located {
  Vec3<S> X, slope;
};

/// Of objects that are fixed in the chart: linear in the coordinates, X = to_object (x - centre).
struct FixedMap {
  Vec3<double> centre;
  Matrix3<double> to_object;
  double stretch;  ///< a length in the object's frame is at most so many times as long in the chart

  template <class S>
  Located<S> locate(const Vec4<S>& event, const Vec4<S>& tangent) const {
    const auto rows = convert<S>(to_object);
    return {rows * (spatial(event) - convert<S>(centre)), rows * spatial(tangent)};
  }
};

/// Of objects that an isometry carries: Newton's method for the proper time, and implicit differentiation.
template <Metric M>
struct LocalMap {
  LocalBody<M> body;

  template <class S>
  Located<S> locate(const Vec4<S>& event, const Vec4<S>& tangent) const {
    const Aboard<S> out = aboard(body, event, tangent, body.first_guess(event));
    return {out.X, out.slope};
  }
};

/// Of objects on courses.
template <Metric M>
struct CourseMap {
  CourseBody<M> body;  ///< of round shapes without their spin: nothing is seen of it
  double ball;

  template <class S>
  Located<S> locate(const Vec4<S>& event, const Vec4<S>& tangent) const {
    const Nearby<S> nearby = body.tube.near(event, S(1.0), S(1.0));
    const Aboard<S> out = aboard(body, event, tangent, nearby.tau);
    const auto there = (nearby.clearance <= S(0.0)) & is_trusted(nearby, out);
    return {select(there, out.X, Vec3<S>{{S(kOutOfReach), S(0.0), S(0.0)}}), out.slope};
  }

  /// Whether a step that runs in a capsule, from time t0 to t1, may meet a part of the tube.
  template <class S>
  Mask<S> may_come_near(const Capsule<S>& capsule, const S& t0, const S& t1) const {
    const Tube& tube = body.tube;
    const S middle = S(0.5) * (t0 + t1), half = S(0.6) * abs(t1 - t0);
    Mask<S> out = half < S(0.0);
    for (std::size_t i = 0; i < tube.count; ++i) {
      const TubePart& part = tube.parts[i];
      S late = middle - S(part.t);
      if (tube.period_t != 0) late = late - S(tube.period_t) * floor(S(1 / tube.period_t) * late + S(0.5));
      const auto in_time = abs(late) <= S(part.half_t) + half;
      out = out | (in_time & capsule.touches(convert<S>(part.centre), S(part.radius)));
    }
    return out;
  }

  /// The ray of a step, from evenly spaced states of it.
  template <class S, std::size_t n>
  auto ray(const std::array<Phase<S>, n>& at, const std::array<Phase<S>, n>& rate, const S& length) const {
    return CourseRay<S, CourseBody<M>, StepWay<S, n>>{&body, ball, {at, rate, length}};
  }
};

/// For the record: a rigid object at rest in a spacetime without isometries, to first order in X: the point Y
/// of the static tetrad e_a at P, at proper time tau, is the event P + tau e_0 + Y^i e_i (docs/physics.md,
/// section on local objects).
struct TangentBody {
  Vec4<double> place;
  Tetrad<double> tetrad;       ///< at `place`; e_0 along t
  Matrix3<double> from_chart;  ///< inverse of the spatial parts of e_1 … e_3
  Matrix3<double> axes;

  template <class S>
  std::pair<S, Vec3<S>> local(const Vec4<S>& event, const S& tau) const {
    const Vec4<S> x = event - convert<S>(place);
    const Vec3<S> Y = convert<S>(from_chart) * spatial(x);
    S t = x[0];
    for (std::size_t i = 0; i < 3; ++i) t = t - S(tetrad.e[i + 1][0]) * Y[i];
    return {S(1 / tetrad.e[0][0]) * t - tau, convert<S>(axes) * Y};
  }
  template <class S>
  Vec4<S> event(const S& tau, const Vec3<S>& X) const {
    const Vec3<S> Y = X[0] * convert<S>(axes[0]) + X[1] * convert<S>(axes[1]) + X[2] * convert<S>(axes[2]);
    return convert<S>(place) + (tau * convert<S>(tetrad.e[0]) + Y[0] * convert<S>(tetrad.e[1]) +
                                Y[1] * convert<S>(tetrad.e[2]) + Y[2] * convert<S>(tetrad.e[3]));
  }
  template <class S>
  S first_guess(const Vec4<S>& event) const {
    return S(1 / tetrad.e[0][0]) * (event[0] - S(place[0]));
  }
};

/// An upper bound of how much a matrix with these columns stretches: the root of its row and column norms'
/// product.
inline double stretch_of(const std::array<Vec3<double>, 3>& columns) {
  double largest_column = 0, largest_row = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    double column = 0, row = 0;
    for (std::size_t j = 0; j < 3; ++j) column += std::fabs(columns[i][j]), row += std::fabs(columns[j][i]);
    largest_column = std::max(largest_column, column);
    largest_row = std::max(largest_row, row);
  }
  return std::sqrt(largest_column * largest_row);
}

inline Matrix3<double> product(const Matrix3<double>& a, const Matrix3<double>& b) {
  Matrix3<double> out;
  for (std::size_t i = 0; i < 3; ++i) out[i] = a[i][0] * b[0] + a[i][1] * b[1] + a[i][2] * b[2];
  return out;
}

template <Metric M>
TangentBody tangent_body(const M& metric, const Vec4<double>& place, const Matrix3<double>& axes) {
  const Tetrad<double> tetrad = static_tetrad(metric, place);
  Matrix3<double> columns;  // of the spatial parts of e_1 … e_3, and of their inverse: rows of cofactors
  for (std::size_t i = 0; i < 3; ++i) columns[i] = spatial(tetrad.e[i + 1]);
  const double scale = 1 / dot(columns[0], cross(columns[1], columns[2]));
  return {place,
          tetrad,
          {scale * cross(columns[1], columns[2]), scale * cross(columns[2], columns[0]),
           scale * cross(columns[0], columns[1])},
          axes};
}

/// The largest relative error of lengths at the surface of a ball in the body's frame: how far the frame's
/// vectors are from orthonormal there.
template <Metric M>
double distortion_of(const M& metric, const TangentBody& body, double ball) {
  double worst = 0;
  for (int n = 0; n < 64; ++n)
    worst = std::max(worst, skewness(metric.g(body.event(0.0, ball * golden_point(n, 64))), body.tetrad.e));
  return 0.5 * worst;  // lengths are roots
}

/// An object made ready: as the search sees it, and as the record sees it.
template <class Map, class Body, class Shape>
struct Marched {
  Map map;
  Body body;
  Shape shape;
};
template <Metric M, bool = HasIsometry<M>>
struct AnyMarched {
  using Type =
      std::variant<Marched<FixedMap, ChartBody<M>, Sphere>, Marched<FixedMap, ChartBody<M>, AnyShape>,
                   Marched<FixedMap, TangentBody, Sphere>, Marched<FixedMap, TangentBody, AnyShape>,
                   Marched<CourseMap<M>, CourseBody<M>, Sphere>,
                   Marched<CourseMap<M>, CourseBody<M>, AnyShape>>;
};
template <Metric M>
struct AnyMarched<M, true> {
  using Type =
      std::variant<Marched<FixedMap, ChartBody<M>, Sphere>, Marched<FixedMap, ChartBody<M>, AnyShape>,
                   Marched<LocalMap<M>, LocalBody<M>, Sphere>, Marched<LocalMap<M>, LocalBody<M>, AnyShape>,
                   Marched<CourseMap<M>, CourseBody<M>, Sphere>,
                   Marched<CourseMap<M>, CourseBody<M>, AnyShape>>;
};

template <Metric M>
struct MarchObject {
  std::uint32_t number = 0;  ///< from 1
  bool ends_rays = true;     ///< no ray goes on behind it
  double ball = 0;           ///< bounding radius in the object's frame
  /// A ball of chart coordinates that holds the object at all times, if there is one; else negative.
  Vec3<double> centre{};
  double chart_ball = -1;
  typename AnyMarched<M>::Type marched{};

  /// Whether a step from `from` to `to`, in the chart within `capsule`, may meet the object at all.
  template <class S>
  Mask<S> may_come_near(const Capsule<S>& capsule, const Phase<S>& from, const Phase<S>& rate,
                        const Phase<S>& to, const Phase<S>& end_rate, const S& length) const {
    const Mask<S> near = capsule.touches(convert<S>(centre), S(chart_ball));
    if (chart_ball >= 0 && !any(near)) return near;
    return with_type(marched, [&](const auto& object) -> Mask<S> {
      using Map = std::decay_t<decltype(object.map)>;
      if constexpr (std::is_same_v<Map, FixedMap>) return near;
      if constexpr (std::is_same_v<Map, CourseMap<M>>)
        return near & object.map.may_come_near(capsule, from.x[0], to.x[0]);
      const Located<S> a = object.map.locate(from.x, rate.x), b = object.map.locate(to.x, end_rate.x);
      return Capsule<S>(a.X, a.slope, b.X, b.slope, length).touches(Vec3<S>{}, S(ball));
    });
  }

  bool starts_inside() const {
    return with_type(marched, [](const auto& object) { return object.shape.starts_inside(); });
  }

  /// Whether an event, which something with this tangent passes, is within the object.
  bool holds(const Vec4<double>& event, const Vec4<double>& tangent) const {
    return with_type(
        marched, [&](const auto& object) { return object.shape.holds(object.map.locate(event, tangent).X); });
  }

  /// f(curve, shape), from evenly spaced states of a step; a curve is what `advance` walks along.
  template <class S, std::size_t n, class F>
  decltype(auto) with_curve(const std::array<Phase<S>, n>& at, const std::array<Phase<S>, n>& rate,
                            const S& length, F&& f) const {
    return with_type(marched, [&](const auto& object) {
      if constexpr (requires { object.map.body.tube; })
        return f(object.map.ray(at, rate, length), object.shape);
      std::array<Vec3<S>, n> X, slope;
      for (std::size_t k = 0; k < n; ++k) {
        const Located<S> here = object.map.locate(at[k].x, rate[k].x);
        X[k] = here.X, slope[k] = here.slope;
      }
      return f(Curve<S, n>(X, slope, length), object.shape);
    });
  }

  /// The first crossing within 0 < delta < limit of a step.
  template <class S, std::size_t n>
  Search<S> first_crossing(const std::array<Phase<S>, n>& at, const std::array<Phase<S>, n>& rate,
                           const S& length, const S& limit) const {
    return with_curve(at, rate, length, [&](const auto& curve, const auto& shape) {
      return NULLCONE_ISA::first_crossing(curve, shape, limit, S(1e-13) * length);
    });
  }
};

NULLCONE_KERNEL_END
