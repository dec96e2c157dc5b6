#include "core/trace/follow.h"

#include <algorithm>
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <cmath>

#include "core/base/boost.h"
#include "core/base/error.h"
#include "core/trace/metric.h"

namespace nullcone {

namespace {

using host::Tetrad;
using host::Vec3;
using host::Vec4;
using V4 = Vec4<double>;

constexpr std::size_t kSize = 20;
using State =
    std::vector<double>;  ///< event, u, and three axes; GCC 12 takes Odeint's arrays for uninitialised

V4 part(const State& state, std::size_t number) {
  return V4::map([&](std::size_t i) { return state[4 * number + i]; });
}
void put(const V4& v, std::size_t number, State& state) {
  for (std::size_t i = 0; i < 4; ++i) state[4 * number + i] = v[i];
}

/// One spacetime with the values of its parameters.
struct Ground {
  const Spacetime& spacetime;
  std::span<const double> parameters;

  host::Matrix4<double> g(const V4& x) const {
    const auto rows = spacetime.metric(parameters, x.c);
    return {V4{rows[0]}, V4{rows[1]}, V4{rows[2]}, V4{rows[3]}};
  }
  double inner(const V4& x, const V4& a, const V4& b) const { return host::inner(g(x), a, b); }
  /// Gamma^mu_ab u^a v^b.
  V4 connection(const V4& x, const V4& u, const V4& v) const {
    return V4{spacetime.connection(parameters, x.c, u.c, v.c)};
  }
  Tetrad<double> tetrad(const V4& x, ObserverFrame frame) const {
    const auto axes = spacetime.observer_tetrad(parameters, x.c, frame);
    return {{V4{axes[0]}, V4{axes[1]}, V4{axes[2]}, V4{axes[3]}}};
  }
};

/// An observer who keeps an acceleration along his own axes: Du/dtau = a^i e_i, De_i/dtau = a^i u.
struct Accelerated {
  const Ground& ground;
  Triple a;

  void operator()(const State& state, State& rate, double) const {
    const V4 x = part(state, 0), u = part(state, 1);
    put(u, 0, rate);
    V4 push{};
    for (std::size_t i = 0; i < 3; ++i) {
      const V4 e = part(state, 2 + i);
      push = push + a[i] * e;
      put(a[i] * u - ground.connection(x, u, e), 2 + i, rate);
    }
    put(push - ground.connection(x, u, u), 1, rate);
  }
};

/// Round the chart's z axis at a constant rate: the motion of a symmetry, with u = (t', J x w, 0).
struct Circling {
  const Ground& ground;
  V4 start;
  double time_rate, turning;  ///< a unit of proper time

