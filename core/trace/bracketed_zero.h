// The zero of an increasing function between two bounds, for many lanes at once.
#pragma once

#include "core/base/vector.h"

NULLCONE_KERNEL_BEGIN

/// A function's value and slope.
template <class S>
struct Slope {
  S value, slope;
};

/// The zero of f between `low` and `high`, where f is below and above zero, from `x` on: Newton's method, and
/// bisection where that would leave the bounds or converges badly. f(x) -> Slope; it may jump (then the
/// result is the place of the jump). Steps end below `precision` times |x|, a lane at its own time; lanes
/// that are not `active` stay at `x`.
template <class S, class F>
S bracketed_zero(const F& f, S low, S high, S x, Mask<S> active, double precision) {
  constexpr int kMostSteps = 80;
  S last = high - low;
  for (int i = 0; i < kMostSteps && any(active); ++i) {
    const Slope<S> here = f(x);
    const Mask<S> above = here.value > S(0.0);
    high = select(above, x, high);
    low = select(above, low, x);
    const S newton = x - here.value / here.slope, least = S(precision) * abs(x);
    // Steps that do not shrink may go round in a circle; small ones may be rounding.
    const S wanted = abs(newton - x);
    const Mask<S> inside =
        (newton >= low) & (newton <= high) & (wanted <= max(S(0.5) * last, S(1e-6) * abs(x)));
    const S next = select(inside | (wanted <= least), newton, S(0.5) * (low + high));
    const S step = abs(next - x);
    last = step;
    x = select(active, next, x);
    active = active & (step > least);
  }
  return x;
}

NULLCONE_KERNEL_END
