// When a freely falling lamp in the Gödel universe sends the light of one branch that an event receives.
//
// In the chart about the event light is received at f(tau) = t(tau) + T(u0(tau), zeta(tau)) if it is emitted
// at the lamp's proper time tau; f = 0 is wanted. Where the branch exists f rises, with 1/g. Where the lamp
// is out of reach (u0 beyond the fold) f goes on continuously, with the light of the fold, and beyond the
// lobe with that along the axis. It still rises then, unless the lamp is fast: t runs backwards beyond r =
// 2a.
#pragma once

#include "core/trace/connection.h"
#include "metrics/goedel_light.h"
#include "metrics/goedel_orbit.h"

NULLCONE_KERNEL_BEGIN

constexpr double kTimePrecision = 1e-11;  ///< of the last step, relatively: Newton's method squares it

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

/// By how much f rises at least and at most a unit of proper time: dt lies within 1 -+ sqrt2 beta_plane, and
/// no light is faster than 1 along z.
struct GoedelPace {
  double least, most;

  explicit GoedelPace(const LampLine<Goedel>& line) {
    const Vec4<double>& u = line.body.frame.u;
    // Points of a body turn about its middle.
    const double turning = 3 * norm(line.X) / line.metric.a * u[0];
    const double spread = std::sqrt(2 * (u[1] * u[1] + u[2] * u[2])) + std::fabs(u[3]) + turning;
    least = u[0] - spread, most = u[0] + spread;
  }
};

/// 2, or 4 for lamps that are so fast that there may be two emissions in a branch.
inline int branches_of_lobe(const Goedel&, const LampLine<Goedel>& line) {
  return line.rests || GoedelPace(line).least > 0.05 * line.body.frame.u[0] ? 2 : 4;
}

/// The search for one lamp, event and branch.
template <class S>
struct GoedelEmissionSearch {
  const Goedel& metric;
  const Vec4<S>& event;
  const LampLine<Goedel>& line;
  GoedelBranch branch;

  /// f at one of the lamp's events, and how far that is within reach.
  struct Arrival {
    GoedelPlace<S> place;
    GoedelLight<S> light;
    S value, slope;
    S room, room_slope;
  };
  Arrival arrival(const S& tau) const;
  Arrival arrival_at(const Vec4<S>& at, const Vec4<S>& rate) const;
  GoedelEmission<S> at(const S& tau, const Mask<S>& sought) const;
  GoedelEmission<S> only() const;
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
  // k.u: the photon has L = 0 about the event. Out of reach u0 is that of the fold.
  const S outward = out.place.direction.re * rate[1] + out.place.direction.im * rate[2];
  const S across = S(Goedel::kSqrt2) * fold.decline * select(at[3] < S(0.0), -rate[3], rate[3]);
  out.room_slope = S(0.5 / metric.a) * (across - outward);
  const S in_plane = light.speed * light.theta.re / sqrt(S(1.0) + reach * reach);
  const S up = select(fold.exists, at[3] / light.lambda, select(at[3] < S(0.0), S(-1.0), S(1.0)));
  out.slope = rate[0] + up * rate[3] +
              select(out.light.exists, in_plane * outward, select(fold.exists, in_plane * across, S(0.0)));
  return out;
}

template <class S>
typename GoedelEmissionSearch<S>::Arrival GoedelEmissionSearch<S>::arrival(const S& tau) const {
  const Vec3<double>& X = line.X;
  if (X[0] == 0 && X[1] == 0 && X[2] == 0) {
    const PathPoint<S> P = line.body.frame.template worldline<S>().at(tau);
    const Vec4<S> place = metric.to_origin(event, P.event);
    Vec4<S> rate = metric.in_plane(place, metric.turn(event, P.event) * Complex<S>{P.local[1], P.local[2]});
    rate[0] = rate[0] + P.local[0];
    rate[3] = P.local[3];
    return arrival_at(place, rate);
  }
  using D = Dual<S, 1>;
  const Vec4<D> place = metric.to_origin(convert<D>(event), line.event(D::variable(tau, 0)));
  return arrival_at(plain(place), Vec4<S>::map([&](std::size_t i) { return place[i].d[0]; }));
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

/// For lamps for which f rises everywhere.
template <class S>
GoedelEmission<S> GoedelEmissionSearch<S>::only() const {
  const S guess = line.guess(event);
  const Arrival there = arrival(guess);
  const auto f = [&](const S& tau) -> Slope<S> {
    const Arrival here = arrival(tau);
    return {here.value, here.slope};
  };
  const S end = guess - there.value / S(0.5 * GoedelPace(line).least);
  const S tau = bracketed_zero(f, min(guess, end), max(guess, end), guess - there.value / there.slope,
                               there.value == there.value, kTimePrecision);
  return at(tau, tau == tau);
}

NULLCONE_KERNEL_END
