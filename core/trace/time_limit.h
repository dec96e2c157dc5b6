// Closed-form rays that end where they first come too far into the past.
#pragma once

#include "core/trace/band.h"
#include "core/trace/metric.h"

NULLCONE_KERNEL_BEGIN

/// Steps that the search of a ray's end may take; beyond it the pixel is marked doubtful.
inline constexpr int kTimeSteps = 400;

/// The least affine length, or `limit`, at which t is `back` earlier than at the start of the path. On a
/// curve whose second derivative is nowhere above `bend`, Newton's method is safe with it in the root: no
/// step leads past a zero, and steps converge quadratically. `lost`: lanes that have not come to an end of
/// it.
template <class S, class Path, class T>
S first_time_back(const Path& path, const T& back, const S& bend, const S& limit, Mask<S>& lost) {
  const S start = path.at(S(0.0)).event[0];
  S lambda(0.0);
  Mask<S> active = limit > S(0.0);
  for (int n = 0; n < kTimeSteps && any(active); ++n) {
    const PathPoint<S> here = path.at(lambda);
    const S above = max((here.event[0] - start) + S(back), S(0.0)), rising = here.tangent[0];
    const S root = sqrt(rising * rising + S(2.0) * bend * above);
    const S step =
        select(rising < S(0.0), S(2.0) * above / (root - rising), (root + rising) / max(bend, S(1e-300)));
    const S next = lambda + step;
    lambda = select(active, min(next, limit), lambda);
    active = active & (lambda < limit) & (step > S(4e-16) * next);
  }
  lost = active;
  return min(lambda, limit);
}

/// Cuts the rays of a band where they are `back` earlier than the observation; those that start there, at a
/// film, have no length.
template <class S, class M>
void end_in_the_past(const M& metric, const Vec4<double>& observation, double back, BandRays& rays) {
  for (std::size_t i = 0; i < rays.padded; i += Lanes<S>::count) {
    const auto k = Vec4<S>::map([&](std::size_t c) { return Lanes<S>::load(rays.k[c] + i); });
    Mask<S> lost = k[0] != k[0];
    const S bend = S(metric.bend_of_time()) * (k[0] * k[0]);
    const S limit = Lanes<S>::load(rays.limit + i);
    S end;
    if (rays.from_film()) {
      const auto start = Vec4<S>::map([&](std::size_t c) { return Lanes<S>::load(rays.start[c] + i); });
      const S left = S(back) + (start[0] - S(observation[0]));
      end = first_time_back(metric.path(start, k), left, bend,
                            select(left > S(0.0), limit, min(limit, S(0.0))), lost);
    } else {
      end = first_time_back(metric.path(convert<S>(observation), k), back, bend, limit, lost);
    }
    Lanes<S>::store(end, rays.limit + i);
    std::array<bool, Lanes<S>::count> doubtful{};
    Lanes<S>::store(lost, doubtful.data());
    for (std::size_t lane = 0; lane < doubtful.size(); ++lane) rays.doubtful[i + lane] |= doubtful[lane];
  }
}

NULLCONE_KERNEL_END
