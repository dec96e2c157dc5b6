// Rigid local objects: gyroscopes, frequency ratios, emission angles.
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>
#include <numbers>

#include "metrics/goedel_orbit.h"
#include "tests/random_rays.h"
#include "tests/reference_cases.h"
#include "tests/traced.h"

namespace nullcone::test {
namespace {

using namespace nullcone::host;

/// Parallel transport of the frame's axes by Boost.Odeint, independent of Killing flows and precession.
TEST(LocalFrame, GyroscopeAxesAreParallelTransported) {
  using State = std::array<double, 4>;
  Random random(1);
  for (int n = 0; n < 12; ++n) {
    const Vec3<double> beta = (n == 0 ? 0.0 : random.uniform(0.1, 0.9)) * random.direction();
    LocalFrame<Goedel> frame{Goedel{1.3}, random.event(1.5), four_velocity(beta), true, {}, {}};
    frame.axes = {{{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}};
    frame.prepare();
    const auto worldline = frame.worldline<double>();
    const double tau_end = 2.5;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // A small vector along the axis, seen as events near P: the derivative of event(tau, X) in X at X = 0.
      const auto along = [&](double tau) {
        using D = Dual<double, 1>;
        Vec3<D> X;
        X[axis] = D::variable(0.0, 0);
        const Vec4<D> x = frame.event(D(tau), X);
        return Vec4<double>::map([&](std::size_t i) { return x[i].d[0]; });
      };
      State v = along(0).c;
      const auto transport = [&](const State& x, State& dx, double tau) {
        const auto P = worldline.at(tau);
        dx = (-connection(frame.metric, P.event, P.tangent, Vec4<double>{x})).c;
      };
      boost::numeric::odeint::runge_kutta4<State> stepper;
      constexpr int kSteps = 1000;
      for (int i = 0; i < kSteps; ++i) stepper.do_step(transport, v, i * tau_end / kSteps, tau_end / kSteps);
      const Vec4<double> expected = along(tau_end);
      for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(v[i], expected[i], 1e-10 * norm(expected)) << "n " << n << " axis " << axis;
    }
  }
}

TEST(LocalFrame, StaticGyroscopesTurnWithTheDust) {
  for (const json& c : cases_of("godel_gyroscope")) {
    const double a = c["inputs"]["a"];
    LocalFrame<Goedel> frame{
        Goedel{a}, {{0, 0.4, -0.3, 0}}, {{1, 0, 0, 0}}, true, {}, {{{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}}};
    frame.prepare();
    const double tau = 0.8;
    const Vec3<double> turned = turn_about_e3(frame.worldline<double>().turn(tau),
                                              frame.precession.rotate(tau, Vec3<double>{{1, 0, 0}}, 1));
    EXPECT_NEAR(std::atan2(turned[1], turned[0]), tau / (std::numbers::sqrt2 * a), 1e-14);
  }
}

TEST(LocalFrame, EventAndRestAreInverse) {
  Random random(2);
  for (int n = 0; n < 500; ++n) {
    const double a = random.logarithmic(0.5, 1e6), speed = random.uniform(0, 0.8);
    LocalFrame<Goedel> frame{Goedel{a},
                             random.event(1),
                             four_velocity(speed * random.direction()),
                             n % 2 == 0,
                             {},
                             {{{{0, 1, 0}}, {{0, 0, 1}}, {{1, 0, 0}}}}};
    frame.prepare();
    const Vec3<double> X = random.uniform(0, 0.1) * random.direction();
    const double tau = random.uniform(-3, 3);
    const Vec4<double> x = frame.event(tau, X);
    const double found = proper_time(frame, x, tau + random.uniform(-0.1, 0.1));
    const Vec3<double> back = frame.to_object(found, spatial(frame.rest(x, found)));
    EXPECT_NEAR(found, tau, 2e-14);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(back[i], X[i], 4e-14);
  }
}

std::string goedel_scene(const std::string& placing, double radius, double t, const std::string& camera) {
  return R"({"metric": {"name": "goedel"}, "observer": {"event": [)" + std::to_string(t) +
         R"(, 0, 0, 0]}, "camera": )" + camera +
         R"(, "max_lookback": 7, "objects": [{"name": "ball", "shape": {"type": "sphere", "radius": )" +
         std::to_string(radius) + R"(}, "placing": {"type": "local", )" + placing + "}}]}";
}
const std::string kRound = R"({"type": "sphere", "resolution": [720, 360]})";

TEST(StaticSphere, WithStaticAxesHasNoShiftAnywhere) {
  const Traced traced = trace_text(goedel_scene(
      R"("worldline": {"type": "static", "event": [0, 0.9, 0.3, 0.2]}, "axes": "static")", 0.4, 0, kRound));
  EXPECT_GT(traced.hits(), 1000U);
  traced.for_each_hit([](const HitRecord& h, std::size_t, std::size_t) { EXPECT_NEAR(h.shift, 1, 1e-12); });
}

/// A gyroscope-fixed ball turns against the dust with 1/(sqrt2 a): its edges move with +-R/(sqrt2 a).
TEST(StaticSphere, WithGyroscopeAxesShiftsAtTheEdges) {
  const double R = 0.2;
  const Traced traced = trace_text(goedel_scene(
      R"("worldline": {"type": "static", "event": [0, 0.9, 0.3, 0]}, "axes": "gyroscope")", R, 0, kRound));
  double least = 2, most = 0;
  traced.for_each_hit([&](const HitRecord& h, std::size_t, std::size_t) {
    least = std::min(least, h.shift);
    most = std::max(most, h.shift);
  });
  EXPECT_NEAR(most - 1, R / std::numbers::sqrt2, 0.1 * R);
  EXPECT_NEAR(least - 1, -R / std::numbers::sqrt2, 0.1 * R);
}

/// As R -> 0 the shift tends to eq. (6.1) for a free-falling point through the origin.
TEST(FallingSphere, ShiftTendsToThePointFormula) {
  for (const json& c : cases_of("godel_frequency_shift")) {
    const double a = c["inputs"]["a"], alpha = c["inputs"]["emitter_alpha"],
                 beta = c["inputs"]["emitter_beta"];
    const double psi_e = c["inputs"]["psi_e"], expected = c["expected"]["g"];
    const Goedel metric{a};
    const double kappa = std::sqrt(1 - beta * beta / 2), gamma = 1 / std::sqrt(1 - beta * beta);
    const LocalFrame<Goedel> frame{
        metric, {}, {{gamma, gamma * beta * std::cos(alpha), gamma * beta * std::sin(alpha), 0}},
        true,   {}, {{{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}}};
    const double tau = psi_e * std::numbers::sqrt2 * a / kappa / gamma;
    const PathPoint<double> P = frame.worldline<double>().at(tau);
    // Planar light to the axis: psi = asin(u) (front) or pi - asin(u) (back); direction from the two-point
    // solution.
    const double u = std::hypot(P.event[1], P.event[2]) / (2 * a);
    const bool front = c["inputs"]["image"] == "front";
    const double Psi = front ? std::asin(u) : std::numbers::pi - std::asin(u), kap = std::sqrt(0.5);
    const double theta =
        Psi + std::atan((1 - kap) * std::sin(Psi) * std::cos(Psi) /
                        (kap * std::cos(Psi) * std::cos(Psi) + std::sin(Psi) * std::sin(Psi)));
    const double view = std::atan2(P.event[2], P.event[1]) + theta;  // the look direction in the plane
    const Vec4<double> photon = {{1, -std::cos(view), -std::sin(view), 0}};
    const PathPoint<double> Q = metric.path(Vec4<double>{}, photon).at(-2 * a * Psi);
    EXPECT_NEAR(std::hypot(Q.event[1] - P.event[1], Q.event[2] - P.event[2]), 0, 1e-12) << c["id"];
    const double frequency = inner(metric.g(P.event), Q.tangent, P.tangent);
    EXPECT_NEAR(1 / frequency, expected, 1e-12) << c["id"];
  }
}

/// A traced sphere, smaller and smaller: its shift closes in on the point's, with R.
TEST(FallingSphere, TracedShiftTendsToThePointFormula) {
  for (const json& c : cases_of("godel_frequency_shift")) {
    const double alpha = c["inputs"]["emitter_alpha"], beta = c["inputs"]["emitter_beta"],
                 g = c["expected"]["g"];
    const Vec3<double> view = to_vec3(c["expected"]["view_dir_xyz"]);
    double before = 1;
    for (const double R : {0.03, 0.003, 0.0003}) {
      json scene = {{"metric", {{"name", "goedel"}}}, {"max_lookback", 6}};
      scene["observer"]["event"] = {c["expected"]["arrival_time"], 0, 0, 0};
      const double fov = std::min(60.0, 400 * R);
      scene["camera"] = {{"type", "panorama"},
                         {"azimuth_deg", std::atan2(view[1], view[0]) * 180 / std::numbers::pi},
                         {"fov_deg", {fov, fov}},
                         {"resolution", {64, 64}}};
      const json worldline = {{"type", "geodesic"},
                              {"event", {0, 0, 0, 0}},
                              {"velocity", {beta * std::cos(alpha), beta * std::sin(alpha), 0}}};
      scene["objects"] = {{{"name", "ball"},
                           {"shape", {{"type", "sphere"}, {"radius", R}}},
                           {"placing", {{"type", "local"}, {"worldline", worldline}}}}};
      const Traced traced = trace_text(scene.dump());
      double farthest = 0;
      std::size_t count = 0;
      traced.for_each_hit([&](const HitRecord& h, std::size_t, std::size_t) {
        farthest = std::max(farthest, std::fabs(h.shift - g));
        ++count;
      });
      ASSERT_GT(count, 20U) << c["id"] << " R " << R;
      EXPECT_LT(farthest, 8 * g * R) << c["id"];  // gradients of g are of order g/a
      EXPECT_LT(farthest, 0.2 * before) << c["id"];
      before = farthest;
    }
  }
}

TEST(LocalObjects, AreMetExactlyAtTheirPoles) {
  for (const std::string metric : {"minkowski", "goedel"}) {
    const Traced traced =
        trace_text(R"({"metric": {"name": ")" + metric + R"("}, "observer": {"event": [0, 0, 0, 0]},
      "camera": {"type": "perspective", "fov_deg": 10, "resolution": [1, 1], "forward": [0, 0, 1], "up": [1, 0, 0]},
      "objects": [{"name": "ball", "shape": {"type": "sphere", "radius": 0.2}, "placing": {"type": "local",
      "worldline": {"type": "static", "event": [0, 0, 0, 3]}}}]})");
    ASSERT_EQ(traced.hits(), 1U) << metric;
    traced.for_each_hit([](const HitRecord& hit, std::size_t, std::size_t) {
      EXPECT_NEAR(hit.v, 0, 1e-12);
      EXPECT_TRUE(hit.u >= 0 && hit.u <= 1);
      EXPECT_NEAR(hit.Z, 2.8, 1e-12);
    });
  }
}

TEST(LocalObjects, FallAlongTheAxisOfTheGoedelUniverse) {
  const std::string scene = R"({"metric": {"name": "goedel"}, "observer": {"event": [0, 0.5, 0, 0]},
    "camera": {"type": "sphere", "resolution": [64, 32]},
    "objects": [{"name": "ball", "shape": {"type": "sphere", "radius": 0.2}, "placing": {"type": "local",
    "worldline": {"type": "geodesic", "event": [0, 0, 0, 1.5], "velocity": [)";
  EXPECT_GT(trace_text(scene + "0, 0, 0.3]}}}]}").hits(), 5U);
  EXPECT_EQ(trace_text(scene + "0, 0, 0.3]}}}]}").hits(), trace_text(scene + "1e-12, 0, 0.3]}}}]}").hits());
}

}  // namespace
}  // namespace nullcone::test
