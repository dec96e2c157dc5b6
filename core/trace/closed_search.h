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

/// Lists the rays that come near the object's bounding ball at all.
template <class S, class Placing>
std::size_t list_candidates(const Placing& placing, const Vec4<double>& event, BandRays& rays) {
  std::size_t listed = 0;
  const auto launch = placing.launch(event);
  for (std::size_t i = 0; i < rays.padded; i += Lanes<S>::count) {
    const auto k = Vec4<S>::map([&](std::size_t c) { return Lanes<S>::load(rays.k[c] + i); });
    const Mask<S> may_meet = placing.may_meet(launch, k);
    if (!any(may_meet)) continue;
    std::array<bool, Lanes<S>::count> near{};
    Lanes<S>::store(may_meet & (placing.ray(launch, k).clearance(S(0.0)) < Lanes<S>::load(rays.limit + i)),
                    near.data());
    for (std::size_t lane = 0; lane < near.size(); ++lane)
      if (near[lane] && i + lane < rays.count) rays.list[listed++] = static_cast<std::uint32_t>(i + lane);
  }
  return listed;
}

/// Finds where the rays meet one object, and keeps what is nearer than anything before. The rays go on in
/// rounds of a few steps; those that have ended make room for others after each round, so that packs stay
/// full.
template <class S, class Placing, class Body, class Shape>
void search(const Placed<Placing, Body, Shape>& object, std::uint32_t number, const Vec4<double>& event,
            double resolution, BandRays& rays) {
  constexpr int kRound = 4;
  const auto launch = object.placing.launch(event);
  std::size_t listed = list_candidates<S>(object.placing, event, rays);
  for (std::size_t i = 0; i < listed; ++i) rays.lambda[rays.list[i]] = rays.taken[rays.list[i]] = 0;
  while (listed > 0) {
    std::size_t left = 0;
    for (std::size_t i = 0; i < listed; i += Lanes<S>::count) {
      const Group<S> group(rays.list.get(), i, listed);
      const S limit = group.load(rays.limit);
      Search<S> search(limit);
      search.lambda = group.load(rays.lambda);
      search.steps = group.load(rays.taken);
      advance(object.placing.ray(launch, group.load_k(rays)), object.shape, limit, S(resolution), kRound,
              search);
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

NULLCONE_KERNEL_END
