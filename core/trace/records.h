// What a record says about a crossing, and how the records of many rays come into the order of the pixels.
#pragma once

#include <cmath>
#include <limits>

#include "core/base/status.h"
#include "core/trace/any_shape.h"
#include "core/trace/crossing.h"
#include "core/trace/crossings.h"
#include "core/trace/spacetime.h"

NULLCONE_KERNEL_BEGIN

/// Everything about some crossings, side by side. `t` is the emission event's chart time.
template <class S>
struct Recorded {
  S order, Z, u, v, shift, t, tau, mu;
};

/// The same, with what details (details.h) are made of.
template <class S>
struct Crossed {
  Recorded<S> record;
  Meeting<S> here;
  PathPoint<S> at;
  Matrix4<S> g;
  Vec4<S> u;        ///< the surface's 4-velocity
  S frequency;      ///< that it emits
  Vec4<S> slope;    ///< gradient whose direction is the normal, along the vectors of the static tetrad
  S steepness;      ///< length of that gradient
  S rising;         ///< change of the shape's function along the ray, into the past
  Vec4<S> emitted;  ///< the event in the scene's chart
  S lean;           ///< of a normal that is not the surface's: how much of the surface's was added to it
};

/// Puts the normal that shading takes in the place of the surface's, whose gradient is `slope` and rises by
/// `rising` along the ray. A normal on whose back the ray looks leans over until it sees it edge-on: which
/// side is seen, is the surface's affair. Returns by how much.
template <class S, class Body, class Shape>
S take_shading_normal(const Body& body, const Shape& shape, const Meeting<S>& here, const PathPoint<S>& P,
                      const Tetrad<S>& tetrad, const S& rising, Vec4<S>& slope) {
  const Vec4<S> shading = gradient(body, shape.shading(here.X), P.event, tetrad, here.tau);
  const S lean = min(max(S(0.0), S(0.0) - dot(shading, P.local) / rising), S(1e9));
  slope = shading + lean * slope;
  return lean;
}

/// The crossing of a path with an object near the affine length `found`. Paths and bodies share a chart, and
/// `scene_event` gives the scene's chart coordinates of its events.
template <class S, Metric M, class Path, class Body, class Shape, class SceneEvent>
Crossed<S> record_crossing(const M& metric, const Path& path, const Body& body, const Shape& shape,
                           const S& found, const SceneEvent& scene_event) {
  const Vec4<S> near = path.at(found).event;
  const auto surface =
      surface_near(shape, body.local(near, local_time(body, near, body.first_guess(near))).second);
  const Meeting<S> here = polish(path, body, surface, found);
  const PathPoint<S> P = path.at(here.lambda);
  const Matrix4<S> g = metric.g(P.event);

  // The surface's 4-velocity: d/dtau at a fixed point of the object.
  using D = Dual<S, 1>;
  const Vec4<D> moving = body.event(D::variable(here.tau, 0), convert<D>(here.X));
  const auto u = Vec4<S>::map([&](std::size_t i) { return moving[i].d[0]; });
  const S length = sqrt(inner(g, u, u)), frequency = -inner(g, P.tangent, u) / length;

  // The emission angle: between the photon and the unit normal, on the side to which the photon leaves.
  const Tetrad<S> tetrad = static_tetrad(metric, P.event);
  Vec4<S> slope = gradient(body, surface, P.event, tetrad, here.tau);
  const S rising = dot(slope, P.local);
  S lean(0.0), seen = rising;
  if constexpr (requires { shape.is_smooth(); })
    if (shape.is_smooth()) {
      lean = take_shading_normal(body, shape, here, P, tetrad, rising, slope);
      seen = dot(slope, P.local);
    }
  const S steepness =
      sqrt(slope[1] * slope[1] + slope[2] * slope[2] + slope[3] * slope[3] - slope[0] * slope[0]);
  const S mu = abs(seen) / (frequency * steepness);
  const auto uv = surface.uv(here.X);
  const Vec4<S> emitted = scene_event(P.event);
  return {{S(0.0), here.lambda, uv[0], uv[1], S(1.0) / frequency, emitted[0], here.tau, min(mu, S(1.0))},
          here,
          P,
          g,
          (S(1.0) / length) * u,
          frequency,
          slope,
          steepness,
          rising,
          emitted,
          lean};
}

/// What of the crossings is written down: the scene's Records, and what they mean for each object.
struct RecordRules {
  std::uint32_t objects = 0;
  std::array<std::uint32_t, 2> sky{};     ///< numbers of the skies' objects, 0 for none
  std::unique_ptr<bool[]> transparent{};  ///< by the object's number, from 1
  Records records;
  double lookback_t = kFar;
  bool onward = false;  ///< rays go on behind what they meet

  RecordRules() = default;
  explicit RecordRules(const Scene& scene)
      : objects(static_cast<std::uint32_t>(scene.objects.size())),
        transparent(new bool[objects + 1]()),
        records(scene.records),
        lookback_t(scene.max_lookback_t),
        onward(scene.records.max_hits > 0) {
    for (std::uint32_t i = 0; i < objects; ++i) {
      const Object& object = scene.objects[i];
      if (object.shape.type == ShapeType::sky) {
        sky[object.shape.sky - 1U] = i + 1;
      } else {
        transparent[i + 1] = object.transparent;
        onward |= object.transparent;
      }
    }
  }
  bool is_sky(std::uint32_t number) const { return number == sky[0] || number == sky[1]; }
  /// Whether rays end at the object, and nothing behind it is looked for.
  bool ends_rays(std::uint32_t number) const { return records.max_hits == 0 && !transparent[number]; }
};

