// A scene's lamps made ready: the worldlines of the points that stand for each.
#pragma once

#include "core/trace/connection.h"

NULLCONE_KERNEL_BEGIN

template <class M>
concept HasConnections = requires(const M metric) {
  { branches(metric, 1) } -> std::same_as<int>;
};

/// How a lamp's points shine: a point to all sides alike; a sphere and a rectangle as Lambertian surfaces,
/// the latter to both sides.
enum class LampShape { point, sphere, quad };

/// A lamp whose intensity is 1: along the normal of a rectangle, everywhere for a point, and for a sphere
/// where it is small enough to be one. A Line is the worldline of one of its points, on a rigid body: a
/// LampLine, or a RestLine (integrated_lamps.h).
template <class Line>
struct PlacedLamp {
  LampShape shape = LampShape::point;
  double radius = 0, half_x = 0, half_y = 0;
  std::uint32_t body = 0;  ///< object that does not stand in its light, from 1
  double weight = 1;       ///< of each point
  Clock clock;
  std::size_t count = 0;
  std::unique_ptr<Line[]> lines;  ///< of its points

  PlacedLamp() = default;
  explicit PlacedLamp(const Lamp& lamp);
  double ball() const { return sqrt(radius * radius + half_x * half_x + half_y * half_y); }

  /// What a point sends along a past-directed tangent that ends there: frequency, and the cosine (or what
  /// stands for it) of the angle to its normal. Components in the scene's chart.
  template <class S>
  std::pair<S, S> emission(const Line& line, const Connection<S>& c) const;
};

/// Points spread over a lamp, in its own frame: evenly on a golden spiral, or on a grid.
inline Vec3<double> lamp_point(const Lamp& lamp, std::size_t i, std::size_t count) {
  if (lamp.type == ShapeType::sphere)
    return lamp.radius * golden_point(static_cast<int>(i), static_cast<int>(count));
  // Rows of a lattice of rank 1: every row and every column of a grid holds one point.
  const double part = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
  const double golden = 0.61803398874989485 * (static_cast<double>(i) + 0.5);
  return {{lamp.edges[0] * (part - 0.5), lamp.edges[1] * (golden - std::floor(golden) - 0.5), 0}};
}

template <class Line>
PlacedLamp<Line>::PlacedLamp(const Lamp& lamp)
    : shape(lamp.is_point()                  ? LampShape::point
            : lamp.type == ShapeType::sphere ? LampShape::sphere
                                             : LampShape::quad),
      body(lamp.body),
      count(lamp.is_point() ? 1 : lamp.samples),
      lines(new Line[count]) {
  if (shape == LampShape::sphere) radius = lamp.radius;
  if (shape == LampShape::quad) half_x = 0.5 * lamp.edges[0], half_y = 0.5 * lamp.edges[1];
  // A sphere of radiance I/(pi R^2), or a rectangle of I/area; each point stands for an equal part.
  if (shape != LampShape::point)
    weight = (shape == LampShape::sphere ? 4.0 : 1.0) / static_cast<double>(count);
}

template <Metric M>
PlacedLamp<LampLine<M>> place_lamp(const M& metric, const Lamp& lamp, double observation) {
  PlacedLamp<LampLine<M>> out(lamp);
  const double rate = metric.mean_rate(four_velocity(Vec3<double>{lamp.placing.worldline.velocity}));
  out.clock = clock_of<M>(lamp.placing, (observation - lamp.placing.worldline.event[0]) / rate);
  const Placing placing = from_observation<M>(lamp.placing, observation);
  LampLine<M> line{metric, placing.worldline.is_static() && !placing.gyroscope_axes, {}, {}, {}};
  line.body =
      local_body(metric, Vec4<double>{placing.worldline.event}, placing, std::max(out.ball(), 1e-300));
  for (std::size_t i = 0; i < out.count; ++i) {
    line.X = lamp.is_point() ? Vec3<double>{} : lamp_point(lamp, i, out.count);
    line.place = line.body.event(0.0, line.X);
    out.lines[i] = line;
  }
  return out;
}

/// Makes lamps ready; false, with the reason, for the first that cannot shine.
template <Metric M>
bool place_lamps(const M& metric, const Lights& lights, double observation, PlacedLamp<LampLine<M>>* out,
                 Unfit& unfit) {
  for (std::size_t i = 0; i < lights.lamps.size(); ++i) {
    out[i] = place_lamp(metric, lights.lamps[i], observation);
    const LampLine<M>& line = out[i].lines[0];
    if (lights.lamps[i].is_point() || line.rests || line.body.orbit.fits()) continue;
    unfit = {Unfit::Thing::lamp, i, "is too large for its speed: a rigid local frame does not reach that far",
             line.body.orbit.largest_ball()};
    return false;
  }
  return true;
}

template <class Line>
template <class S>
std::pair<S, S> PlacedLamp<Line>::emission(const Line& line, const Connection<S>& c) const {
  using D = Dual<S, 1>;
  const Vec4<D> moving = line.event(D::variable(c.tau, 0));
  const auto u = Vec4<S>::map([&](std::size_t i) { return moving[i].d[0]; });
  const Matrix4<S> g = line.metric.g(c.emitted);
  const S frequency = -inner(g, c.tangent, u) / sqrt(inner(g, u, u));
  if (shape == LampShape::point) return {frequency, S(1.0)};

  const Tetrad<S> tetrad = static_tetrad(line.metric, c.emitted);
  const Vec4<S> past = local_components(g, tetrad, c.tangent);
  const auto along = [&](const auto& surface) {
    const Vec4<S> slope = gradient(line.body, surface, c.emitted, tetrad, c.tau);
    const S steepness =
        sqrt(slope[1] * slope[1] + slope[2] * slope[2] + slope[3] * slope[3] - slope[0] * slope[0]);
    return -dot(slope, past) / (frequency * steepness);
  };
  if (shape == LampShape::sphere) return {frequency, max(along(Sphere{radius}), S(0.0))};
  return {frequency, abs(along(Box{half_x, half_y}))};
}

NULLCONE_KERNEL_END
