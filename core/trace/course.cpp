#include "core/trace/course.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/trace/circling.h"
#include "core/trace/ground.h"
#include "core/trace/local_frame.h"

namespace nullcone {

namespace {

using host::V4;
using Numbers = std::array<double, CourseLeg::kNumbers>;
using Nodes = std::array<Numbers, CourseLeg::kTerms>;
constexpr std::size_t kTerms = CourseLeg::kTerms;

/// In which components courses hold vectors.
struct Frame {
  Ground ground;
  double begin;    ///< time of the event
  bool isometric;  ///< vectors in the static tetrad, not in the chart
  bool gyroscope;  ///< axes as they are carried; else those of the static tetrad

  Event held(const V4& x, const Event& vector) const {
    if (!isometric) return vector;
    return host::local_components(metric_at(ground, x), tetrad_at(ground, x, ObserverFrame::at_rest),
                                  V4{vector})
        .c;
  }
  Numbers numbers(const Followed& somebody) const {
    const V4 x{somebody.event};
    const auto axes =
        gyroscope ? somebody.axes : boosted(ground, x.c, somebody.axes[0], ObserverFrame::at_rest).axes;
    Numbers out{};
    std::ranges::copy(somebody.event, out.begin());
    out[0] -= begin;
    for (std::size_t i = 0; i < 4; ++i)
      std::ranges::copy(held(x, axes[i]), out.begin() + 4 + 4 * static_cast<std::ptrdiff_t>(i));
    return out;
  }
};

/// Where a leg is looked at, from -1 to 1: the zeros of the first polynomial that is left out.
double node(std::size_t k) { return -std::cos(std::numbers::pi * (static_cast<double>(k) + 0.5) / kTerms); }

CourseLeg leg_through(const Nodes& nodes, double from, double until) {
  CourseLeg out{std::min(from, until), std::max(from, until), {}, {}};
  for (std::size_t j = 0; j < kTerms; ++j)
    for (std::size_t k = 0; k < kTerms; ++k) {
      const double weight =
          (j == 0 ? 1.0 : 2.0) / kTerms * std::cos(static_cast<double>(j) * std::acos(node(k)));
      for (std::size_t i = 0; i < out.kNumbers; ++i) out.value[j][i] += weight * nodes[k][i];
    }
  const double per_tau = 2 / (out.until - out.from);
  for (std::size_t i = 0; i < out.kNumbers; ++i) {
    std::array<double, kTerms + 2> slope{};
    for (std::size_t j = kTerms - 1; j > 0; --j)
      slope[j - 1] = slope[j + 1] + 2 * static_cast<double>(j) * out.value[j][i];
    for (std::size_t j = 0; j < kTerms; ++j) out.rate[j][i] = (j == 0 ? 0.5 : 1) * per_tau * slope[j];
  }
  return out;
}

/// Whether what the last terms add is within rounding, and the numbers at the end are met, where it has such.
bool is_good(const CourseLeg& leg, const Numbers* end, bool at_until) {
  constexpr double kRounding = 1e-13, kEnd = 1e-11;
  double event = 0, vectors = 0, last_event = 0, last_vectors = 0, off_event = 0, off_vectors = 0;
  for (std::size_t i = 0; i < leg.kNumbers; ++i) {
    const double last = std::fabs(leg.value[kTerms - 1][i]) + std::fabs(leg.value[kTerms - 2][i]);
    double size = 0, sum = 0;
    for (std::size_t j = 0; j < kTerms; ++j) {
      size += std::fabs(leg.value[j][i]);
      sum += (at_until || j % 2 == 0 ? 1 : -1) * leg.value[j][i];
    }
    (i < 4 ? event : vectors) = std::max(i < 4 ? event : vectors, size);
    double& worst = i < 4 ? last_event : last_vectors;
    worst = std::max(worst, last);
    double& off = i < 4 ? off_event : off_vectors;
    if (end != nullptr) off = std::max(off, std::fabs(sum - (*end)[i]));
  }
  return last_event <= kRounding * event && last_vectors <= kRounding * vectors &&
         off_event <= kEnd * event && off_vectors <= kEnd * vectors;
}

/// Lays legs one behind the other from proper time 0, forwards or backwards.
class Layer {
 public:
  Layer(const Frame& frame, const TimeSpan& seen, const std::string& place)
      : frame_(frame), seen_(seen), place_(place) {}

