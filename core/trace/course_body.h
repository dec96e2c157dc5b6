// Rigid objects on any worldline: which proper time and which local position is an event?
#pragma once

#include "core/trace/course.h"
#include "core/trace/local_frame.h"
#include "core/trace/sight.h"

NULLCONE_KERNEL_BEGIN

/// An event of a course with its 4-velocity and axes.
template <class S>
struct CoursePoint {
  Vec4<S> event;
  std::array<Vec4<S>, 4> axes;
};

/// From values and rates at the proper time tau.v to what depends on tau.
template <class S>
const Vec4<S>& along(const Vec4<S>& value, const Vec4<S>&, const S&) {
  return value;
}
template <class S, std::size_t N>
Vec4<Dual<S, N>> along(const Vec4<S>& value, const Vec4<S>& rate, const Dual<S, N>& tau) {
  return Vec4<Dual<S, N>>::map([&](std::size_t i) { return Dual<S, N>(value[i], rate[i] * tau.d); });
}

/// A course as kernels look it up. It must outlive this.
class CourseView {
 public:
  CourseView() = default;
  CourseView(const Course& course, double begin)
      : course_(&course), legs_(course.legs.data()), count_(course.legs.size()), begin_(begin) {}

  bool is_circle() const { return count_ == 0; }
  const Course& course() const { return *course_; }
  const CourseLeg* legs() const { return legs_; }
  std::size_t count() const { return count_; }
  double begin() const { return begin_; }  ///< chart time of the event

  /// How gyroscopes, or axes that keep their directions, turn against those of `at`.
  Precession turn() const {
    if (!is_circle()) return {};
    return {course_->turn_axis, course_->turn_rate};
  }

  template <class S>
  CoursePoint<S> at(const S& tau) const {
    if (is_circle()) return on_circle(tau);
    using P = std::decay_t<decltype(plain(tau))>;
    CoursePoint<P> value, rate;
    on_legs(plain(tau), value, rate);
    CoursePoint<S> out{along(value.event, rate.event, tau), {}};
    for (std::size_t i = 0; i < 4; ++i) out.axes[i] = along(value.axes[i], rate.axes[i], tau);
    return out;
  }

 private:
  static constexpr std::size_t kNumbers = CourseLeg::kNumbers, kTerms = CourseLeg::kTerms;

  template <class S>
  CoursePoint<S> on_circle(const S& tau) const {
    const auto [s, c] = sincos(S(course_->turning) * tau);
    const Complex<S> turn = {c, s};
    CoursePoint<S> out{turned_about_e3(turn, convert<S>(Vec4<double>{course_->start})), {}};
    out.event[0] = S(begin_) + S(course_->time_rate) * tau;
    for (std::size_t i = 0; i < 4; ++i)
      out.axes[i] = turned_about_e3(turn, convert<S>(Vec4<double>{course_->axes[i]}));
    return out;
  }

  const CourseLeg& leg_at(double tau) const {
    std::size_t low = 0, high = count_ - 1;
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      if (tau > legs_[middle].until)
        low = middle + 1;
      else
        high = middle;
    }
    return legs_[low];
  }

  /// Clenshaw's sum of Chebyshev polynomials, all numbers side by side.
  static void sum(const CourseLeg::Terms& terms, double s, double* out) {
    double b1[kNumbers] = {}, b2[kNumbers] = {};
    for (std::size_t j = kTerms - 1; j > 0; --j)
      for (std::size_t i = 0; i < kNumbers; ++i) {
        const double b = terms[j][i] + 2 * s * b1[i] - b2[i];
        b2[i] = b1[i], b1[i] = b;
      }
    for (std::size_t i = 0; i < kNumbers; ++i) out[i] = terms[0][i] + s * b1[i] - b2[i];
  }

  template <class S>
  void on_legs(const S& tau, CoursePoint<S>& value, CoursePoint<S>& rate) const {
    constexpr std::size_t kLanes = Lanes<S>::count;
    double columns[2][kNumbers][kLanes];
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double at = Lanes<S>::get(tau, lane);
      const CourseLeg& leg = leg_at(at);
      const double s = (2 * at - leg.from - leg.until) / (leg.until - leg.from);
      double numbers[kNumbers];
      sum(leg.value, s, numbers);
      for (std::size_t i = 0; i < kNumbers; ++i) columns[0][i][lane] = numbers[i];
      sum(leg.rate, s, numbers);
      for (std::size_t i = 0; i < kNumbers; ++i) columns[1][i][lane] = numbers[i];
    }
    for (std::size_t k = 0; k < 2; ++k) {
      CoursePoint<S>& out = k == 0 ? value : rate;
      for (std::size_t i = 0; i < 4; ++i) {
        out.event[i] = Lanes<S>::load(columns[k][i]);
        for (std::size_t j = 0; j < 4; ++j) out.axes[i][j] = Lanes<S>::load(columns[k][4 + 4 * i + j]);
      }
    }
    value.event[0] = value.event[0] + S(begin_);
  }

  const Course* course_ = nullptr;
  const CourseLeg* legs_ = nullptr;
  std::size_t count_ = 0;
  double begin_ = 0;
};