  std::pair<V4, V4> at(double tau) const {
    const double c = std::cos(turning * tau), s = std::sin(turning * tau);
    const V4 x = {
        {start[0] + time_rate * tau, c * start[1] - s * start[2], s * start[1] + c * start[2], start[3]}};
    return {x, V4{{time_rate, -turning * x[2], turning * x[1], 0}}};
  }
  V4 acceleration(const V4& x, const V4& u) const {
    const V4 bend = {{0, -turning * u[2], turning * u[1], 0}};
    return bend + ground.connection(x, u, u);
  }
  /// Axes are Fermi-Walker transported: De/dtau = -g(a, e) u.
  void operator()(const State& state, State& rate, double tau) const {
    const auto [x, u] = at(tau);
    const V4 a = acceleration(x, u);
    std::ranges::fill(rate, 0.0);
    for (std::size_t i = 0; i < 3; ++i) {
      const V4 e = part(state, 2 + i);
      put(-(ground.inner(x, a, e) * u) - ground.connection(x, u, e), 2 + i, rate);
    }
  }
};

template <class System>
void integrate(const System& system, State& state, double tau, const std::string& place) {
  using namespace boost::numeric::odeint;
  if (tau == 0) return;
  constexpr double kRelative = 1e-13, kAbsolute = 1e-15;
  constexpr int kMostSteps = 20'000;
  int steps = 0;
  const auto count = [&](const State&, double) {
    if (++steps > kMostSteps)
      throw InputError(place, "takes too many steps to follow; expected less proper time");
  };
  try {
    integrate_adaptive(make_controlled(kAbsolute, kRelative, runge_kutta_fehlberg78<State>()),
                       std::cref(system), state, 0.0, tau, 0.01 * tau, count);
  } catch (const odeint_error&) {
    throw InputError(place,
                     "cannot be followed so far: it comes to the edge of the chart, or into a singularity");
  }
  for (const double x : state)
    if (!std::isfinite(x)) throw InputError(place, "cannot be followed so far: it leaves the chart");
}

/// d/dphi about the chart's z axis.
V4 turning_at(const V4& x) { return {{0, -x[2], x[1], 0}}; }

/// The rate dphi/dt of a geodesic circle through x: the square of d/dt + omega d/dphi has no slope across it.
double free_rate(const Ground& ground, const V4& x, bool clockwise, const std::string& place) {
  const V4 time = {{1, 0, 0, 0}}, turn = turning_at(x), out = {{0, x[1], x[2], 0}};
  const auto along = [&](const V4& a) { return ground.inner(x, a, out); };
  const double c0 = along(ground.connection(x, time, time)), c1 = along(ground.connection(x, time, turn)),
               c2 = along(ground.connection(x, turn, turn) - out);
  const double root = std::sqrt(c1 * c1 - c0 * c2);
  const double omega = (-c1 + (clockwise == (c2 > 0) ? -root : root)) / c2;
  const Circling circle{ground, x, 1, omega};
  const V4 a = circle.acceleration(x, time + omega * turn);
  const double size = std::fabs(c0) + std::fabs(c2 * omega * omega);
  const double left = std::sqrt(std::fabs(ground.inner(x, a, a)) * -ground.inner(x, out, out));
  if (!(left < 1e-7 * size)) throw InputError(place, "there is no free circular motion through this event");
  return omega;
}

/// The 4-velocity of circular motion as rates of t and phi.
Circling circling(const Ground& ground, const Motion& motion, const std::string& place) {
  const V4 x{motion.event}, time = {{1, 0, 0, 0}}, turn = turning_at(x);
  const double way = motion.clockwise ? -1 : 1, tt = ground.inner(x, time, time),
               tp = ground.inner(x, time, turn), pp = ground.inner(x, turn, turn);
  double t = 0, phi = way;  // u up to its length
  if (motion.pace == Motion::Pace::free) {
    t = 1, phi = free_rate(ground, x, motion.clockwise, place);
  } else if (motion.pace == Motion::Pace::speed) {
    // e_0 + v n: n is d/dphi without its part along e_0.
    const double unit_t = 1 / std::sqrt(tt), across = std::sqrt(tp * tp / tt - pp);
    phi = way * motion.speed / across;
    t = unit_t - phi * tp / tt;
  }
  const double square = tt * t * t + 2 * tp * t * phi + pp * phi * phi;
  if (!(square > 0))
    throw InputError(place, motion.pace == Motion::Pace::closed
                                ? "there is no closed timelike circle through this event"
                                : "is not slower than light there");
  const double length = std::sqrt(square);
  return {ground, x, t / length, phi / length};
}

/// The state of the axes along u, made of those of the tetrad.
State axes_along(const Ground& ground, const V4& x, const V4& u, ObserverFrame frame) {
  const Tetrad<double> tetrad = ground.tetrad(x, frame);
  const V4 local = host::local_components(ground.g(x), tetrad, u);
  State out(kSize);
  put(x, 0, out);
  for (std::size_t i = 0; i < 4; ++i) {
    V4 axis{};
    axis[i] = 1;
    put(tetrad.to_chart(host::boost(host::opposite(local), axis)), 1 + i, out);
  }
  return out;
}

Followed followed(const State& state) {
  Followed out{part(state, 0).c, {}};
  for (std::size_t i = 0; i < 4; ++i) out.axes[i] = part(state, 1 + i).c;
  return out;
}

}  // namespace

Followed follow(const Spacetime& spacetime, std::span<const double> parameters, const Motion& motion,
                ObserverFrame frame, double tau, const std::string& place) {
  const Ground ground{spacetime, parameters};
  const V4 x{motion.event};
  if (motion.type == Motion::Type::circular) {
    const Circling circle = circling(ground, motion, place);
    State state = axes_along(ground, x, circle.at(0).second, frame);
    integrate(circle, state, tau, place);
    put(circle.at(tau).first, 0, state);
    put(circle.at(tau).second, 1, state);
    return followed(state);
  }
  const V4 u = ground.tetrad(x, frame).to_chart(host::four_velocity(Vec3<double>{motion.velocity}));
  State state = axes_along(ground, x, u, frame);
  integrate(Accelerated{ground, motion.acceleration}, state, tau, place);
  return followed(state);
}

void settle_observer(const Spacetime& spacetime, std::span<const double> parameters, Scene& scene,
                     const std::string& place) {
  Observer& observer = scene.observer;
  if (!observer.moves) return;
  const Followed now = follow(spacetime, parameters, observer.motion, observer.frame, observer.proper_time,
                              place + ": /observer");
  const Ground ground{spacetime, parameters};
  const V4 x{now.event};
  const host::Matrix4<double> g = ground.g(x);
  const Tetrad<double> tetrad = ground.tetrad(x, observer.frame);
  const auto local = [&](std::size_t i) { return host::local_components(g, tetrad, V4{now.axes[i]}); };
  const V4 u = local(0);
  if (!std::isfinite(u[0] + u[1] + u[2] + u[3]))
    throw InputError(place + ": /observer",
                     "comes to where no observer of this frame can be; near and in a black hole, try "
                     "\"frame\": \"normal\"");
  observer.event = now.event;
  for (std::size_t i = 0; i < 3; ++i) observer.velocity[i] = u[i + 1] / u[0];
  std::array<Vec3<double>, 3> axes;  // among those that the boost along u makes
  for (std::size_t i = 0; i < 3; ++i) axes[i] = host::spatial(host::boost(u, local(i + 1)));
  for (Triple* direction : {&scene.camera.forward, &scene.camera.left, &scene.camera.up}) {
    const Vec3<double> d{*direction};
    *direction = (d[0] * axes[0] + d[1] * axes[1] + d[2] * axes[2]).c;
  }
  observer.moves = false;
}

}  // namespace nullcone
