// The search for all crossings along closed-form paths: rays that have met an object go on behind it.
#pragma once

#include "core/trace/closed_search.h"

NULLCONE_KERNEL_BEGIN

/// Crossings of one object that a ray may have; beyond it the pixel is marked doubtful.
inline constexpr double kMostCrossings = 4096;

/// What a search onwards knows of each ray, for one object at a time, and what it has found so far.
struct Onwards {
  std::unique_ptr<double[]> side;   ///< -1 inside the object, else 1
  std::unique_ptr<double[]> times;  ///< how often the ray has met it
  Pool<Crossing> found;

  explicit Onwards(const BandRays& rays)
      : side(new double[rays.padded]), times(new double[rays.padded]), found(rays.count) {}
};

/// Where the rays of a group that have met the object go on.
template <class S, class Ray, class Shape>
S past_crossing(const Ray& ray, const Shape& shape, const Search<S>& search, const S& resolution) {
  if (!any(search.met)) return search.lambda;
  const S rounding = resolution + S(4e-15) * search.lambda;
  return search.lambda + shape.skip(ray.at(search.lambda), rounding);
}

/// Keeps what a few steps of a group have found, and lists the rays that go on, from `left` on: in the midst
/// of a search, or at `next`, behind a crossing.
template <class S>
void keep_crossings(const Group<S>& group, const Search<S>& search, const S& next, std::uint32_t number,
                    BandRays& rays, Onwards& onwards, std::size_t& left) {
  group.store(search.steps, rays.taken);
  group.store(select(search.met, next, search.lambda), rays.lambda);
  std::array<bool, Lanes<S>::count> active{}, met{}, given_up{};
  Lanes<S>::store(search.active, active.data());
  Lanes<S>::store(search.met, met.data());
  Lanes<S>::store(search.given_up, given_up.data());
  for (std::size_t lane = 0; lane < group.filled; ++lane) {
    const auto ray = static_cast<std::uint32_t>(group.ray[lane]);
    bool goes_on = active[lane], gives_up = given_up[lane];
    if (met[lane]) {
      onwards.found.push({ray, number, Lanes<S>::get(search.lambda, lane)});
      onwards.side[ray] = -onwards.side[ray];
      gives_up = ++onwards.times[ray] >= kMostCrossings;
      goes_on = !gives_up && rays.lambda[ray] < rays.limit[ray];
    }
    rays.doubtful[ray] |= gives_up;
    if (goes_on) rays.list[left++] = ray;
    if (active[lane]) continue;
    rays.steps[ray] += rays.taken[ray];
    rays.taken[ray] = 0;
  }
}

/// Finds all crossings of the rays with one object, nearer than the opaque surfaces found before. Goes on in
/// rounds as `search` does.
template <class S, class Placing, class Body, class Shape>
void search_onward(const Placed<Placing, Body, Shape>& object, std::uint32_t number,
                   const Vec4<double>& event, BandRays& rays, Onwards& onwards) {
  constexpr int kRound = 4;
  const Launches<S, Placing> launches(object.placing, event, rays);
  std::size_t listed = launches.list_candidates(rays);
  for (std::size_t i = 0; i < listed; ++i) {
    const std::size_t ray = rays.list[i];
    rays.lambda[ray] = rays.taken[ray] = onwards.times[ray] = 0;
    onwards.side[ray] = object.shape.starts_inside() ? -1 : 1;
  }
  for (std::size_t i = 0; rays.from_film() && i < listed; i += Lanes<S>::count) {
    const Group<S> group(rays.list.get(), i, listed);
    const Mask<S> inside = starts_inside(launches.ray(group), object.shape, S(0.0));
    group.store(select(inside, S(-1.0), S(1.0)), onwards.side.get());
  }
  while (listed > 0) {
    std::size_t left = 0;
    for (std::size_t i = 0; i < listed; i += Lanes<S>::count) {
      const Group<S> group(rays.list.get(), i, listed);
      const S limit = group.load(rays.limit);
      Search<S> search(limit);
      search.lambda = group.load(rays.lambda);
      search.steps = group.load(rays.taken);
      const auto ray = launches.ray(group);
      const S resolution = launches.resolution(group);
      const Onward<S, Shape> shape{object.shape, group.load(onwards.side.get()) < S(0.0)};
      advance(ray, shape, limit, resolution, kRound, search);
      const S next = past_crossing(ray, object.shape, search, resolution);
      keep_crossings(group, search, next, number, rays, onwards, left);
    }
    listed = left;
  }
}

NULLCONE_KERNEL_END
