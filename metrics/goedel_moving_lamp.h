// When a freely falling lamp in the Gödel universe sends the light of one branch that an event receives.
//
// In the chart about the event light is received at f(tau) = t(tau) + T(u0(tau), zeta(tau)) if it is emitted
// at the lamp's proper time tau; f = 0 is wanted. Where the branch exists f rises, with 1/g. The lamp goes
// round in the plane, and comes nearest to the event once in each revolution; so there are two revolutions
// of which the one has f < 0 when the lamp is nearest, the next f > 0, and the light leaves between them.
// Halfway the lamp may be out of reach (u0 beyond the fold): then it leaves after the first passage or before
// the second. Fast lamps can do both, for t runs backwards beyond r = 2a; and one revolution earlier or
// later.
#pragma once

#include "core/trace/connection.h"
#include "metrics/goedel_light.h"
#include "metrics/goedel_orbit.h"

NULLCONE_KERNEL_BEGIN

/// A lamp's event in the chart about the event that it lights.
template <class S>
struct GoedelPlace {
  Vec4<S> at;
  S u0, zeta;
  Complex<S> direction;  ///< e^{i phi0}; on the axis 1

  GoedelPlace() = default;
  GoedelPlace(const Goedel& metric, const Vec4<S>& place) : at(place) {
    const Complex<S> q = metric.to_q(at);
    u0 = sqrt(norm2(q));
    zeta = S(1 / (Goedel::kSqrt2 * metric.a)) * abs(at[3]);
    const Mask<S> off = u0 > S(0.0);
    direction = {select(off, q.re / u0, S(1.0)), select(off, q.im / u0, S(0.0))};
  }
};

/// Light of one branch that leaves the lamp at one of its events.
template <class S>
struct GoedelEmission {
  Mask<S> found;
  S tau;
  Vec4<S> event;
  GoedelPlace<S> place;
  GoedelLight<S> light;
};

template <class S>
GoedelEmission<S> select(const Mask<S>& choose, const GoedelEmission<S>& a, const GoedelEmission<S>& b) {
  const auto pick = [&](const S& x, const S& y) { return select(choose, x, y); };
  const auto turn = [&](const Complex<S>& x, const Complex<S>& y) -> Complex<S> {
    return {pick(x.re, y.re), pick(x.im, y.im)};
  };
  GoedelEmission<S> out;
  out.found = (choose & a.found) | ((!choose) & b.found);
  out.tau = pick(a.tau, b.tau);
  out.event = select(choose, a.event, b.event);
  out.place.at = select(choose, a.place.at, b.place.at);
  out.place.direction = turn(a.place.direction, b.place.direction);
  out.light.lambda = pick(a.light.lambda, b.light.lambda);
  out.light.speed = pick(a.light.speed, b.light.speed);
  out.light.det = pick(a.light.det, b.light.det);
  out.light.theta = turn(a.light.theta, b.light.theta);
  return out;
}

/// 2, or 4 for lamps that are so fast that there may be two emissions in a branch: dt/dtau + |dz/dtau| < 0
/// needs sqrt2 beta_plane + beta_z > 1.
inline int branches_of_lobe(const Goedel&, const LampLine<Goedel>& line) {
  if (line.rests) return 2;
  const double gamma = line.body.frame.u[0];
  return 3 * (gamma - 1) * (gamma + 1) <= gamma * gamma ? 2 : 4;
}

/// The search for one lamp, event and branch.
template <class S>
struct GoedelEmissionSearch {
  const Goedel& metric;
  const Vec4<S>& event;
  const LampLine<Goedel>& line;
  GoedelBranch branch;

  /// f, at a place; out of reach, with the light of the fold, and beyond the lobe with that along the axis.
  struct Arrival {
    GoedelPlace<S> place;
    GoedelLight<S> light;
    S value, slope;
    S room;  ///< how far within reach
  };
  Arrival arrival(const S& tau) const;
  Arrival arrival_at(const Vec4<S>& at, const Vec4<S>& rate) const;

  /// The revolutions: the lamp is nearest at the proper times tau(n) = first + n period.
  struct Passages {
    S first, period;
    S tau(const S& number) const { return first + number * period; }
  };
  Passages passages() const;
  /// The time between two passages, and what arrives from its ends and its middle.
  struct Revolution {
    S low, middle, high;
    Arrival first, halfway, second;
  };
  Revolution revolution(const Passages& along, const S& number) const;
  S number_of_emission(const Passages& along) const;
  GoedelEmission<S> emission(const Revolution& within, const Mask<S>& second_half,
                             const Mask<S>& sought) const;
  void find_reach(const Revolution& within, const S& side, const Mask<S>& lost, S& tau, Arrival& there) const;
  GoedelEmission<S> at(const S& tau, const Mask<S>& sought) const;
  GoedelEmission<S> only() const;
  GoedelEmission<S> one_of_several(int which) const;
};

