#include "core/trace/event_spline.h"
#include "core/trace/travel_state.h"

namespace nullcone {

namespace {

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

}  // namespace

std::unique_ptr<Traveller> set_out_by_table(const Ground& ground, const Motion& motion, ObserverFrame frame,
                                            const std::string& place) {
  return std::make_unique<Scheduled>(ground, motion, frame, place);
}

}  // namespace nullcone