  std::vector<CourseLeg> lay(const Traveller& start, bool ahead) const {
    constexpr std::size_t kMost = 5000;
    std::vector<CourseLeg> out;
    std::unique_ptr<Traveller> here = start.copy();
    double tau = 0, length = (seen_.most - seen_.least) / 64;
    while (!here->ends_at(tau, ahead) && goes_on(*here, ahead)) {
      const double kink = here->kink(tau, ahead);
      const double until = ahead ? std::min(kink, tau + length) : std::max(kink, tau - length);
      if (!try_leg(here, tau, until, out)) {
        length = 0.5 * std::fabs(until - tau);
        if (!(length > 1e-9 * (seen_.most - seen_.least))) return out;  // the way ends here
        continue;
      }
      length = std::max(length, 2 * std::fabs(until - tau));
      tau = until;
      if (out.size() == kMost)
        throw InputError(place_, "turns too often on its way; expected a nearer \"max_lookback\"");
    }
    return out;
  }

 private:
  bool goes_on(const Traveller& here, bool ahead) const {
    const double t = here.now().event[0] - frame_.begin;
    return ahead ? t <= seen_.most : t >= seen_.least;
  }
  bool try_leg(std::unique_ptr<Traveller>& here, double tau, double until,
               std::vector<CourseLeg>& out) const {
    const bool ahead = until > tau;
    const auto next = here->copy();
    try {
      Nodes nodes;
      for (std::size_t n = 0; n < kTerms; ++n) {
        const std::size_t k = ahead ? n : kTerms - 1 - n;
        const double from = std::min(tau, until), to = std::max(tau, until);
        next->go(0.5 * (from + to) + 0.5 * (to - from) * node(k));
        nodes[k] = frame_.numbers(next->now());
      }
      const CourseLeg leg = leg_through(nodes, tau, until);
      next->go(until);
      const Numbers end = frame_.numbers(next->now());
      // At a kink they are those of the next leg.
      if (!is_good(leg, here->kink(tau, ahead) == until ? nullptr : &end, ahead)) return false;
      out.push_back(leg);
    } catch (const InputError&) {
      return false;
    }
    here = next->copy();
    return true;
  }