template <class S>
typename GoedelEmissionSearch<S>::Arrival GoedelEmissionSearch<S>::arrival_at(const Vec4<S>& at,
                                                                              const Vec4<S>& rate) const {
  Arrival out;
  out.place = GoedelPlace<S>(metric, at);
  const S &u0 = out.place.u0, &zeta = out.place.zeta;
  const GoedelFold<S> fold(branch, zeta);
  const S reach = min(u0, fold.F);
  const S p = root_of(branch, fold, reach, fold.exists);
  out.light = light_at(metric, branch, p, fold.zeta, reach);
  out.room = select(fold.exists, fold.F - u0, S(-2.0) - zeta);
  out.light.exists = out.room >= S(0.0);
  const GoedelLight<S>& light = out.light;
  out.value = at[0] + select(fold.exists, light.time, abs(at[3]));
  // k.u: the photon has L = 0 about the event.
  const S outward = out.place.direction.re * rate[1] + out.place.direction.im * rate[2];
  const S in_plane = light.speed * light.theta.re / sqrt(S(1.0) + u0 * u0);
  const S up = select(fold.exists, at[3] / light.lambda, select(at[3] < S(0.0), S(-1.0), S(1.0)));
  out.slope = rate[0] + in_plane * outward + up * rate[3];
  return out;
}

template <class S>
typename GoedelEmissionSearch<S>::Arrival GoedelEmissionSearch<S>::arrival(const S& tau) const {
  using D = Dual<S, 1>;
  const Vec4<D> at = metric.to_origin(convert<D>(event), line.event(D::variable(tau, 0)));
  return arrival_at(plain(at), Vec4<S>::map([&](std::size_t i) { return at[i].d[0]; }));
}

/// As for GoedelGuard: |q|^2 = C + D cos 2 psi + E sin 2 psi along the lamp's worldline.
template <class S>
typename GoedelEmissionSearch<S>::Passages GoedelEmissionSearch<S>::passages() const {
  const LocalFrame<Goedel>& frame = line.body.frame;
  const Vec4<S> start = convert<S>(frame.start), u = convert<S>(frame.u);
  const Complex<S> q0 = metric.to_q(metric.to_origin(event, start));
  const Complex<S> nu = metric.turn(event, start) * Complex<S>{u[1] / u[0], u[2] / u[0]};
  const S kappa = sqrt(S(1.0) - S(0.5) * norm2(nu));
  const Complex<S> scaled = (S(1 / Goedel::kSqrt2) * cosh_of(q0)) * nu;
  const Complex<S> w = (S(1.0) / kappa) * Complex<S>{scaled.re + q0.im, scaled.im - q0.re};
  const S E = (conj(q0) * w).re, D = S(0.5) * (norm2(q0) - norm2(w));
  const S to_tau = S(Goedel::kSqrt2 * metric.a) / (kappa * u[0]);
  return {S(0.5) * (atan2(E, D) + S(std::numbers::pi)) * to_tau, S(std::numbers::pi) * to_tau};
}

template <class S>
typename GoedelEmissionSearch<S>::Revolution GoedelEmissionSearch<S>::revolution(const Passages& along,
                                                                                 const S& number) const {
  const S low = along.tau(number), high = along.tau(number + S(1.0)), middle = S(0.5) * (low + high);
  return {low, middle, high, arrival(low), arrival(middle), arrival(high)};
}

/// n such that f < 0 at the passage n, and not at n + 1. From passage to passage t and z grow evenly.
template <class S>
S GoedelEmissionSearch<S>::number_of_emission(const Passages& along) const {
  const Vec4<double>& u = line.body.frame.u;
  const Vec4<S> nearest = metric.to_origin(event, line.event(along.first));
  const Vec4<S> rate = {{S(metric.mean_rate(u)) * along.period, S(0.0), S(0.0), S(u[3]) * along.period}};
  const auto lateness = [&](const S& n) -> Slope<S> {
    const Arrival there = arrival_at(nearest + n * rate, rate);
    return {there.value, there.slope};
  };
  // Light is no faster along z than 1, so that the slope is bounded.
  const S late = lateness(S(0.0)).value;
  const S least = S(0.99) * (rate[0] - abs(rate[3])), most = S(1.01) * (rate[0] + abs(rate[3]));
  const S one = -(late / least), other = -(late / most);
  const Mask<S> all = late == late;
  S n = floor(bracketed_zero(lateness, min(one, other), max(one, other), -(late / rate[0]), all, 1e-3));
  // What is true of the passages themselves decides, not of the number between them.
  for (int i = 0; i < 4; ++i) {
    const Mask<S> late_first = arrival(along.tau(n)).value > S(0.0),
                  early_second = arrival(along.tau(n + S(1.0))).value <= S(0.0);
    if (!any(late_first | early_second)) break;
    n = n + select(late_first, S(-1.0), select(early_second, S(1.0), S(0.0)));
  }
  return n;
}