/// A part of a world tube: a ball of the chart that holds the object from t - half_t to t + half_t. There the
/// object's proper time is about tau, later by per_t a unit of chart time, and within half_tau of it.
struct TubePart {
  Vec3<double> centre{};
  double radius = 0, t = 0, half_t = 0, tau = 0, half_tau = 0, per_t = 0;
  double reach = kFar;  ///< so far its rest frame may be trusted: proper times go on everywhere in it
};

/// What a search may conclude from an event alone.
template <class S>
struct Nearby {
  S clearance;                ///< in lambda: the object is not met before; <= 0 where it may be there
  S tau;                      ///< a guess of its proper time
  S half_tau, radius, reach;  ///< of that part of the tube
};

/// All parts of a world tube.
struct Tube {
  const TubePart* parts = nullptr;
  std::size_t count = 0;
  double period_t = 0, period_tau = 0;  ///< after which it repeats itself; 0: it does not
  Vec3<double> centre{};
  double radius = 0;                  ///< a ball of the chart that holds all
  double first = -kFar, last = kFar;  ///< proper times at which the object begins and ends

  /// For what moves at most so fast in the chart, in space and in time, along lambda.
  template <class S>
  Nearby<S> near(const Vec4<S>& event, const S& speed, const S& pace) const {
    const Vec3<S> X = spatial(event);
    Nearby<S> out{S(kFar), S(0.0), S(0.0), S(0.0), S(0.0)};
    const S per_speed = S(1.0) / speed, per_pace = S(1.0) / pace;
    for (std::size_t i = 0; i < count; ++i) {
      const TubePart& part = parts[i];
      S late = event[0] - S(part.t), times(0.0);
      if (period_t != 0) {
        times = floor(S(1 / period_t) * late + S(0.5));
        late = late - S(period_t) * times;
      }
      const S in_space = (norm(X - convert<S>(part.centre)) - S(part.radius)) * per_speed;
      const S in_time = (abs(late) - S(part.half_t)) * per_pace;
      // The tube has room about the object: into a part of that a step may lead, lest it take ages to come
      // near.
      const S room =
          select(in_space > in_time, S(0.03 * part.radius) * per_speed, S(0.03 * part.half_t) * per_pace);
      const S outside = max(in_space, in_time),
              clearance = select(outside > S(0.0), max(outside, room), outside);
      const auto nearer = clearance < out.clearance;
      const S since = max(S(-part.half_tau), min(S(part.half_tau), S(part.per_t) * late));
      out.clearance = select(nearer, clearance, out.clearance);
      out.tau = select(nearer, S(part.tau) + S(period_tau) * times + since, out.tau);
      out.half_tau = select(nearer, S(part.half_tau), out.half_tau);
      out.radius = select(nearer, S(part.radius), out.radius);
      out.reach = select(nearer, S(part.reach), out.reach);
    }
    return out;
  }
};

/// For the record: a rigid object at proper time tau of its course. Where the metric has isometries, the one
/// of P(tau) carries it, elsewhere it is right to first order in X (as TangentBody in march_object.h).
template <Metric M>
struct CourseBody {
  M metric;
  CourseView line;
  Matrix3<double> own_axes;  ///< rows: the object's axes along those of the course at proper time 0
  Precession turn, spin;
  Tube tube{};

  template <class S>
  std::pair<S, Vec3<S>> local(const Vec4<S>& event, const S& tau) const {
    const CoursePoint<S> P = line.at(tau);
    Vec4<S> v;  // lower components of what leads from P to the event
    if constexpr (HasIsometry<M>)
      v = opposite(metric.to_origin(P.event, event));
    else
      v = metric.g(P.event) * (event - P.event);
    const Vec3<S> X = {{-dot(P.axes[1], v), -dot(P.axes[2], v), -dot(P.axes[3], v)}};
    Vec3<S> out = turn.rate == 0 ? X : turn.rotate(tau, X, -1);
    out = Matrix3<S>{convert<S>(own_axes[0]), convert<S>(own_axes[1]), convert<S>(own_axes[2])} * out;
    return {dot(P.axes[0], v), spin.rate == 0 ? out : spin.rotate(tau, out, -1)};
  }
  template <class S>
  Vec4<S> event(const S& tau, const Vec3<S>& of_object) const {
    const CoursePoint<S> P = line.at(tau);
    Vec3<S> X = spin.rate == 0 ? of_object : spin.rotate(tau, of_object, 1);
    X = X[0] * convert<S>(own_axes[0]) + X[1] * convert<S>(own_axes[1]) + X[2] * convert<S>(own_axes[2]);
    if (turn.rate != 0) X = turn.rotate(tau, X, 1);
    const Vec4<S> v = X[0] * P.axes[1] + X[1] * P.axes[2] + X[2] * P.axes[3];
    if constexpr (HasIsometry<M>)
      return metric.from_origin(P.event, v);
    else
      return P.event + v;
  }
  template <class S>
  S first_guess(const Vec4<S>& event) const {
    return tube.near(event, S(1.0), S(1.0)).tau;
  }
};

NULLCONE_KERNEL_END
