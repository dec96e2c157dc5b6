// Shooting: null geodesics from a lamp at rest to an event, by Newton's method on integrated rays.
//
// In a stationary spacetime an event's worldline at rest is a point of space: three unknowns, the two angles
// of the direction at the lamp and the affine length, for three equations, that the ray's spatial coordinates
// are the event's. Derivatives along the angles are the Jacobi fields J_1, J_2 of the bundle with its vertex
// at the lamp; that along the length is the tangent. The fields give the Jacobi determinant too: as g(J_i, k)
// = 0, any vector w makes epsilon(w, k, J_1, J_2) = det D times g(w, k), and w = d_t has g(w, k) = p_t, which
// does not change along the ray. So
//   det D = sqrt(-det g) det(k, J_1, J_2) / p_t   (spatial chart components),
// signed, without counting caustics. With the vertex at the event instead, and frequency 1 there, it is
// (nu_event/nu_lamp)^2 times that: Etherington's reciprocity (Phil. Mag. 15 (1933) 761), and conjugate points
// are conjugate both ways. The lamp is the better end to shoot from: its directions are those of the scan,
// which knows them to a part of the distance from the critical curve (critical_curve.h).
#pragma once

#include "core/trace/aim.h"
#include "core/trace/connection.h"
#include "core/trace/varied_ray.h"

NULLCONE_KERNEL_BEGIN

/// Which event to reach, and where to begin: a direction in the static tetrad at the lamp, and the affine
/// length with frequency 1 there.
template <class S>
struct ShotGuess {
  Vec4<S> event;
  Aims<S> aims;
  S lambda;
};

template <class S>
struct ShotResult {
  Connection<S> connection;
  S turning;  ///< angle swept about the chart's origin, in radians
};

template <class S>
S determinant(const Vec3<S>& a, const Vec3<S>& b, const Vec3<S>& c) {
  return dot(a, cross(b, c));
}

/// sqrt(-det g).
template <Metric M, class S>
S volume_element(const M& metric, const Vec4<S>& x) {
  const Matrix4<S> m = metric.g(x);
  S det(0.0);  // by cofactors of the first row
  for (std::size_t i = 0; i < 4; ++i) {
    std::array<Vec3<S>, 3> minor{};
    for (std::size_t row = 1; row < 4; ++row)
      for (std::size_t j = 0, k = 0; j < 4; ++j)
        if (j != i) minor[row - 1][k++] = m[row][j];
    const S part = m[0][i] * determinant(minor[0], minor[1], minor[2]);
    det = i % 2 == 0 ? det + part : det - part;
  }
  return sqrt(-det);
}

/// A lamp at rest, as rays leave it.
template <Metric M>
struct Shooting {
  HamiltonSystem<M> system;
  Accuracy accuracy;
  Vec4<double> place;  ///< the lamp's event at proper time 0
  double clock;        ///< its proper time a unit of chart time, which is p_t of its light of frequency 1
  Tetrad<double> tetrad;
  Matrix4<double> lowered{};  ///< rows: g e_a
  CriticalCurve curve;
  double signed_energy;  ///< p_t times the orientation of the tetrad

  Shooting(const M& metric, const Accuracy& how, const Vec4<double>& where, const CriticalCurve& critical)
      : system{metric},
        accuracy(how),
        place(where),
        clock(std::sqrt(metric.g(where)[0][0])),
        tetrad(static_tetrad(metric, where)),
        curve(critical),
        signed_energy(clock) {
    const auto axis = [&](std::size_t i) { return spatial(tetrad.e[i]); };
    if (determinant(axis(1), axis(2), axis(3)) < 0) signed_energy = -clock;
    for (std::size_t a = 0; a < 4; ++a) lowered[a] = metric.g(where) * tetrad.e[a];
  }
  /// Of a vector of the tetrad.
  template <class S>
  Vec4<S> momentum(const Vec4<S>& k) const {
    Vec4<S> out{};
    for (std::size_t a = 0; a < 4; ++a) out = out + k[a] * convert<S>(lowered[a]);
    return out;
  }
  /// How far from a point, in the chart, a ray has met it.
  template <class S>
  S tolerance(const Vec4<S>& event) const {
    return S(accuracy.atol) + S(accuracy.rtol) * length_scale(system.metric, event);
  }
};