inline bool finite(const HitRecord& hit, bool sky) {
  return std::isfinite(hit.u + hit.v + hit.shift + hit.mu) && (sky || std::isfinite(hit.Z + hit.t + hit.tau));
}

/// Sorts the records of one ray by Z.
inline void sort_by_Z(const HitRoom& room, std::size_t from, std::size_t end) {
  for (std::size_t i = from + 1; i < end; ++i)
    for (std::size_t j = i; j > from && room.hits[j].Z < room.hits[j - 1].Z; --j) {
      std::swap(room.hits[j], room.hits[j - 1]);
      if (room.details) std::swap(room.details[j], room.details[j - 1]);
      for (std::size_t k = 0; k < room.paths; ++k)
        std::swap(room.lights[j * room.paths + k], room.lights[(j - 1) * room.paths + k]);
    }
}

/// Puts one record in the place of an earlier one.
inline void move_record(const HitRoom& room, std::size_t from, std::size_t to) {
  room.hits[to] = room.hits[from];
  if (room.details) room.details[to] = room.details[from];
  for (std::size_t k = 0; k < room.paths; ++k)
    room.lights[to * room.paths + k] = room.lights[from * room.paths + k];
}

/// Of the records of one ray, sorted, keeps what the rules let through, from place `kept` on. A ray that
/// comes to its end here has the status `hit`; one that the rules let go no further for its order or its
/// time, the status `lookback_reached`; and one whose numbers broke down, `not_finite`.
inline void keep_records(const RecordRules& rules, const HitRoom& room, std::size_t from, std::size_t end,
                         std::size_t& kept, Status& status) {
  const std::size_t first = kept;
  for (std::size_t i = from; i < end; ++i) {
    const HitRecord hit = room.hits[i];
    const bool sky = rules.is_sky(hit.id);
    if (!finite(hit, sky)) {
      status = Status::not_finite;
      continue;
    }
    if (hit.order > rules.records.max_order || hit.t < -rules.lookback_t) {
      if (status != Status::not_finite) status = Status::lookback_reached;
      return;
    }
    move_record(room, i, kept++);
    if (sky || !(rules.ends_rays(hit.id) || kept - first == rules.records.max_hits)) continue;
    if (status != Status::not_finite) status = Status::hit;
    return;
  }
}

/// Writes the records of crossings, given ray by ray, in the order of the rays and returns how many are kept.
/// `record_object(number, list, listed, room)` makes those of the listed crossings, each at its place in
/// `room`; `record_sky` likewise those of a sky.
template <class T, class RecordObject, class RecordSky>
std::size_t write_records(const Pool<T>& crossings, const RecordRules& rules, std::uint32_t first_pixel,
                          const HitRoom& room, Status* status, const RecordObject& record_object,
                          const RecordSky& record_sky) {
  const std::unique_ptr<std::uint32_t[]> list(new std::uint32_t[crossings.size() + 1]);
  for (std::uint32_t number = 1; number <= rules.objects; ++number) {
    std::size_t listed = 0;
    for (std::size_t i = 0; i < crossings.size(); ++i)
      if (crossings[i].number == number) list[listed++] = static_cast<std::uint32_t>(i);
    if (listed == 0) continue;
    if (rules.is_sky(number))
      record_sky(number, list.get(), listed, room);
    else
      record_object(number, list.get(), listed, room);
  }
  std::size_t kept = 0;
  for (std::size_t from = 0, end = 0; from < crossings.size(); from = end) {
    const std::uint32_t ray = crossings[from].ray;
    for (; end < crossings.size() && crossings[end].ray == ray; ++end)
      room.hits[end].pixel = first_pixel + ray;
    sort_by_Z(room, from, end);
    keep_records(rules, room, from, end, kept, status[ray]);
  }
  return kept;
}

/// The sky at infinity, by direction in the static frame there: infinitely far and long ago.
inline HitRecord sky_record(const Vec3<double>& direction, double shift, std::uint32_t number) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto uv = Sphere::uv(direction);
  return {0, number, 0, kInfinity, uv[0], uv[1], shift, -kInfinity, -kInfinity, 1};
}

/// Puts the records of a group of crossings at their places.
template <class S, class Group>
void scatter(const Recorded<S>& r, const Group& group, std::uint32_t number, double t0, double tau0,
             HitRecord* hits) {
  for (std::size_t lane = 0; lane < group.filled; ++lane)
    hits[group.ray[lane]] = {0,
                             number,
                             static_cast<std::uint32_t>(Lanes<S>::get(r.order, lane)),
                             Lanes<S>::get(r.Z, lane),
                             Lanes<S>::get(r.u, lane),
                             Lanes<S>::get(r.v, lane),
                             Lanes<S>::get(r.shift, lane),
                             Lanes<S>::get(r.t, lane) - t0,
                             Lanes<S>::get(r.tau, lane) - tau0,
                             Lanes<S>::get(r.mu, lane)};
}

NULLCONE_KERNEL_END
