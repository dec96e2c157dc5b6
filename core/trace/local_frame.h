// The frame of a rigid object on a geodesic worldline: which proper time and which local position is an
// event?
#pragma once

#include "core/base/boost.h"
#include "core/trace/metric.h"

NULLCONE_KERNEL_BEGIN

/// Rotation about a fixed axis at a constant rate: how gyroscopes turn against the Killing-carried frame.
struct Precession {
  std::array<double, 3> axis = {0, 0, 1};
  double rate = 0;  ///< radians a unit of proper time

  /// Of axes whose components change by dR/dtau = -W R, the indices from 1.
  static Precession of(const double (&W)[4][4]) {
    const Vec3<double> omega = {{W[2][3] - W[3][2], W[3][1] - W[1][3], W[1][2] - W[2][1]}};
    Precession out;
    out.rate = 0.5 * norm(omega);
    if (out.rate > 0) out.axis = normalised(omega).c;
    return out;
  }

  /// Rotates X by -angle (into the frame of the gyroscopes) or +angle (out of it), by Rodrigues' formula.
  template <class S>
  Vec3<S> rotate(const S& tau, const Vec3<S>& X, double sign) const {
    const auto [s, c] = sincos(S(sign * rate) * tau);
    const auto n = convert<S>(axis);
    return c * X + s * cross(n, X) + ((S(1.0) - c) * dot(n, X)) * n;
  }
};

template <class S>
Vec3<S> turn_about_e3(const Complex<S>& turn, const Vec3<S>& X) {
  const Complex<S> w = turn * Complex<S>{X[0], X[1]};
  return {{w.re, w.im, X[2]}};
}