/// What Newton's method knows of the best shot so far.
template <class S>
struct BestShot {
  Aims<S> aims;
  S lambda, miss;  ///< affine length; how far from the event, in the chart
  VariedEnd<S> end;

  /// A miss that means nothing: `tolerance`, and what roundings and errors of directions become on the way.
  S allowed(const S& tolerance, double rtol) const {
    const auto field = [&](std::size_t i) { return norm(spatial(to_phase(part_of(end.y, i)).x)); };
    const S a = field(1) / norm(aims.load(&Aim::a)), b = field(2) / norm(aims.load(&Aim::b));
    return tolerance + S(2e-15 + 0.01 * rtol) * max(a, b);
  }
};

/// Shoots in one direction.
template <class Stepper, Metric M, class S>
BestShot<S> shoot_once(Stepper& stepper, const Shooting<M>& from, const Vec4<S>& event, const Aims<S>& aims,
                       const S& lambda, const Mask<S>& wanted) {
  BestShot<S> out;
  out.aims = aims, out.lambda = lambda;
  const auto momentum = [&](double energy, const Vec3<S>& v) {
    return from.momentum(Vec4<S>{{S(energy), v[0], v[1], v[2]}});
  };
  const Vec4<S> x = convert<S>(from.place), p = momentum(1, aims.load(&Aim::n)),
                p_a = momentum(0, aims.load(&Aim::a)), p_b = momentum(0, aims.load(&Aim::b));
  VariedState<S> y{};
  for (std::size_t i = 0; i < 4; ++i) y[i] = x[i], y[i + 4] = p[i], y[i + 12] = p_a[i], y[i + 20] = p_b[i];
  out.end = follow_varied(stepper, from.system, from.accuracy, y, lambda, wanted);
  out.miss = norm(spatial(to_phase(part_of(out.end.y, 0)).x - event));
  return out;
}

template <class S>
BestShot<S> select(const Mask<S>& choose, const BestShot<S>& x, const BestShot<S>& y) {
  const Mask<S> other = !choose, arrived = (choose & x.end.arrived) | (other & y.end.arrived);
  return {select<S>(choose, x.aims, y.aims),
          select(choose, x.lambda, y.lambda),
          select(choose, x.miss, y.miss),
          {select(choose, x.end.y, y.end.y), select(choose, x.end.dy, y.end.dy),
           select(choose, x.end.turning, y.end.turning), arrived}};
}

/// Spatial chart components at a shot's end: what it misses by, its tangent, and the Jacobi fields.
template <class S>
struct ShotMatrix {
  Vec3<S> miss, k, J1, J2;

  ShotMatrix(const BestShot<S>& shot, const Vec4<S>& event) {
    const auto x = [&](const VariedState<S>& y, std::size_t i) { return spatial(to_phase(part_of(y, i)).x); };
    miss = spatial(event) - x(shot.end.y, 0);
    k = x(shot.end.dy, 0), J1 = x(shot.end.y, 1), J2 = x(shot.end.y, 2);
  }
  S area() const { return determinant(k, J1, J2); }
  /// Newton's step (lambda, angle a, angle b), by Cramer's rule.
  Vec3<S> step() const {
    const S over = S(1.0) / area();
    return {
        {over * determinant(miss, J1, J2), over * determinant(k, miss, J2), over * determinant(k, J1, miss)}};
  }
};

