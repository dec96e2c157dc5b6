// A local sphere and who looks at it, carried elsewhere together by an isometry, are the same picture: record
// for record. The scenes are read and traced as any other, so all that stands between a scene and its records
// is tried, and not the isometry alone.
#include <functional>
#include <limits>
#include <numbers>

#include "core/base/boost.h"
#include "core/base/json.h"
#include "core/trace/local_frame.h"
#include "metrics/goedel.h"
#include "metrics/minkowski.h"
#include "tests/random_rays.h"
#include "tests/reference_cases.h"
#include "tests/traced.h"

namespace nullcone::test {
namespace {

using namespace nullcone::host;

struct Frame {
  Vec4<double> event;
  Vec3<double> velocity;
};
/// A scene of one sphere: its worldline, its axes, the observer, and where he looks.
struct Pair {
  Frame sphere, observer;
  Vec3<double> z_axis, y_axis, forward, up;
};

/// Where events go, and how the static axes at an event turn with them about e3.
struct Isometry {
  std::function<Vec4<double>(const Vec4<double>&)> event;
  std::function<Complex<double>(const Vec4<double>&)> turn;
};

Vec4<double> rotated(double angle, const Vec4<double>& x) {
  return turned_about_e3(Complex<double>{std::cos(angle), std::sin(angle)}, x);
}
Vec3<double> turned(const Complex<double>& turn, const Vec3<double>& v) { return turn_about_e3(turn, v); }

/// First round the axis by the angle, then from the origin to Q.
template <class M>
Isometry rotation_and_shift(const M& metric, double angle, const Vec4<double>& Q) {
  const Complex<double> round{std::cos(angle), std::sin(angle)};
  const auto event = [=](const Vec4<double>& x) { return metric.from_origin(Q, rotated(angle, x)); };
  return {event, [=](const Vec4<double>& x) { return conj(metric.turn(Q, event(x))) * round; }};
}

Pair carried(const Pair& from, const Isometry& isometry) {
  const Complex<double> at_sphere = isometry.turn(from.sphere.event),
                        at_observer = isometry.turn(from.observer.event);
  return {{isometry.event(from.sphere.event), turned(at_sphere, from.sphere.velocity)},
          {isometry.event(from.observer.event), turned(at_observer, from.observer.velocity)},
          turned(at_sphere, from.z_axis),
          turned(at_sphere, from.y_axis),
          turned(at_observer, from.forward),
          turned(at_observer, from.up)};
}

/// "static" and "gyroscope" are axes; who is at rest stands on a static worldline.
Traced traced(const json& metric, const Pair& pair, const std::string& axes) {
  const bool at_rest = norm(pair.sphere.velocity) == 0;
  json worldline = {{"type", at_rest ? "static" : "geodesic"}, {"event", pair.sphere.event.c}};
  if (!at_rest) worldline["velocity"] = pair.sphere.velocity.c;
  json scene = {{"metric", metric}, {"max_lookback", 9}};
  scene["observer"] = {{"event", pair.observer.event.c}, {"velocity", pair.observer.velocity.c}};
  scene["camera"] = {{"type", "panorama"},
                     {"forward", pair.forward.c},
                     {"up", pair.up.c},
                     {"fov_deg", {360, 180}},
                     {"resolution", {240, 120}}};
  scene["records"] = {{"channels", {"order", "uv", "shift", "t", "tau", "mu", "N", "K", "P"}}};
  scene["objects"] = {{{"name", "ball"},
                       {"shape", {{"type", "sphere"}, {"radius", 0.25}}},
                       {"placing",
                        {{"type", "local"},
                         {"axes", axes},
                         {"worldline", worldline},
                         {"z_axis", pair.z_axis.c},
                         {"y_axis", pair.y_axis.c}}}}};
  return trace_text(scene.dump());
}
double tau_origin(const Traced& traced) {
  Scene scene = traced.scene;
  return prepare_scene(find_spacetime(scene.metric), scene, "test")->tau_origin(0);
}

/// The greatest difference of any number of any record; NaN where the pictures differ in what is met.
double difference(const Traced& here, const Traced& there, const Isometry& isometry, std::size_t& compared) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const double late = tau_origin(there) - tau_origin(here);
  const Vec4<double> observed_here{here.scene.observer.event}, observed_there{there.scene.observer.event};
  double out = 0;
  const auto count = [&](double a, double b) { out = std::max(out, std::fabs(a - b)); };
  for (std::size_t band = 0; band < here.bands.size(); ++band) {
    const TracedBand &one = here.bands[band], &other = there.bands[band];
    if (one.hits.size() != other.hits.size()) return kNone;
    for (std::size_t i = 0; i < one.rays.size(); ++i)
      if (one.rays[i].status != other.rays[i].status) return kNone;
    for (std::size_t i = 0; i < one.hits.size(); ++i) {
      const HitRecord &a = one.hits[i], &b = other.hits[i];
      const HitDetail &p = one.details[i], &q = other.details[i];
      if (a.pixel != b.pixel || a.order != b.order) return kNone;
      count(a.Z, b.Z), count(a.v, b.v), count(a.shift, b.shift), count(a.mu, b.mu);
      count(std::remainder(a.u - b.u, 1), 0), count(a.tau, b.tau + late);
      for (std::size_t c = 0; c < 3; ++c) count(p.N[c], q.N[c]), count(p.K[c], q.K[c]);
      // Times and places of emission are counted from the observation; they are carried as events are.
      const Vec4<double> P = isometry.event(observed_here + Vec4<double>{{a.t, p.P[0], p.P[1], p.P[2]}});
      const Vec4<double> Q = observed_there + Vec4<double>{{b.t, q.P[0], q.P[1], q.P[2]}};
      for (std::size_t c = 0; c < 4; ++c) count(P[c], Q[c]);
      ++compared;
    }
  }
  return out;
}

/// An observer in motion who sees the sphere about the origin, at least by half of his pictures.
Pair random_pair(Random& random, double speed) {
  const Vec3<double> place = random.uniform(0.6, 1.5) * random.direction(), z = random.direction();
  const Vec3<double> forward = random.direction();
  return {
      {{}, speed * random.direction()},
      {{{random.uniform(0, 1), place[0], place[1], place[2]}}, random.uniform(0, 0.7) * random.direction()},
      z,
      normalised(cross(z, random.direction())),
      forward,
      normalised(cross(forward, random.direction()))};
}

/// Both, carried to places up to `far` away. Where the chart's static axes turn against their own copies,
/// only gyroscopes tell a falling sphere how to stand; one at rest stays where both agree.
template <class M>
void compare_copies(const M& metric, const json& name, double far, bool same_axes_everywhere) {
  Random random(7);
  std::size_t compared = 0;
  double worst = 0;
  for (const double speed : {0.0, 0.0, 0.3, 0.6})
    for (const std::string axes : {"static", "gyroscope"})
      for (int n = 0; n < 3 && (speed == 0 || axes == "gyroscope" || same_axes_everywhere); ++n) {
        const Pair pair = random_pair(random, speed);
        const Vec3<double> place = random.uniform(0.2, far) * random.direction();
        const Isometry isometry =
            rotation_and_shift(metric, random.uniform(-std::numbers::pi, std::numbers::pi),
                               {{random.uniform(-2, 2), place[0], place[1], place[2]}});
        const double found = difference(traced(name, pair, axes), traced(name, carried(pair, isometry), axes),
                                        isometry, compared);
        EXPECT_LE(found, 1e-10) << "speed " << speed << ", " << axes << " axes, scene " << n;
        worst = std::max(worst, found);
      }
  EXPECT_GT(compared, 5000U);
  std::printf("%zu records, greatest difference %.1e\n", compared, worst);
}

TEST(CarriedScene, InFlatSpaceIsTheSameRecordForRecord) {
  compare_copies(Minkowski{}, {{"name", "minkowski"}}, 4, true);
}
TEST(CarriedScene, InTheGoedelUniverseIsTheSameRecordForRecord) {
  compare_copies(Goedel{1.3}, {{"name", "goedel"}, {"a", 1.3}}, 2, false);
}

/// Both at rest, and both in the same motion: along the sphere's own velocity, where it has one, so that its
/// axes are boosted and do not turn.
TEST(CarriedScene, InFlatSpaceIsTheSameFromAMovingFrame) {
  Random random(8);
  std::size_t compared = 0;
  double worst = 0;
  for (int n = 0; n < 12; ++n) {
    Pair pair = random_pair(random, 0);
    pair.observer.velocity = {};
    const Vec3<double> along = random.direction();
    const double speed = n % 2 ? 0.5 : 0.0, frame = random.uniform(0.2, 0.9);
    pair.sphere.velocity = speed * along;
    const auto to_frame = four_velocity(-frame * along);
    const Isometry isometry{[=](const Vec4<double>& x) { return boost(to_frame, x); },
                            [](const Vec4<double>&) {
                              return Complex<double>{1, 0};
                            }};
    Pair moving = pair;
    moving.observer = {isometry.event(pair.observer.event), frame * along};
    moving.sphere.velocity = ((speed + frame) / (1 + speed * frame)) * along;
    const json name = {{"name", "minkowski"}};
    const double found =
        difference(traced(name, pair, "static"), traced(name, moving, "static"), isometry, compared);
    EXPECT_LE(found, 1e-10) << n;
    worst = std::max(worst, found);
  }
  EXPECT_GT(compared, 2000U);
  std::printf("%zu records, greatest difference %.1e\n", compared, worst);
}

}  // namespace
}  // namespace nullcone::test