/// A rigid local object: P(tau) a geodesic (or static) worldline; a point X of the object at its proper time
/// tau is the event that the isometry of P(tau) makes of the boosted (0, X). Exact where the metric has
/// isometries.
template <Metric M>
struct LocalFrame {
  M metric;
  Vec4<double> start;      ///< P(0)
  Vec4<double> u;          ///< 4-velocity in the static tetrad at P(0)
  bool gyroscope = false;  ///< axes parallel-transported, or tied to the static tetrad
  Precession precession;   ///< set by prepare()
  Matrix3<double> axes = {{{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}};  ///< rows: the object's axes at tau = 0
  Precession spin = {};                                              ///< about an axis of its own

  template <class S>
  auto worldline() const {
    return metric.path(convert<S>(start), convert<S>(u));
  }

  /// (T', X'): T' (zero for events simultaneous with P(tau) in the rest frame) and position along the boosted
  /// static axes.
  template <class S>
  Vec4<S> rest(const Vec4<S>& event, const S& tau) const {
    const PathPoint<S> P = worldline<S>().at(tau);
    return boost(P.local, metric.to_origin(P.event, event));
  }

  /// From the boosted static axes at P(tau) to the object's own axes.
  template <class S>
  Vec3<S> to_object(const S& tau, const Vec3<S>& X) const {
    const Vec3<S> out = to_axes(tau, X);
    return spin.rate == 0 ? out : spin.rotate(tau, out, -1);
  }
  /// The same but for its spin.
  template <class S>
  Vec3<S> to_axes(const S& tau, Vec3<S> X) const {
    if (gyroscope) X = precession.rotate(tau, turn_about_e3(conj(worldline<S>().turn(tau)), X), -1);
    return Matrix3<S>{convert<S>(axes[0]), convert<S>(axes[1]), convert<S>(axes[2])} * X;
  }

  /// The event of a point of the object at its proper time tau.
  template <class S>
  Vec4<S> event(const S& tau, const Vec3<S>& of_object) const {
    const Vec3<S> X = spin.rate == 0 ? of_object : spin.rotate(tau, of_object, 1);
    Vec3<S> rest_position =
        X[0] * convert<S>(axes[0]) + X[1] * convert<S>(axes[1]) + X[2] * convert<S>(axes[2]);
    if (gyroscope)
      rest_position = turn_about_e3(worldline<S>().turn(tau), precession.rotate(tau, rest_position, 1));
    const PathPoint<S> P = worldline<S>().at(tau);
    const Vec4<S> local = {{S(0.0), rest_position[0], rest_position[1], rest_position[2]}};
    return metric.from_origin(P.event, boost(opposite(P.local), local));
  }

  /// Finds how gyroscopes precess. By symmetry the rate against the frame that the Killing flow along P
  /// carries is constant, so the derivative at tau = 0 tells all of it.
  void prepare();
};

/// Point n of `count`, spread evenly over the unit sphere (golden spiral).
inline Vec3<double> golden_point(int n, int count) {
  const double z = (2 * n + 1.0) / count - 1, flat = std::sqrt(1 - z * z);
  const auto [s, c] = sincos(2.399963229728653 * n);
  return {{flat * c, flat * s, z}};
}

/// Whether at its proper time tau every point of a ball can move with a body: 4-velocities must be timelike.
template <Metric M, class Body>
bool moves_timelike(const M& metric, const Body& body, double ball, double tau) {
  using D = Dual<double, 1>;
  for (int n = 0; n < 64; ++n) {
    const Vec4<D> x = body.event(D::variable(tau, 0), convert<D>(ball * golden_point(n, 64)));
    const auto event = Vec4<double>::map([&](std::size_t i) { return x[i].v; });
    const auto u = Vec4<double>::map([&](std::size_t i) { return x[i].d[0]; });
    if (!(inner(metric.g(event), u, u) > 0)) return false;
  }
  return true;
}

/// How far spatial vectors e_1 … e_3 are from orthonormal.
inline double skewness(const Matrix4<double>& g, const std::array<Vec4<double>, 4>& e) {
  double worst = 0;
  for (std::size_t i = 1; i < 4; ++i)
    for (std::size_t j = 1; j <= i; ++j)
      worst = std::fmax(worst, std::fabs(inner(g, e[i], e[j]) + (i == j ? 1 : 0)));
  return worst;
}

/// The proper time at which something is no longer late: Newton's method from `tau`, a lane at its own pace.
/// `late` takes a Dual<S, 1>. NaN where there is none nearby.
template <class S, class Lateness>
S time_of_zero(const Lateness& late, S tau) {
  auto active = tau == tau;
  for (int i = 0; i < 20 && any(active); ++i) {
    const Dual<S, 1> value = late(Dual<S, 1>::variable(tau, 0));
    const S step = value.v / value.d[0];
    tau = select(active, tau - step, tau);
    active = active & (abs(step) > S(1e-15) * (S(1.0) + abs(tau)));
  }
  return tau;
}

/// The proper time at which `event` is simultaneous with P in the rest frame.
template <Metric M>
double proper_time(const LocalFrame<M>& frame, const Vec4<double>& event, double tau) {
  using D = Dual<double, 1>;
  return time_of_zero([&](const D& time) { return frame.rest(convert<D>(event), time)[0]; }, tau);
}

/// The chart components at P(tau) of the rest-frame axis `i` (1..3) that the Killing flow carries.
template <Metric M, class S>
Vec4<S> carried_axis(const LocalFrame<M>& frame, const S& tau, std::size_t i) {
  const auto worldline = frame.template worldline<S>();
  const PathPoint<S> P = worldline.at(tau);
  Vec3<S> axis;
  for (std::size_t k = 0; k < 3; ++k) axis[k] = S(k + 1 == i ? 1.0 : 0.0);
  axis = turn_about_e3(worldline.turn(tau), axis);
  const Vec4<S> local = boost(opposite(P.local), Vec4<S>{{S(0.0), axis[0], axis[1], axis[2]}});
  return static_tetrad(frame.metric, P.event).to_chart(local);
}

template <Metric M>
void LocalFrame<M>::prepare() {
  using D = Dual<double, 1>;
  const D tau = D::variable(0.0, 0);
  const PathPoint<double> P = worldline<double>().at(0.0);
  const Matrix4<double> g = metric.g(P.event);
  // dR/dtau = -W R for the components R of a gyroscope, W_ij = -g(E_i, D E_j / dtau).
  double W[4][4] = {};
  for (std::size_t j = 1; j < 4; ++j) {
    const Vec4<D> E = carried_axis(*this, tau, j);
    const Vec4<double> value = Vec4<double>::map([&](std::size_t k) { return E[k].v; });
    const Vec4<double> slope = Vec4<double>::map([&](std::size_t k) { return E[k].d[0]; }) +
                               connection(metric, P.event, P.tangent, value);
    for (std::size_t i = 1; i < 4; ++i) W[i][j] = -inner(g, carried_axis(*this, 0.0, i), slope);
  }
  precession = Precession::of(W);
}

NULLCONE_KERNEL_END
