#include "core/trace/travel.h"

#include <algorithm>
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <cmath>
#include <limits>

#include "core/base/boost.h"
#include "core/base/error.h"
#include "core/trace/event_spline.h"
#include "core/trace/ground.h"

namespace nullcone {

namespace {

using host::Tetrad;
using host::V4;
using host::Vec3;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Vectors of four components, one behind the other. (GCC 12 takes Odeint's arrays for uninitialised.)
using State = std::vector<double>;

V4 part(const State& state, std::size_t number) {
  return V4::map([&](std::size_t i) { return state[4 * number + i]; });
}
void put(const V4& v, std::size_t number, State& state) {
  for (std::size_t i = 0; i < 4; ++i) state[4 * number + i] = v[i];
}

/// Takes a state from one proper time to another. rate(state, slope, tau) is the system.
template <class System>
void integrate(const System& rate, State& state, double from, double to, const std::string& place) {
  using namespace boost::numeric::odeint;
  if (from == to) return;
  constexpr double kRelative = 1e-13, kAbsolute = 1e-15;
  constexpr int kMostSteps = 20'000;
  int steps = 0;
  const auto count = [&](const State&, double) {
    if (++steps > kMostSteps)
      throw InputError(place, "takes too many steps to follow; expected less proper time");
  };
  try {
    integrate_adaptive(make_controlled(kAbsolute, kRelative, runge_kutta_fehlberg78<State>()), rate, state,
                       from, to, 0.01 * (to - from), count);
  } catch (const odeint_error&) {
    throw InputError(place,
                     "cannot be followed so far: it comes to the edge of the chart, or into a singularity");
  }
  for (const double x : state)
    if (!std::isfinite(x)) throw InputError(place, "cannot be followed so far: it leaves the chart");
}

/// The state of somebody: event, 4-velocity, axes.
State state_of(const Followed& somebody) {
  State out(20);
  put(V4{somebody.event}, 0, out);
  for (std::size_t i = 0; i < 4; ++i) put(V4{somebody.axes[i]}, 1 + i, out);
  return out;
}
Followed somebody_of(const State& state) {
  Followed out{part(state, 0).c, {}};
  for (std::size_t i = 0; i < 4; ++i) out.axes[i] = part(state, 1 + i).c;
  return out;
}

/// The next of some sorted numbers before or behind tau.
double next_of(std::span<const double> sorted, double tau, bool ahead) {
  double out = ahead ? kNever : -kNever;
  for (const double x : sorted)
    if (ahead ? x > tau : x < tau) out = ahead ? std::min(out, x) : std::max(out, x);
  return out;
}

/// With an acceleration a that is constant along his own axes: Du/dtau = a^i e_i, De_i/dtau = a^i u.
class Pushed : public Traveller {
 public:
  Pushed(const Ground& ground, const Followed& start, const Triple& a, std::string place)
      : ground_(ground), state_(state_of(start)), a_(a), place_(std::move(place)) {}

  std::unique_ptr<Traveller> copy() const override { return std::make_unique<Pushed>(*this); }
  Followed now() const override { return somebody_of(state_); }
  void go(double tau) override {
    const auto rate = [&](const State& state, State& slope, double) {
      const V4 x = part(state, 0), u = part(state, 1);
      put(u, 0, slope);
      V4 push{};
      for (std::size_t i = 0; i < 3; ++i) {
        const V4 e = part(state, 2 + i);
        push = push + a_[i] * e;
        put(a_[i] * u - connection(ground_, x, u, e), 2 + i, slope);
      }
      put(push - connection(ground_, x, u, u), 1, slope);
    };
    integrate(rate, state_, tau_, tau, place_);
    tau_ = tau;
  }

 private:
  Ground ground_;
  State state_;
  Triple a_;
  std::string place_;
  double tau_ = 0;
};

/// The same in flat spacetime, in closed form: a hyperbola, or a straight line.
class FlatPushed : public Traveller {
 public:
  FlatPushed(const Followed& start, const Triple& a) : start_(start), now_(start) {
    a_ = host::norm(Vec3<double>{a});
    for (std::size_t i = 0; i < 3 && a_ > 0; ++i) along_[i] = a[i] / a_;
    for (std::size_t i = 0; i < 3; ++i) push_ = push_ + along_[i] * V4{start.axes[i + 1]};
  }

  std::unique_ptr<Traveller> copy() const override { return std::make_unique<FlatPushed>(*this); }
  Followed now() const override { return now_; }
  void go(double tau) override {
    const V4 x{start_.event}, u{start_.axes[0]};
    const double s = std::sinh(a_ * tau), half = std::sinh(0.5 * a_ * tau), c1 = 2 * half * half;  // cosh - 1
    const double way = a_ > 0 ? s / a_ : tau, bent = a_ > 0 ? c1 / a_ : 0;
    now_.event = (x + way * u + bent * push_).c;
    now_.axes[0] = ((1 + c1) * u + s * push_).c;
    for (std::size_t i = 0; i < 3; ++i)
      now_.axes[i + 1] = (V4{start_.axes[i + 1]} + along_[i] * (c1 * push_ + s * u)).c;
  }

 private:
  Followed start_, now_;
  double a_ = 0;
  Triple along_{};
  V4 push_{};
};

/// On a circle; axes: De/dtau = -g(a, e) u.
class Circler : public Traveller {
 public:
  Circler(const Ground& ground, const Circling& circle, const Followed& start, std::string place)
      : ground_(ground), circle_(circle), state_(state_of(start)), place_(std::move(place)) {}

  std::unique_ptr<Traveller> copy() const override { return std::make_unique<Circler>(*this); }
  Followed now() const override { return somebody_of(state_); }
  void go(double tau) override {
    const auto rate = [&](const State& state, State& slope, double at) {
      const V4 x{circle_.event(at)}, u{circle_.velocity(x.c)}, a{circle_.acceleration(ground_, x.c)};
      std::ranges::fill(slope, 0.0);
      for (std::size_t i = 2; i < 5; ++i) {
        const V4 e = part(state, i);
        put(-(inner(ground_, x, a, e) * u) - connection(ground_, x, u, e), i, slope);
      }
    };
    integrate(rate, state_, tau_, tau, place_);
    tau_ = tau;
    const Event x = circle_.event(tau);
    put(V4{x}, 0, state_);
    put(V4{circle_.velocity(x)}, 1, state_);
  }

 private:
  Ground ground_;
  Circling circle_;
  State state_;
  std::string place_;
  double tau_ = 0;
};

std::unique_ptr<Traveller> pushed(const Ground& ground, const Followed& start, const Triple& a,
                                  const std::string& place) {
  if (is_flat(ground, start.event)) return std::make_unique<FlatPushed>(start, a);
  return std::make_unique<Pushed>(ground, start, a, place);
}

/// The axes of somebody who is pushed at once to 4-velocity w: the boost from u to w.
Followed turned(const Ground& ground, Followed somebody, const V4& w) {
  const V4 x{somebody.event}, u{somebody.axes[0]};
  const double b = 1 + inner(ground, x, u, w);
  for (std::size_t i = 1; i < 4; ++i) {
    const V4 e{somebody.axes[i]};
    somebody.axes[i] = (e - (inner(ground, x, e, w) / b) * (u + w)).c;
  }
  somebody.axes[0] = w.c;
  return somebody;
}

V4 velocity_at(const Ground& ground, const V4& x, const Triple& velocity, ObserverFrame frame) {
  return tetrad_at(ground, x, frame).to_chart(host::four_velocity(Vec3<double>{velocity}));
}

/// One geodesic after the other.
class Zigzag : public Traveller {
 public:
  Zigzag(const Ground& ground, const Motion& motion, ObserverFrame frame, const std::string& place) {
    const V4 x{motion.event};
    Followed here = boosted(ground, x.c, velocity_at(ground, x, motion.pieces[0].velocity, frame).c, frame);
    for (std::size_t i = 0; i < motion.pieces.size(); ++i) {
      const V4 at{here.event};
      here = turned(ground, here, velocity_at(ground, at, motion.pieces[i].velocity, frame));
      starts_.push_back(pushed(ground, here, {0, 0, 0}, place));
      const auto leg = starts_.back()->copy();
      leg->go(motion.pieces[i].duration);
      here = leg->now();
      begin_.push_back(i == 0 ? 0 : begin_.back() + motion.pieces[i - 1].duration);
    }
    leg_ = starts_[0]->copy();
  }

  std::unique_ptr<Traveller> copy() const override {
    auto out = std::unique_ptr<Zigzag>(new Zigzag);
    for (const auto& start : starts_) out->starts_.push_back(start->copy());
    out->begin_ = begin_, out->number_ = number_, out->leg_ = leg_->copy();
    return out;
  }
  Followed now() const override { return leg_->now(); }
  void go(double tau) override {
    const auto behind = std::ranges::upper_bound(begin_, tau) - begin_.begin();
    const auto number = static_cast<std::size_t>(std::max<std::ptrdiff_t>(behind, 1) - 1);
    if (number != number_) leg_ = starts_[number]->copy();
    number_ = number;
    leg_->go(tau - begin_[number]);
  }
  double kink(double tau, bool ahead) const override {
    return next_of(std::span(begin_).subspan(1), tau, ahead);
  }

 private:
  Zigzag() = default;

  std::vector<std::unique_ptr<Traveller>> starts_;
  std::vector<double> begin_;  ///< of the pieces
  std::size_t number_ = 0;
  std::unique_ptr<Traveller> leg_;
};

/// Along a spline, at the pace of his own clock: ds/dtau = 1/|dP/ds|; axes as on a circle.
class Scheduled : public Traveller {
 public:
  Scheduled(const Ground& ground, const Motion& motion, ObserverFrame frame, std::string place)
      : ground_(ground),
        spline_(std::make_shared<const EventSpline>(motion.events)),
        place_(std::move(place)),
        state_(17) {
    times_ = {0};
    for (std::size_t i = 0; i + 1 < motion.events.size(); ++i) times_.push_back(times_.back() + duration(i));
    const EventSpline::Point P = spline_->at(0);
    const V4 x{P.event};
    const Followed start = boosted(ground_, x.c, unit(P).c, frame);
    for (std::size_t i = 1; i < 4; ++i) put(V4{start.axes[i]}, i, state_);
  }

  std::unique_ptr<Traveller> copy() const override { return std::make_unique<Scheduled>(*this); }
  Followed now() const override {
    const EventSpline::Point P = spline_->at(state_[0]);
    Followed out{P.event, {unit(P).c}};
    for (std::size_t i = 1; i < 4; ++i) out.axes[i] = part(state_, i).c;
    return out;
  }
  void go(double tau) override {
    if (tau < 0 || tau > times_.back())
      throw InputError(
          place_, "is beyond the table; expected a proper time from 0 to " + std::to_string(times_.back()));
    const auto rate = [&](const State& state, State& slope, double) {
      const EventSpline::Point P = spline_->at(state[0]);
      const V4 x{P.event}, v{P.slope}, u = unit(P);
      const double pace = 1 / std::sqrt(inner(ground_, x, v, v));
      // Du/dtau is what is left of D(dP/ds)/ds across u.
      const V4 bend = (pace * pace) * (V4{P.bend} + connection(ground_, x, v, v));
      const V4 a = bend - inner(ground_, x, bend, u) * u;
      slope.assign(slope.size(), 0.0);
      slope[0] = pace;
      for (std::size_t i = 1; i < 4; ++i) {
        const V4 e = part(state, i);
        put(-(inner(ground_, x, a, e) * u) - connection(ground_, x, u, e), i, slope);
      }
    };
    integrate(rate, state_, tau_, tau, place_);
    tau_ = tau;
  }
  double kink(double tau, bool ahead) const override { return next_of(times_, tau, ahead); }
  bool ends_at(double tau, bool ahead) const override { return ahead ? tau >= times_.back() : tau <= 0; }

 private:
  V4 unit(const EventSpline::Point& P) const {
    const V4 v{P.slope};
    return (1 / std::sqrt(inner(ground_, V4{P.event}, v, v))) * v;
  }
  /// Proper time from event i to the next.
  double duration(std::size_t i) const {
    const double from = spline_->knot(i), to = spline_->knot(i + 1);
    for (int k = 0; k <= 16; ++k) check(i, spline_->at(from + (to - from) * k / 16));
    State tau = {0};
    const auto rate = [&](const State&, State& slope, double s) {
      const EventSpline::Point P = spline_->at(s);
      slope[0] = std::sqrt(inner(ground_, V4{P.event}, V4{P.slope}, V4{P.slope}));
    };
    integrate(rate, tau, from, to, place_);
    return tau[0];
  }
  void check(std::size_t i, const EventSpline::Point& P) const {
    const V4 x{P.event}, v{P.slope};
    const std::string where = place_ + "/events/" + std::to_string(i);
    if (!(inner(ground_, x, v, v) > 0))
      throw InputError(where, "is not slower than light on its way from here to the next event");
    if (inner(ground_, x, v, tetrad_at(ground_, x, ObserverFrame::at_rest).e[0]) < 0)
      throw InputError(where, "goes into the past; expected events in the order of proper time");
  }

  Ground ground_;
  std::shared_ptr<const EventSpline> spline_;
  std::string place_;
  State state_;  ///< s, nothing, and the axes from place 1 on
  std::vector<double> times_;
  double tau_ = 0;
};

/// d/dphi about the chart's z axis.
V4 turning_at(const V4& x) { return {{0, -x[2], x[1], 0}}; }

/// The rate dphi/dt of a geodesic circle through x: the square of d/dt + omega d/dphi has no slope across it.
double free_rate(const Ground& ground, const V4& x, bool clockwise, const std::string& place) {
  const V4 time = {{1, 0, 0, 0}}, turn = turning_at(x), out = {{0, x[1], x[2], 0}};
  const auto along = [&](const V4& a) { return inner(ground, x, a, out); };
  const double c0 = along(connection(ground, x, time, time)), c1 = along(connection(ground, x, time, turn)),
               c2 = along(connection(ground, x, turn, turn) - out);
  const double root = std::sqrt(c1 * c1 - c0 * c2);
  const double omega = (-c1 + (clockwise == (c2 > 0) ? -root : root)) / c2;
  const V4 a{Circling{x.c, 1, omega}.acceleration(ground, x.c)};
  const double size = std::fabs(c0) + std::fabs(c1 * c1 / c2) + std::fabs(c2 * omega * omega);
  const double left = std::sqrt(std::fabs(inner(ground, x, a, a)) * -inner(ground, x, out, out));
  if (!(left < 1e-7 * size)) throw InputError(place, "there is no free circular motion through this event");
  return omega;
}

}  // namespace

bool is_flat(const Ground& ground, const Event& x) {
  const V4 u = {{1, 0.3, -0.5, 0.7}};
  for (const V4& beside : {V4{{0, 0, 0, 0}}, V4{{0.1, 1, 2, 3}}, V4{{-7, -30, 20, 9}}}) {
    const V4 gamma = connection(ground, V4{x} + beside, u, u);
    for (const double component : gamma.c)
      if (component != 0) return false;
  }
  return true;
}

Followed boosted(const Ground& ground, const Event& event, const Event& velocity, ObserverFrame frame) {
  const V4 x{event}, u{velocity};
  const Tetrad<double> tetrad = tetrad_at(ground, x, frame);
  const V4 local = host::local_components(metric_at(ground, x), tetrad, u);
  Followed out{x.c, {}};
  for (std::size_t i = 0; i < 4; ++i) {
    V4 axis{};
    axis[i] = 1;
    out.axes[i] = tetrad.to_chart(host::boost(host::opposite(local), axis)).c;
  }
  return out;
}

Event Circling::event(double tau) const {
  const double c = std::cos(turning * tau), s = std::sin(turning * tau);
  return {start[0] + time_rate * tau, c * start[1] - s * start[2], s * start[1] + c * start[2], start[3]};
}

Event Circling::acceleration(const Ground& ground, const Event& x) const {
  const V4 u{velocity(x)}, bend = {{0, -turning * u[2], turning * u[1], 0}};
  return (bend + connection(ground, V4{x}, u, u)).c;
}

Circling circling(const Ground& ground, const Motion& motion, const std::string& place) {
  const V4 x{motion.event}, time = {{1, 0, 0, 0}}, turn = turning_at(x);
  const double way = motion.clockwise ? -1 : 1, tt = inner(ground, x, time, time),
               tp = inner(ground, x, time, turn), pp = inner(ground, x, turn, turn);
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
  return {x.c, t / length, phi / length};
}

double Traveller::kink(double, bool ahead) const { return ahead ? kNever : -kNever; }
bool Traveller::ends_at(double, bool) const { return false; }

std::unique_ptr<Traveller> set_out(const Ground& ground, const Motion& motion, ObserverFrame frame,
                                   const std::string& place) {
  const V4 x{motion.event};
  if (motion.type == Motion::Type::piecewise) return std::make_unique<Zigzag>(ground, motion, frame, place);
  if (motion.type == Motion::Type::tabulated)
    return std::make_unique<Scheduled>(ground, motion, frame, place);
  if (motion.type == Motion::Type::circular) {
    const Circling circle = circling(ground, motion, place);
    return std::make_unique<Circler>(ground, circle, boosted(ground, x.c, circle.velocity(x.c), frame),
                                     place);
  }
  const V4 u = velocity_at(ground, x, motion.velocity, frame);
  return pushed(ground, boosted(ground, x.c, u.c, frame), motion.acceleration, place);
}

}  // namespace nullcone
