// A fast lamp in the Gödel universe: emissions whose arrival does not rise all along its worldline.
//
// The lamp goes round in the plane, and comes nearest to the event once in each revolution. There are two
// such passages of which the first has f < 0 and the second f > 0, and the light leaves between them. If the
// lamp is out of reach halfway, f may sink there: then there may be two emissions, one after the first
// passage and one before the second, and others a revolution before and after.
#pragma once

#include "metrics/goedel_moving_lamp.h"

NULLCONE_KERNEL_BEGIN

template <class S>
struct FastLampSearch {
  using Search = GoedelEmissionSearch<S>;
  using Arrival = typename Search::Arrival;
  const Search& search;

  /// The lamp is nearest at the proper times tau(n) = first + n period.
  struct Passages {
    S first, period;
    Vec4<S> place, rate;  ///< in the chart about the event: there, and what a period adds
    S tau(const S& number) const { return first + number * period; }
  };
  Passages passages() const;
  Arrival arrival(const Passages& along, const S& number) const {
    return search.arrival_at(along.place + number * along.rate, along.rate);
  }
  S number_of_emission(const Passages& along) const;

  /// The time between two passages, and what arrives from its ends and its middle.
  struct Revolution {
    S low, middle, high;
    Arrival first, halfway, second;
  };
  Revolution revolution(const Passages& along, const S& number) const;
  GoedelEmission<S> in_half(const Revolution& within, bool second, const Mask<S>& sought) const;
  GoedelEmission<S> next_to_passage(const Revolution& within, bool second, const Mask<S>& sought) const;
  S border(const S& inside, const Arrival& there, const S& outside, const Arrival& beyond,
           const Mask<S>& sought) const;
  void find_reach(const Revolution& within, bool second, const Mask<S>& lost, S& tau, Arrival& there) const;
  GoedelEmission<S> emission(int which) const;
};

/// As for GoedelGuard: |q|^2 = C + D cos 2 psi + E sin 2 psi along the lamp's worldline.
template <class S>
typename FastLampSearch<S>::Passages FastLampSearch<S>::passages() const {
  const Goedel& metric = search.metric;
  const LocalFrame<Goedel>& frame = search.line.body.frame;
  const Vec4<S> start = convert<S>(frame.start), u = convert<S>(frame.u);
  const Complex<S> q0 = metric.to_q(metric.to_origin(search.event, start));
  const Complex<S> nu = metric.turn(search.event, start) * Complex<S>{u[1] / u[0], u[2] / u[0]};
  const S kappa = sqrt(S(1.0) - S(0.5) * norm2(nu));
  const Complex<S> scaled = (S(1 / Goedel::kSqrt2) * cosh_of(q0)) * nu;
  const Complex<S> w = (S(1.0) / kappa) * Complex<S>{scaled.re + q0.im, scaled.im - q0.re};
  const S E = (conj(q0) * w).re, D = S(0.5) * (norm2(q0) - norm2(w));
  const S to_tau = S(Goedel::kSqrt2 * metric.a) / (kappa * u[0]), o(0.0);
  Passages out;
  out.first = S(0.5) * (atan2(E, D) + S(std::numbers::pi)) * to_tau;
  out.period = S(std::numbers::pi) * to_tau;
  out.place = metric.to_origin(search.event, search.line.event(out.first));
  out.rate = {{S(metric.mean_rate(frame.u)) * out.period, o, o, u[3] * out.period}};
  return out;
}

/// n such that f < 0 at the passage n, and not at n + 1. From passage to passage t and z grow evenly.
template <class S>
S FastLampSearch<S>::number_of_emission(const Passages& along) const {
  const auto lateness = [&](const S& n) -> Slope<S> {
    const Arrival there = arrival(along, n);
    return {there.value, there.slope};
  };
  // No light is faster than 1 along z, so that the slope is bounded.
  const Slope<S> late = lateness(S(0.0));
  const S end = -(late.value / (S(0.99) * (along.rate[0] - abs(along.rate[3]))));
  S n = bracketed_zero(lateness, min(end, S(0.0)), max(end, S(0.0)), -(late.value / late.slope),
                       late.value == late.value, 1e-9);
  // The passages themselves decide.
  n = floor(n);
  for (int i = 0; i < 4; ++i) {
    const Mask<S> back = search.arrival(along.tau(n)).value > S(0.0),
                  on = search.arrival(along.tau(n + S(1.0))).value <= S(0.0);
    if (!any(back | on)) break;
    n = n + select(back, S(-1.0), select(on, S(1.0), S(0.0)));
  }
  return n;
}

template <class S>
typename FastLampSearch<S>::Revolution FastLampSearch<S>::revolution(const Passages& along,
                                                                     const S& number) const {
  const S next = number + S(1.0), low = along.tau(number), high = along.tau(next);
  const S middle = S(0.5) * (low + high);
  return {low, middle, high, search.arrival(low), search.arrival(middle), search.arrival(high)};
}

/// A lamp that moves along z may come within reach only some time after a passage, or before the next: the
/// sample that is deepest within.
template <class S>
void FastLampSearch<S>::find_reach(const Revolution& within, bool second, const Mask<S>& lost, S& tau,
                                   Arrival& there) const {
  constexpr int kSamples = 12;
  for (int i = 1; i <= kSamples; ++i) {
    const double part = 0.5 * i / kSamples;
    const S sample = within.low + S(second ? 1 - part : part) * (within.high - within.low);
    const Arrival here = search.arrival(sample);
    const Mask<S> better = lost & (here.room > there.room);
    tau = select(better, sample, tau);
    there.room = select(better, here.room, there.room);
    there.value = select(better, here.value, there.value);
  }
}

