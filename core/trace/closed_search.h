// The search for crossings along closed-form paths: one object after the other, for all rays of a band.
#pragma once

#include "core/trace/any_shape.h"
#include "core/trace/band.h"
#include "core/trace/course_ray.h"
#include "core/trace/with_type.h"

NULLCONE_KERNEL_BEGIN

/// An object made ready: as the search sees it, and as the record sees it.
template <class Placing, class Body, class Shape>
struct Placed {
  Placing placing;
  Body body;
  Shape shape;
};
template <class M>
using AnyPlaced = std::variant<
    Placed<RestPlacing<M>, RestBody, Sphere>, Placed<RestPlacing<M>, RestBody, AnyShape>,
    Placed<RestPlacing<M>, ChartBody<M>, Sphere>, Placed<RestPlacing<M>, ChartBody<M>, AnyShape>,
    Placed<RestPlacing<M>, LocalBody<M>, Sphere>,  // at rest, but turning like a gyroscope
    Placed<MovingPlacing<M>, LocalBody<M>, Sphere>, Placed<MovingPlacing<M>, LocalBody<M>, AnyShape>,
    Placed<CoursePlacing<M>, CourseBody<M>, Sphere>, Placed<CoursePlacing<M>, CourseBody<M>, AnyShape>>;

/// The rays of a band as an object's placing has them: all from one event or, from a film, each from its own.
template <class S, class Placing>
class Launches {
 public:
  Launches(const Placing& placing, const Vec4<double>& event, const BandRays& rays)
      : placing_(placing), rays_(rays), launch_(placing.launch(event)), norm_(norm(spatial(event))) {}

  /// Lists the rays that come near the object's bounding ball at all.
  std::size_t list_candidates(BandRays& rays) const {
    if (rays.from_film())
      return list(
          rays, [](const Vec4<S>& k) { return k[0] == k[0]; },
          [&](const Vec4<S>& k, std::size_t i) {
            const auto start = Vec4<S>::map([&](std::size_t c) { return Lanes<S>::load(rays.start[c] + i); });
            return placing_.ray(placing_.launch(start), k);
          });
    const auto launch = launch_;  // what depends on it alone is worked out once
    return list(
        rays, [&](const Vec4<S>& k) { return placing_.may_meet(launch, k); },
        [&](const Vec4<S>& k, std::size_t) { return placing_.ray(launch, k); });
  }
  auto ray(const Group<S>& group) const {
    const Vec4<S> k = group.load_k(rays_);
    return rays_.from_film() ? placing_.ray(placing_.launch(group.load_start(rays_)), k)
                             : placing_.ray(launch_, k);
  }
  /// What rounding leaves of a length of lambda at the start.
  S resolution(const Group<S>& group) const {
    return S(4e-15) * (rays_.from_film() ? norm(spatial(group.load_start(rays_))) : S(norm_));
  }

 private:
  template <class Sieve, class RayAlong>
  static std::size_t list(BandRays& rays, const Sieve& sieve, const RayAlong& ray_along) {
    std::size_t listed = 0;
    for (std::size_t i = 0; i < rays.padded; i += Lanes<S>::count) {
      const auto k = Vec4<S>::map([&](std::size_t c) { return Lanes<S>::load(rays.k[c] + i); });
      const Mask<S> may_meet = sieve(k);
      if (!any(may_meet)) continue;
      std::array<bool, Lanes<S>::count> near{};
      Lanes<S>::store(may_meet & (ray_along(k, i).clearance(S(0.0)) < Lanes<S>::load(rays.limit + i)),
                      near.data());
      for (std::size_t lane = 0; lane < near.size(); ++lane)
        if (near[lane] && i + lane < rays.count) rays.list[listed++] = static_cast<std::uint32_t>(i + lane);
    }
    return listed;
  }

  const Placing& placing_;
  const BandRays& rays_;
  decltype(std::declval<Placing>().launch(Vec4<double>{})) launch_;
  double norm_;
};

/// Which rays are inside of a closed shape at `start`.
template <class S, class Ray, class Shape>
Mask<S> starts_inside(const Ray& ray, const Shape& shape, const S& start) {
  const Sight<S> first = ray.at(start);
  const Mask<S> near = first.clearance <= S(0.0);
  return shape.is_sheet() || !any(near) ? near & !near : near & shape.holds(first.X);
}

/// Takes the listed rays towards an object in rounds of a few steps, until all have ended, and keeps what is
/// nearer than anything before; those that have ended make room for others after each round, so that packs
/// stay full. `advance_group(group, limit, search)` takes the steps.
template <class S, class Advance>
void search_in_rounds(std::uint32_t number, std::size_t listed, BandRays& rays,
                      const Advance& advance_group) {
  for (std::size_t i = 0; i < listed; ++i) rays.lambda[rays.list[i]] = rays.taken[rays.list[i]] = 0;
  while (listed > 0) {
    std::size_t left = 0;
    for (std::size_t i = 0; i < listed; i += Lanes<S>::count) {
      const Group<S> group(rays.list.get(), i, listed);
      const S limit = group.load(rays.limit);
      Search<S> search(limit);
      search.lambda = group.load(rays.lambda);
      search.steps = group.load(rays.taken);
      advance_group(group, limit, search);
      group.store(search.lambda, rays.lambda);
      group.store(search.steps, rays.taken);
      std::array<bool, Lanes<S>::count> active{}, met{}, given_up{};
      Lanes<S>::store(search.active, active.data());
      Lanes<S>::store(search.met, met.data());
      Lanes<S>::store(search.given_up, given_up.data());
      for (std::size_t lane = 0; lane < group.filled; ++lane) {
        const std::size_t ray = group.ray[lane];
        if (active[lane]) {
          rays.list[left++] = static_cast<std::uint32_t>(ray);
          continue;
        }
        rays.steps[ray] += rays.taken[ray];
        rays.doubtful[ray] |= given_up[lane];
        if (!met[lane]) continue;
        rays.limit[ray] = rays.lambda[ray];
        rays.nearest[ray] = number;
      }
    }
    listed = left;
  }
}

/// Finds where the rays meet one object. Films may pierce it: rays that start inside meet it from inside.
template <class S, class Placing, class Body, class Shape>
void search(const Placed<Placing, Body, Shape>& object, std::uint32_t number, const Vec4<double>& event,
            BandRays& rays) {
  constexpr int kRound = 4;
  const Launches<S, Placing> launches(object.placing, event, rays);
  const std::size_t listed = launches.list_candidates(rays);
  if (rays.from_film()) {
    search_in_rounds<S>(number, listed, rays, [&](const Group<S>& group, const S& limit, Search<S>& search) {
      const auto ray = launches.ray(group);
      const Onward<S, Shape> shape{object.shape, starts_inside(ray, object.shape, S(0.0))};
      advance(ray, shape, limit, launches.resolution(group), kRound, search);
    });
    return;
  }
  const auto launch = object.placing.launch(event);
  const S resolution(4e-15 * norm(spatial(event)));
  search_in_rounds<S>(number, listed, rays, [&](const Group<S>& group, const S& limit, Search<S>& search) {
    advance(object.placing.ray(launch, group.load_k(rays)), object.shape, limit, resolution, kRound, search);
  });
}

NULLCONE_KERNEL_END