/// The best shot becomes a connection, with Newton's last step added: to first order it ends at the event.
template <Metric M, class S>
ShotResult<S> to_connection(const Shooting<M>& from, const Vec4<S>& event, const BestShot<S>& best,
                            const Mask<S>& found) {
  const ShotMatrix<S> matrix(best, event);
  const Vec3<S> step = matrix.step();
  const auto good = abs(step[1]) + abs(step[2]) < S(1e-3);  // not on a caustic
  const auto [d_lambda, d_a, d_b] = select(good, step, Vec3<S>{}).c;
  const State<S> y = part_of(best.end.y, 0) + d_lambda * part_of(best.end.dy, 0) +
                     (d_a * part_of(best.end.y, 1) + d_b * part_of(best.end.y, 2));
  const Vec3<S> a = best.aims.load(&Aim::a), b = best.aims.load(&Aim::b);
  const Vec3<S> n = normalised(best.aims.load(&Aim::n) + (d_a * a + d_b * b));
  const M& metric = from.system.metric;
  const Tetrad<S> tetrad = static_tetrad(metric, event), at_lamp = Tetrad<S>{convert<S>(from.tetrad.e)};
  const Vec4<S> p = to_phase(y).p;
  const S ratio = dot(p, tetrad.e[0]);  // nu at the event over nu at the lamp
  const auto seen = normalised(Vec3<S>::map([&](std::size_t i) { return dot(p, tetrad.e[i + 1]); }));
  Connection<S> out;
  out.found = found;
  out.past = {{S(-1.0), seen[0], seen[1], seen[2]}};
  out.lambda = ratio * (best.lambda + d_lambda);
  const S travel = y[0] - S(from.place[0]), t = event[0] - travel;
  out.tau = S(from.clock) * (t - S(from.place[0]));
  const Vec4<S> k = at_lamp.to_chart(Vec4<S>{{S(1.0), n[0], n[1], n[2]}});
  const S per_angle = S(from.signed_energy) * determinant(n, a, b);
  out.det = volume_element(metric, event) * matrix.area() * ratio * ratio / per_angle;
  out.emitted = convert<S>(from.place);
  out.emitted[0] = t;
  out.tangent = (S(-1.0) / ratio) * k;
  return {out, best.end.turning};
}

/// Newton's method from a guess, a lane at its own pace: steps that do not come nearer are shortened.
template <class Stepper, Metric M, class S>
ShotResult<S> shoot(Stepper& stepper, const Shooting<M>& from, const ShotGuess<S>& guess,
                    const Mask<S>& wanted) {
  constexpr int kMostShots = 24;
  constexpr double kLeastPart = 1.0 / 256, kMostAngle = 0.3;
  const CriticalCurve& curve = from.curve;
  const S tolerance = from.tolerance(guess.event);
  auto active = wanted;
  BestShot<S> best = shoot_once(stepper, from, guess.event, guess.aims, guess.lambda, active);
  active = active & best.end.arrived & (best.miss < S(std::numeric_limits<double>::infinity()));
  S part(1.0), reduced(1.0);
  for (int i = 0; i < kMostShots; ++i) {
    // One step is still to come (to_connection), and Newton's method at least keeps its pace. But det D is
    // that of the last shot.
    const S allowed = best.allowed(tolerance, from.accuracy.rtol);
    active =
        active & ((best.miss * reduced > allowed) | (best.miss > S(1e3) * allowed)) & (part >= S(kLeastPart));
    if (!any(active)) break;
    const Vec3<S> newton = ShotMatrix<S>(best, guess.event).step();
    const S angle = norm(newton[1] * best.aims.load(&Aim::a) + newton[2] * best.aims.load(&Aim::b));
    const S most =
        min(min(S(kMostAngle) / angle, S(0.5) * best.lambda / abs(newton[0])), best.aims.allowed(newton[1]));
    const Vec3<S> step = min(part, most) * newton;
    const BestShot<S> next = shoot_once(stepper, from, guess.event, best.aims.moved(curve, step[1], step[2]),
                                        best.lambda + step[0], active);
    const auto nearer = active & next.end.arrived & (next.miss < best.miss);
    reduced = select(nearer, next.miss / best.miss, select(active, S(1.0), reduced));
    best = select(nearer, next, best);
    part = select(nearer, min(S(1.0), S(4.0) * part), select(active, S(0.25) * part, part));
  }
  // Where nothing comes nearer, what the integration itself cannot know is allowed for.
  const auto found = wanted & best.end.arrived &
                     (best.miss * reduced <= S(30.0) * best.allowed(tolerance, from.accuracy.rtol));
  return to_connection(from, guess.event, best, found);
}

/// One lane of many.
template <class S>
ShotResult<double> lane_of(const ShotResult<S>& shot, std::size_t lane) {
  std::array<bool, Lanes<S>::count> found{};
  Lanes<S>::store(shot.connection.found, found.data());
  const auto get = [&](const S& x) { return Lanes<S>::get(x, lane); };
  const auto get4 = [&](const Vec4<S>& x) {
    return Vec4<double>::map([&](std::size_t i) { return get(x[i]); });
  };
  const Connection<S>& c = shot.connection;
  return {
      {found[lane], get4(c.past), get(c.lambda), get(c.tau), get(c.det), get4(c.emitted), get4(c.tangent)},
      get(shot.turning)};
}

NULLCONE_KERNEL_END