/// Where the lamp gets out of reach between `inside` and `outside`, or `outside` if it does not.
template <class S>
S FastLampSearch<S>::border(const S& inside, const Arrival& there, const S& outside, const Arrival& beyond,
                            const Mask<S>& sought) const {
  const Mask<S> leaves = sought & (beyond.room < S(0.0));
  if (!any(leaves)) return outside;
  const S side = select(inside < outside, S(-1.0), S(1.0));
  const auto f = [&](const S& tau) -> Slope<S> {
    const Arrival here = search.arrival(tau);
    return {side * here.room, side * here.room_slope};
  };
  const S guess = inside + (outside - inside) * (there.room / (there.room - beyond.room));
  const S found =
      bracketed_zero(f, min(inside, outside), max(inside, outside), guess, leaves, kTimePrecision);
  return select(leaves, found, outside);
}

/// The emission in one half of a revolution: f rises from the passage on until the lamp gets out of reach, or
/// up to the next passage since it got within reach.
template <class S>
GoedelEmission<S> FastLampSearch<S>::next_to_passage(const Revolution& within, bool second,
                                                     const Mask<S>& sought) const {
  const Arrival &from = second ? within.halfway : within.first, &to = second ? within.second : within.halfway;
  S tau = second ? within.high : within.low;
  Arrival there = second ? within.second : within.first;
  // u0 is least at the passage, and the fold's greatest for the least zeta.
  const S fold = max(from.room + from.place.u0, to.room + to.place.u0);
  const Mask<S> may_reach = (there.place.u0 < fold) | (from.place.at[3] * to.place.at[3] <= S(0.0));
  const Mask<S> lost = sought & (there.room < S(0.0)) & (there.place.u0 < S(1.01)) & may_reach;
  if (search.line.body.frame.u[3] != 0 && any(lost)) find_reach(within, second, lost, tau, there);

  const Mask<S> early = there.value < S(0.0);
  const S start = second ? within.middle : within.low, stop = second ? within.high : within.middle;
  Arrival beyond = from;
  beyond.room = select(early, to.room, from.room);
  const S end = select(early, stop, start);
  const Mask<S> reached = sought & (there.room >= S(0.0)) & ((end < tau) | (tau < end));
  GoedelEmission<S> none{};
  none.found = reached;
  if (!any(reached)) return none;

  const S last = border(tau, there, end, beyond, reached), value = search.arrival(last).value;
  const Mask<S> changes =
      reached & ((early & (value >= S(0.0))) | ((there.value >= S(0.0)) & (value < S(0.0))));
  none.found = changes;
  if (!any(changes)) return none;
  const auto f = [&](const S& time) -> Slope<S> {
    const Arrival here = search.arrival(time);
    return {here.value, here.slope};
  };
  const S guess = tau + (last - tau) * (there.value / (there.value - value));
  return search.at(bracketed_zero(f, min(tau, last), max(tau, last), guess, changes, kTimePrecision),
                   changes);
}

/// The emission in one half of a revolution: where f changes its sign if it is within reach there, or else
/// next to the passage.
template <class S>
GoedelEmission<S> FastLampSearch<S>::in_half(const Revolution& within, bool second,
                                             const Mask<S>& sought) const {
  const Arrival &from = second ? within.halfway : within.first, &to = second ? within.second : within.halfway;
  const S start = second ? within.middle : within.low, stop = second ? within.high : within.middle;
  const Mask<S> changes = sought & (from.value < S(0.0)) & (to.value >= S(0.0));
  GoedelEmission<S> out{};
  out.found = changes;
  Mask<S> left = sought;
  if (any(changes)) {
    const auto f = [&](const S& time) -> Slope<S> {
      const Arrival here = search.arrival(time);
      return {here.value, here.slope};
    };
    const S guess = start + (stop - start) * (from.value / (from.value - to.value));
    out = search.at(bracketed_zero(f, start, stop, guess, changes, kTimePrecision), changes);
    left = left & !out.found;
  }
  if (!any(left)) return out;
  return select(out.found, out, next_to_passage(within, second, left));
}

/// Emission number `which` of those in the revolution in question and its neighbours.
template <class S>
GoedelEmission<S> FastLampSearch<S>::emission(int which) const {
  const Passages along = passages();
  const S n = number_of_emission(along);
  GoedelEmission<S> out{};
  S count(-1.0);
  // By how much f may sink within half a revolution.
  const S drop = S(0.5 * max(-GoedelPace(search.line).least, 0.0)) * along.period;
  S before(0.0), after(0.0);  // f at the two passages
  for (const double shift : {0.0, -1.0, 1.0}) {
    Mask<S> open = count < S(which);
    if (shift < 0) open = open & (before > S(-2.0) * drop);
    if (shift > 0) open = open & (after < S(2.0) * drop);
    if (!any(open)) continue;
    const Revolution within = revolution(along, n + S(shift));
    if (shift == 0) before = within.first.value, after = within.second.value;
    for (const bool second : {false, true}) {
      // If the lamp is within reach at an end, f is on its way up there.
      const Arrival &from = second ? within.halfway : within.first,
                    &to = second ? within.second : within.halfway;
      const Mask<S> out_of_question = ((from.room >= S(0.0)) & (from.value > S(0.0))) |
                                      ((to.room >= S(0.0)) & (to.value <= S(0.0))) | (from.value > drop) |
                                      (to.value < -drop);
      const Mask<S> sought = open & (count < S(which)) & !out_of_question;
      const GoedelEmission<S> one = in_half(within, second, sought);
      count = count + select(one.found, S(1.0), S(0.0));
      out = select(one.found, one, out);
    }
  }
  out.found = count == S(which);
  return out;
}

NULLCONE_KERNEL_END
