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

template <class S>
struct Crossing {
  S lambda{};  ///< where the surface is met, if `met`
  Mask<S> met{};
  Mask<S> given_up{};  ///< the search reached its limit, or its numbers broke down
  S steps{};
};

/// The first crossing with 0 < lambda < limit. `resolution` is what rounding leaves of a length of lambda.
/// Each lane goes its own way: its numbers do not depend on its neighbours.
template <class S, class Ray, class Shape>
Crossing<S> first_crossing(const Ray& ray, const Shape& shape, const S& limit, const S& resolution) {
  Crossing<S> out;
  out.lambda = S(0.0);
  out.steps = S(0.0);
  auto active = limit > S(0.0);
  out.met = out.given_up = active & !active;
  for (int i = 0; i < kSearchLimit; ++i) {
    const Sight<S> sight = ray.at(out.lambda);
    const S rounding = resolution + S(4e-15) * out.lambda;
    const auto far = sight.clearance > S(0.0);
    const S step = select(far, sight.clearance, min(shape.safe_step(sight, rounding), sight.valid));
    out.steps = select(active, out.steps + S(1.0), out.steps);
    out.met = out.met | (active & (step <= rounding));
    active = active & !out.met;
    out.given_up = out.given_up | (active & !(step <= S(std::numeric_limits<double>::infinity())));  // NaN
    out.lambda = select(active, out.lambda + step, out.lambda);
    active = active & (step < S(kFar)) & (out.lambda < limit);
    if (!any(active)) return out;
  }
  out.given_up = out.given_up | active;
  return out;
}

/// The object's own view of a crossing, from derivatives by duals in the four coordinates and tau.
struct Meeting {
  double tau;
  Vec3<double> X;
  double value;           ///< of the shape's function
  Vec4<double> gradient;  ///< its chart gradient, at the proper time that belongs to each event
};

template <class Body, class Shape>
Meeting meet(const Body& body, const Shape& shape, const Vec4<double>& event, double tau) {
  using D = Dual<double, 5>;
  const auto x = Vec4<D>::map([&](std::size_t i) { return D::variable(event[i], i); });
  Vec3<D> X;
  Vec<double, 5> late_slope;
  for (int i = 0; i < 12; ++i) {  // Newton's method for the proper time
    const auto [late, position] = body.local(x, D::variable(tau, 4));
    X = position;
    late_slope = late.d;
    const double step = late.v / late.d[4];
    tau -= step;
    if (!(std::fabs(step) > 1e-15 * (1 + std::fabs(tau)))) break;
  }
  const D value = shape.value(X);
  Meeting out{tau, {{X[0].v, X[1].v, X[2].v}}, value.v, {}};
  for (std::size_t i = 0; i < 4; ++i)
    out.gradient[i] = value.d[i] - value.d[4] * late_slope[i] / late_slope[4];
  return out;
}

/// Polishes lambda by Newton's method on the exact curve; a grazing ray keeps its best value.
template <class Path, class Body, class Shape>
Meeting polish(const Path& path, const Body& body, const Shape& shape, double& lambda) {
  PathPoint<double> P = path.at(lambda);
  Meeting best = meet(body, shape, P.event, body.first_guess(P.event));
  for (int i = 0; i < 4; ++i) {
    const double step = best.value / dot(best.gradient, P.tangent);
    const double next = lambda - step;
    if (!(std::fabs(step) < 1e-3 * lambda)) break;
    const PathPoint<double> Q = path.at(next);
    const Meeting there = meet(body, shape, Q.event, best.tau);
    if (!(std::fabs(there.value) < std::fabs(best.value))) break;
    lambda = next;
    best = there;
    P = Q;
  }
  return best;
}

NULLCONE_KERNEL_END