  Frame frame_;
  TimeSpan seen_;
  std::string place_;
};

/// What circular motion does to its axes: the symmetry carries them, and gyroscopes turn against that at a
/// constant rate: dR/dtau = -W R for their components R, W_ij = -g(E_i, DE_j/dtau).
Course course_on_circle(const Frame& frame, const Circling& circle) {
  const Ground& ground = frame.ground;
  const V4 x{circle.start}, u{circle.velocity(circle.start)};
  const Followed start = boosted(ground, x.c, u.c, ObserverFrame::at_rest);
  Course out;
  out.start = {0, x[1], x[2], x[3]};
  out.time_rate = circle.time_rate, out.turning = circle.turning;
  for (std::size_t i = 0; i < 4; ++i) out.axes[i] = frame.held(x, start.axes[i]);
  out.turn_rate = -circle.turning;
  const V4 a{circle.acceleration(ground, x.c)};
  out.pace = 1 / std::max(std::sqrt(std::fabs(inner(ground, x, a, a))), std::fabs(circle.turning));
  if (!frame.gyroscope) return out;
  double W[4][4] = {};
  for (std::size_t j = 1; j < 4; ++j) {
    const V4 E{start.axes[j]};
    const V4 slope = V4{{0, -circle.turning * E[2], circle.turning * E[1], 0}} + connection(ground, x, u, E);
    for (std::size_t i = 1; i < 4; ++i) W[i][j] = -inner(ground, x, V4{start.axes[i]}, slope);
  }
  const auto precession = host::Precession::of(W);
  out.turn_axis = precession.axis, out.turn_rate = precession.rate;
  return out;
}

/// A motion that stays with a static observer.
Circling at_rest(const Ground& ground, const V4& x) {
  return {x.c, tetrad_at(ground, x, ObserverFrame::at_rest).e[0][0], 0};
}

Course laid_course(const Frame& frame, const Motion& motion, const TimeSpan& seen, const std::string& place) {
  const auto start = set_out(frame.ground, motion, ObserverFrame::at_rest, place);
  const Layer layer(frame, seen, place);
  Course out;
  out.legs = layer.lay(*start, false);
  std::ranges::reverse(out.legs);
  const std::vector<CourseLeg> ahead = layer.lay(*start, true);
  out.legs.insert(out.legs.end(), ahead.begin(), ahead.end());
  if (out.legs.empty()) throw InputError(place, "cannot be followed from its event on");
  return out;
}

/// How far before and behind an observation light may be under way, in chart time.
double longest_way(const Scene& scene, const Motion& motion) {
  double size = 1;
  for (const Event& event : {scene.observer.event, motion.event})
    for (std::size_t i = 1; i < 4; ++i) size += std::fabs(event[i]);
  const double by_lambda =
      std::isfinite(scene.max_lookback) && scene.max_lookback < 1e300 ? 4 * scene.max_lookback : 100 * size;
  return std::min(by_lambda, scene.max_lookback_t);
}

/// Whether a geodesic is one that kernels cannot take as it is.
bool needs_course(const Ground& ground, const Scene& scene, const Placing& placing) {
  if (!scene.integrated || placing.type != PlacingType::local) return false;
  if (placing.spin != 0) return true;
  const bool moves = !placing.worldline.is_static();
  if (!ground.spacetime.description().isometric) return moves || placing.gyroscope_axes;
  return moves && !is_flat(ground, placing.worldline.event);
}

}  // namespace

std::shared_ptr<const Course> make_course(const Spacetime& spacetime, std::span<const double> parameters,
                                          const Motion& motion, bool gyroscope, const TimeSpan& seen,
                                          const std::string& place) {
  const Ground ground{spacetime, parameters};
  const Frame frame{ground, motion.event[0], spacetime.description().isometric, gyroscope};
  const bool rests = motion.type == Motion::Type::geodesic && motion.velocity == Triple{0, 0, 0};
  if (motion.type == Motion::Type::circular)
    return std::make_shared<const Course>(course_on_circle(frame, circling(ground, motion, place)));
  if (rests)
    return std::make_shared<const Course>(course_on_circle(frame, at_rest(ground, V4{motion.event})));
  const TimeSpan since = {seen.least - motion.event[0], seen.most - motion.event[0]};
  return std::make_shared<const Course>(laid_course(frame, motion, since, place));
}

void settle_objects(const Spacetime& spacetime, std::span<const double> parameters, Scene& scene,
                    const std::string& place) {
  const Ground ground{spacetime, parameters};
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    Object& object = scene.objects[i];
    const Worldline& line = object.placing.worldline;
    Motion motion;
    if (object.motion)
      motion = *object.motion;
    else if (needs_course(ground, scene, object.placing))
      motion.event = line.event, motion.velocity = line.velocity;
    else
      continue;
    const double now = scene.observer.event[0], way = longest_way(scene, motion);
    object.course =
        make_course(spacetime, parameters, motion, object.placing.gyroscope_axes, {now - way, now + way},
                    place + ": /objects/" + std::to_string(i) + "/placing/worldline");
  }
}

}  // namespace nullcone
