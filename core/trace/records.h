// What a record says about a crossing, and how the records of many rays come into the order of the pixels.
#pragma once

#include <cmath>
#include <limits>
#include <memory>

#include "core/base/status.h"
#include "core/trace/crossing.h"
#include "core/trace/spacetime.h"

NULLCONE_KERNEL_BEGIN

/// Everything about some crossings, side by side. `t` is the emission event's chart time.
template <class S>
struct Recorded {
  S order, Z, u, v, shift, t, tau, mu;
};

/// The crossing of a path with an object near the affine length `found`. Paths and bodies share a chart, and
/// `chart_time` gives the scene's chart time of its events.
template <class S, Metric M, class Path, class Body, class Shape, class ChartTime>
Recorded<S> record_crossing(const M& metric, const Path& path, const Body& body, const Shape& shape,
                            const S& found, const ChartTime& chart_time) {
  const Meeting<S> here = polish(path, body, shape, found);
  const PathPoint<S> P = path.at(here.lambda);
  const Matrix4<S> g = metric.g(P.event);

  // The surface's 4-velocity: d/dtau at a fixed point of the object.
  using D = Dual<S, 1>;
  const Vec4<D> moving = body.event(D::variable(here.tau, 0), convert<D>(here.X));
  const auto u = Vec4<S>::map([&](std::size_t i) { return moving[i].d[0]; });
  const S frequency = -inner(g, P.tangent, u) / sqrt(inner(g, u, u));

  // The emission angle: between the photon and the unit normal, on the side to which the photon leaves.
  const Vec4<S> slope = gradient(body, shape, P.event, static_tetrad(metric, P.event), here.tau);
  const S steepness =
      sqrt(slope[1] * slope[1] + slope[2] * slope[2] + slope[3] * slope[3] - slope[0] * slope[0]);
  const S mu = abs(dot(slope, P.local)) / (frequency * steepness);
  const auto uv = shape.uv(here.X);
  return {S(0.0),   here.lambda,    uv[0], uv[1], S(1.0) / frequency, chart_time(P.event),
          here.tau, min(mu, S(1.0))};
}

/// How the rays of a band, or of a part of it, ended.
struct Ended {
  std::size_t count;
  const std::uint32_t* object;  ///< number of the object met, or of the sky seen, from 1; 0 for none
  Status* status;
};

inline bool finite(const HitRecord& hit, bool sky) {
  return std::isfinite(hit.u + hit.v + hit.shift + hit.mu) && (sky || std::isfinite(hit.Z + hit.t + hit.tau));
}

/// Writes the records in the order of the pixels and returns how many. `record_object(number, list, listed,
/// place, hits)` makes those of the listed rays, each at its place; `record_sky(ray)` one of the sky. Records
/// whose numbers broke down are dropped, and the status says so.
template <class RecordObject, class RecordSky>
std::size_t write_records(const Ended& ended, std::uint32_t objects, std::uint32_t first_pixel,
                          HitRecord* hits, const RecordObject& record_object, const RecordSky& record_sky) {
  const std::unique_ptr<std::uint32_t[]> place(new std::uint32_t[ended.count]),
      list(new std::uint32_t[ended.count]);
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < ended.count; ++i) {
    place[i] = next;
    next += ended.object[i] != 0;
    if (ended.object[i] != 0 && ended.status[i] == Status::sky)
      hits[place[i]] = record_sky(i, ended.object[i]);
  }
  for (std::uint32_t number = 1; number <= objects; ++number) {
    std::size_t listed = 0;
    for (std::size_t i = 0; i < ended.count; ++i)
      if (ended.object[i] == number && ended.status[i] != Status::sky)
        list[listed++] = static_cast<std::uint32_t>(i);
    if (listed > 0) record_object(number, list.get(), listed, place.get(), hits);
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < ended.count; ++i) {
    if (ended.object[i] == 0) continue;
    HitRecord hit = hits[place[i]];
    hit.pixel = first_pixel + static_cast<std::uint32_t>(i);
    if (finite(hit, ended.status[i] == Status::sky))
      hits[kept++] = hit;
    else
      ended.status[i] = Status::not_finite;
  }
  return kept;
}

/// The sky at infinity, by direction in the static frame there: infinitely far and long ago.
inline HitRecord sky_record(const Vec3<double>& direction, double shift, std::uint32_t number) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto uv = Sphere::uv(direction);
  return {0, number, 0, kInfinity, uv[0], uv[1], shift, -kInfinity, -kInfinity, 1};
}

/// Puts the records of a group of rays at their places.
template <class S, class Group>
void scatter(const Recorded<S>& r, const Group& group, std::uint32_t number, double t0, double tau0,
             const std::uint32_t* place, HitRecord* hits) {
  for (std::size_t lane = 0; lane < group.filled; ++lane)
    hits[place[group.ray[lane]]] = {0,
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
