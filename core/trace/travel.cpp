#include "core/trace/travel.h"

#include <algorithm>
#include <cmath>

#include "core/base/boost.h"
#include "core/trace/circling.h"
#include "core/trace/travel_state.h"

namespace nullcone {

namespace {

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

double Traveller::kink(double, bool ahead) const { return ahead ? kNever : -kNever; }
bool Traveller::ends_at(double, bool) const { return false; }

std::unique_ptr<Traveller> set_out(const Ground& ground, const Motion& motion, ObserverFrame frame,
                                   const std::string& place) {
  const V4 x{motion.event};
  if (motion.type == Motion::Type::piecewise) return std::make_unique<Zigzag>(ground, motion, frame, place);
  if (motion.type == Motion::Type::tabulated) return set_out_by_table(ground, motion, frame, place);
  if (motion.type == Motion::Type::circular) {
    const Circling circle = circling(ground, motion, place);
    return std::make_unique<Circler>(ground, circle, boosted(ground, x.c, circle.velocity(x.c), frame),
                                     place);
  }
  const V4 u = velocity_at(ground, x, motion.velocity, frame);
  return pushed(ground, boosted(ground, x.c, u.c, frame), motion.acceleration, place);
}

}  // namespace nullcone