/// A lamp that moves along z may come within reach only some time after a passage (`side` 0) or before the
/// next (1): the sample that is deepest within.
template <class S>
void GoedelEmissionSearch<S>::find_reach(const Revolution& within, const S& side, const Mask<S>& lost, S& tau,
                                         Arrival& there) const {
  constexpr int kSamples = 12;
  for (int i = 1; i <= kSamples; ++i) {
    const S part = abs(side - S(0.5 * i / kSamples)), sample = within.low + part * (within.high - within.low);
    const Arrival here = arrival(sample);
    const Mask<S> better = lost & (here.room > there.room);
    tau = select(better, sample, tau);
    there.room = select(better, here.room, there.room);
    there.value = select(better, here.value, there.value);
  }
}

/// The emission in one half of a revolution: f rises from the passage on until the lamp gets out of reach,
/// and counts as positive beyond (before a passage: as negative).
template <class S>
GoedelEmission<S> GoedelEmissionSearch<S>::emission(const Revolution& within, const Mask<S>& second_half,
                                                    const Mask<S>& sought) const {
  S tau = select(second_half, within.high, within.low);
  Arrival there = within.first;
  there.value = select(second_half, within.second.value, there.value);
  there.room = select(second_half, within.second.room, there.room);
  const Mask<S> lost = sought & (there.room < S(0.0)) & (there.place.u0 < S(1.01));
  if (line.body.frame.u[3] != 0 && any(lost))
    find_reach(within, select(second_half, S(1.0), S(0.0)), lost, tau, there);

  const Mask<S> early = there.value < S(0.0);
  const S low = select(early, tau, select(second_half, within.middle, within.low));
  const S high = select(early, select(second_half, within.high, within.middle), tau);
  const Mask<S> reached = sought & (there.room >= S(0.0)) & (low < high);
  if (!any(reached)) return at(tau, reached);
  const S outside = select(early, S(1.0), S(-1.0));
  const auto f = [&](const S& time) -> Slope<S> {
    const Arrival here = arrival(time);
    // Without a slope the step is a bisection.
    const Mask<S>& exists = here.light.exists;
    return {select(exists, here.value, outside), select(exists, here.slope, S(0.0))};
  };
  const S from = select(second_half, within.halfway.value, within.first.value),
          to = select(second_half, within.second.value, within.halfway.value);
  const Mask<S> between = (from < S(0.0)) & (to > S(0.0));
  const S part = select(between, from / (from - to), S(0.5));
  return at(bracketed_zero(f, low, high, low + (high - low) * part, reached, 1e-11), reached);
}

template <class S>
GoedelEmission<S> GoedelEmissionSearch<S>::at(const S& tau, const Mask<S>& sought) const {
  GoedelEmission<S> out;
  out.tau = tau;
  out.event = line.event(tau);
  out.place = GoedelPlace<S>(metric, metric.to_origin(event, out.event));
  out.light = light_to(metric, branch, out.place.u0, out.place.zeta);
  const S scale = abs(out.place.at[0]) + out.light.lambda;
  const S rounding = S(1e-13) * (abs(event[0]) + abs(out.event[0]) + norm(spatial(event)));
  const Mask<S> in_time = abs(out.place.at[0] + out.light.time) <= S(1e-8) * scale + rounding;
  out.found = sought & out.light.exists & in_time;
  return out;
}

/// For lamps of which f rises even where it is out of reach, with the light of the fold.
template <class S>
GoedelEmission<S> GoedelEmissionSearch<S>::only() const {
  const Passages along = passages();
  const Revolution within = revolution(along, number_of_emission(along));
  return emission(within, within.halfway.value <= S(0.0), within.low == within.low);
}

/// Emission number `which` of those in the revolution in question and its neighbours.
template <class S>
GoedelEmission<S> GoedelEmissionSearch<S>::one_of_several(int which) const {
  const Passages along = passages();
  const S n = number_of_emission(along);
  const Mask<S> all = n == n;
  GoedelEmission<S> out{};
  S count(-1.0);
  for (const double shift : {0.0, -1.0, 1.0}) {
    const Revolution within = revolution(along, n + S(shift));
    for (const bool second : {false, true}) {
      // If the lamp is within reach all the time, f has one sign on the wrong half.
      const Arrival &from = second ? within.halfway : within.first,
                    &to = second ? within.second : within.halfway;
      const Mask<S> out_of_question =
          ((from.room >= S(0.0)) & (from.value > S(0.0))) | ((to.room >= S(0.0)) & (to.value <= S(0.0)));
      const Mask<S> sought = (count < S(which)) & !out_of_question;
      const GoedelEmission<S> one = emission(within, second ? all : Mask<S>(!all), sought);
      count = count + select(one.found, S(1.0), S(0.0));
      out = select(one.found, one, out);
    }
  }
  out.found = count == S(which);
  return out;
}

template <class S>
GoedelEmission<S> emission_of(const Goedel& metric, const Vec4<S>& event, const LampLine<Goedel>& line,
                              const GoedelBranch& branch, int which) {
  const GoedelEmissionSearch<S> search{metric, event, line, branch};
  return branches_of_lobe(metric, line) == 2 ? search.only() : search.one_of_several(which);
}

NULLCONE_KERNEL_END
