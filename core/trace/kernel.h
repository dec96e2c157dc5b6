// The rays of a band of pixels, side by side in packs; and the search for crossings along closed-form paths.
#pragma once

#include "core/base/boost.h"
#include "core/trace/records.h"
#include "core/trace/with_type.h"

NULLCONE_KERNEL_BEGIN

#ifdef NULLCONE_ONE_LANE
using Wide = double;  // the same numbers, one ray at a time: for comparison
#else
using Wide = Pack;
#endif

/// An object made ready: as the search sees it, and as the record sees it.
template <class Placing, class Body, class Shape>
struct Placed {
  Placing placing;
  Body body;
  Shape shape;
};
template <class M>
using AnyPlaced =
    std::variant<Placed<RestPlacing<M>, RestBody, Sphere>, Placed<RestPlacing<M>, RestBody, Quad>,
                 Placed<RestPlacing<M>, ChartBody<M>, Sphere>, Placed<RestPlacing<M>, ChartBody<M>, Quad>,
                 Placed<RestPlacing<M>, LocalBody<M>, Sphere>,  // at rest, but turning like a gyroscope
                 Placed<MovingPlacing<M>, LocalBody<M>, Sphere>,
                 Placed<MovingPlacing<M>, LocalBody<M>, Quad>>;

/// The rays of a band, and the nearest crossing found so far; structure of arrays, padded to whole packs.
struct BandRays {
  std::size_t count = 0, padded = 0;
  std::unique_ptr<double[]> memory;
  std::array<double*, 4> k{};  ///< past-directed tangent in the static tetrad
  double *limit = nullptr, *steps = nullptr;
  double *lambda = nullptr, *taken = nullptr;  ///< of the search under way: how far, and how many steps
  std::unique_ptr<std::uint32_t[]> nearest;    ///< object number from 1, 0 for none
  std::unique_ptr<std::uint32_t[]> list;       ///< rays that a search or a record is about
  std::unique_ptr<bool[]> doubtful;

  explicit BandRays(std::size_t rays)
      : count(rays),
        padded((rays + 7) / 8 * 8),
        memory(new double[8 * padded]),
        nearest(new std::uint32_t[padded]()),
        list(new std::uint32_t[padded]),
        doubtful(new bool[padded]()) {
    for (std::size_t i = 0; i < 4; ++i) k[i] = memory.get() + i * padded;
    limit = memory.get() + 4 * padded;
    steps = memory.get() + 5 * padded;
    lambda = memory.get() + 6 * padded;
    taken = memory.get() + 7 * padded;
  }
};

/// Some rays of a list, side by side in a pack; the last one is repeated where the list ends.
template <class S>
struct Group {
  static constexpr std::size_t kWidth = Lanes<S>::count;
  std::array<std::size_t, kWidth> ray{};
  std::size_t filled;

  Group(const std::uint32_t* list, std::size_t from, std::size_t end) : filled(std::min(kWidth, end - from)) {
    for (std::size_t lane = 0; lane < kWidth; ++lane) ray[lane] = list[from + std::min(lane, filled - 1)];
  }
  S load(const double* column) const {
    std::array<double, kWidth> values{};
    for (std::size_t lane = 0; lane < kWidth; ++lane) values[lane] = column[ray[lane]];
    return Lanes<S>::load(values.data());
  }
  void store(const S& x, double* column) const {
    std::array<double, kWidth> values{};
    Lanes<S>::store(x, values.data());
    for (std::size_t lane = 0; lane < filled; ++lane) column[ray[lane]] = values[lane];
  }
  Vec4<S> load_k(const BandRays& rays) const {
    return Vec4<S>::map([&](std::size_t c) { return load(rays.k[c]); });
  }
};

/// Camera rays of a band: the photon that arrives at each pixel, followed into the past.
template <class S>
void aim(const Camera& camera, const Vec4<double>& u_camera, int first_line, double lookback,
         BandRays& rays) {
  const Vec4<S> u = convert<S>(u_camera);
  int column = 0, line = first_line;  // of the next ray; the last ray is repeated to fill the last pack
  for (std::size_t i = 0; i < rays.padded; i += Lanes<S>::count) {
    std::array<double, Lanes<S>::count> x{}, y{};
    for (std::size_t lane = 0; lane < x.size(); ++lane) {
      x[lane] = column + 0.5;
      y[lane] = line + 0.5;
      if (i + lane + 1 < rays.count && ++column == camera.width) column = 0, ++line;
    }
    const Vec3<S> look = look_direction(camera, Lanes<S>::load(x.data()), Lanes<S>::load(y.data()));
    const Vec4<S> past = -seen_photon(u, look);
    for (std::size_t c = 0; c < 4; ++c) Lanes<S>::store(past[c], rays.k[c] + i);
    Lanes<S>::store(S(lookback), rays.limit + i);
    Lanes<S>::store(S(0.0), rays.steps + i);
  }
}

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
