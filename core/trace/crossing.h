// Where a ray first meets a surface: safe steps along the path itself, then Newton's method to machine
// precision.
#pragma once

#include <limits>

#include "core/trace/metric.h"
#include "core/trace/placing.h"
#include "core/trace/shapes.h"

NULLCONE_KERNEL_BEGIN

/// Most evaluations a search may take; beyond it the pixel is marked doubtful.
inline constexpr int kSearchLimit = 2000;

/// A search under way. Each lane goes its own way: its numbers do not depend on its neighbours.
template <class S>
struct Search {
  S lambda{};  ///< how far the ray has come; where the surface is met, if `met`
  S steps{};
  Mask<S> active{}, met{};
  Mask<S> given_up{};  ///< the search reached its limit, or its numbers broke down

  /// Starts at lambda = 0, for lanes with limit > 0.
  explicit Search(const S& limit) : lambda(S(0.0)), steps(S(0.0)), active(limit > S(0.0)) {
    met = given_up = active & !active;
  }
};

/// Takes up to `rounds` steps towards the first crossing with 0 < lambda < limit. `resolution` is what
/// rounding leaves of a length of lambda at the start.
template <class S, class Ray, class Shape>
void advance(const Ray& ray, const Shape& shape, const S& limit, const S& resolution, int rounds,
             Search<S>& search) {
  for (int i = 0; i < rounds && any(search.active); ++i) {
    const Sight<S> sight = ray.at(search.lambda);
    const S rounding = resolution + S(4e-15) * search.lambda;
    const auto far = sight.clearance > S(0.0);
    // A far ray goes to where it may come near, and past what rounding leaves before that.
    const S skip = sight.clearance + rounding;
    const S step = all(far) ? skip : select(far, skip, min(shape.safe_step(sight, rounding), sight.valid));
    const auto& active = search.active;
    search.steps = select(active, search.steps + S(1.0), search.steps);
    search.met = search.met | (active & !far & (step <= rounding));
    search.active = active & !search.met;
    const auto broken = search.active & !(step <= S(std::numeric_limits<double>::infinity()));  // NaN
    const auto too_long = search.active & (search.steps >= S(kSearchLimit));
    search.given_up = search.given_up | broken | too_long;
    search.lambda = select(search.active, search.lambda + step, search.lambda);
    search.active = search.active & !search.given_up & (step < S(kFar)) & (search.lambda < limit);
  }
}

/// A shape for rays that go on behind it, and which of them are inside.
template <class S, class Shape>
struct Onward {
  const Shape& shape;
  Mask<S> inside;

  S safe_step(const Sight<S>& ray, const S& rounding) const {
    return shape.onward_step(ray, rounding, inside);
  }
};

/// The whole search at once.
template <class S, class Ray, class Shape>
Search<S> first_crossing(const Ray& ray, const Shape& shape, const S& limit, const S& resolution) {
  Search<S> search(limit);
  advance(ray, shape, limit, resolution, kSearchLimit, search);
  return search;
}

/// The object's proper time at an event.
template <class Body, class S>
S local_time(const Body& body, const Vec4<S>& event, const S& tau) {
  using D = Dual<S, 1>;
  return time_of_zero([&](const D& time) { return body.local(convert<D>(event), time).first; }, tau);
}

/// Where an event on a ray is in the object's frame, and how fast it moves there.
template <class S>
struct Aboard {
  Vec3<S> X, slope;
  S tau, tau_slope;
  S late;  ///< what Newton's method has left; large where there is no such proper time nearby
};

/// Newton's method for the proper time, from a guess, and implicit differentiation.
template <class Body, class S>
Aboard<S> aboard(const Body& body, const Vec4<S>& event, const Vec4<S>& tangent, const S& guess) {
  using D = Dual<S, 2>;  // derivatives along lambda and tau
  const S tau = local_time(body, event, guess);
  const auto x = Vec4<D>::map([&](std::size_t i) { return D(event[i], Vec<S, 2>{{tangent[i], S(0.0)}}); });
  const auto [late, X] = body.local(x, D::variable(tau, 1));
  Aboard<S> out;
  out.tau = tau, out.tau_slope = -(late.d[0] / late.d[1]), out.late = late.v;
  for (std::size_t i = 0; i < 3; ++i) {
    out.X[i] = X[i].v;
    out.slope[i] = X[i].d[0] + X[i].d[1] * out.tau_slope;
  }
  return out;
}

/// A crossing as the object sees it.
template <class S>
struct Meeting {
  S lambda, tau;
  Vec3<S> X;
};

/// Polishes lambda by Newton's method in (lambda, tau) on the exact curve. Where a ray grazes and the method
/// does not improve, the best value stays.
template <class S, class Path, class Body, class Shape>
Meeting<S> polish(const Path& path, const Body& body, const Shape& shape, const S& found) {
  using D = Dual<S, 2>;
  const Vec4<S> start = path.at(found).event;
  S lambda = found, tau = local_time(body, start, body.first_guess(start)), least(kFar);
  Meeting<S> best{found, tau, {}};
  auto active = found == found;
  for (int i = 0; i < 4 && any(active); ++i) {
    const PathPoint<S> P = path.at(lambda);
    const auto x = Vec4<D>::map([&](std::size_t c) {
      return D(P.event[c], Vec<S, 2>{{P.tangent[c], S(0.0)}});
    });
    const auto [late, X] = body.local(x, D::variable(tau, 1));
    const S wait = -(late.v / late.d[1]), tau_slope = -(late.d[0] / late.d[1]);  // to the right proper time
    const D value = shape.value(X);
    const S f = value.v + value.d[1] * wait, slope = value.d[0] + value.d[1] * tau_slope;
    const auto better = active & (abs(f) < least);
    least = select(better, abs(f), least);
    best.lambda = select(better, lambda, best.lambda);
    best.tau = select(better, tau + wait, best.tau);
    for (std::size_t c = 0; c < 3; ++c) best.X[c] = select(better, X[c].v + X[c].d[1] * wait, best.X[c]);
    const S step = f / slope;
    active = better & (abs(step) < S(1e-3) * lambda);
    lambda = select(active, best.lambda - step, best.lambda);
    tau = select(active, best.tau - tau_slope * step, best.tau);
  }
  return best;
}

/// The gradient of the shape's function along the vectors e_a of a tetrad at `event`, at the proper time that
/// belongs to each event.
template <class S, class Body, class Shape>
Vec4<S> gradient(const Body& body, const Shape& shape, const Vec4<S>& event, const Tetrad<S>& tetrad,
                 const S& tau) {
  using D = Dual<S, 5>;
  const auto x = Vec4<D>::map([&](std::size_t c) {
    return D(event[c], Vec<S, 5>{{tetrad.e[0][c], tetrad.e[1][c], tetrad.e[2][c], tetrad.e[3][c], S(0.0)}});
  });
  const std::pair<D, Vec3<D>> seen = body.local(x, D::variable(tau, 4));
  const D &late = seen.first, value = shape.value(seen.second);
  const S per_tau = value.d[4] / late.d[4];
  return Vec4<S>::map([&](std::size_t a) { return value.d[a] - per_tau * late.d[a]; });
}

NULLCONE_KERNEL_END
