// Integrated rays about black holes against what is known exactly (docs/physics.md; reference_cases.json).
#include "metrics/kerr_schild.h"
#include "tests/followed.h"
#include "tests/random_rays.h"
#include "tests/reference_cases.h"

namespace nullcone::test {
namespace {

using namespace host;

constexpr double kCritical = 5.196152422706632;  // b_c = 3 sqrt3 M
constexpr double kPi = std::numbers::pi;

/// Chart tangent of the ray into the past along which light comes from direction m of the static frame.
Vec4<double> past(const KerrSchild& hole, const Vec4<double>& event, const Vec3<double>& m) {
  return static_tetrad(hole, event).to_chart({{-1, m[0], m[1], m[2]}});
}

/// Where the ray ends, and the azimuth it has swept about the z axis until then (to infinity, if it escapes).
struct Swept {
  double azimuth = 0, end = 0, steps = 0;
};
Swept sweep(const KerrSchild& hole, Vec4<double> x, Vec4<double> k, const Accuracy& accuracy) {
  Swept out;
  while (out.end == 0) {
    const double piece = 0.5 * norm(spatial(x)) / norm(spatial(k));
    const Followed f = follow(hole, x, k, accuracy, piece);
    Vec3<double> next = spatial(f.at.x);
    if (f.end == as_scalar<double>(Ending::sky)) next = sky_direction(hole, f.at, f.rate, f.end);
    out.azimuth += std::atan2(x[1] * next[1] - x[2] * next[0], x[1] * next[0] + x[2] * next[1]);
    out.end = f.given_up ? -1 : f.end;
    out.steps += f.steps;
    x = f.at.x, k = f.rate.x;
  }
  return out;
}

/// The look direction, in the static tetrad at (0, r, 0, 0), at the angle psi from the hole towards +y. (By
/// Gram-Schmidt e_1 is radial there.)
Vec3<double> towards_hole(double psi) { return {{-std::cos(psi), std::sin(psi), 0}}; }

constexpr Accuracy kSharp{1e-14, 0, Integrator::prince_dormand87};

TEST(Schwarzschild, DeflectionFromPeriapsis) {
  // Two halves of the path mirror each other: each sweeps (pi + deflection)/2. The periapsis moves with
  // sqrt(epsilon), so its rounding costs 1e-16/sqrt(epsilon)/epsilon^(1/2) in the deflection.
  for (json c : cases_of("schwarzschild_deflection")) {
    const double r = c["inputs"]["periapsis"], expected = c["expected"]["deflection"];
    const double eps = c["inputs"].value("b_over_bc_minus_1", 1.0);
    const Swept s = sweep({}, {{0, r, 0, 0}}, past({}, {{0, r, 0, 0}}, {{0, 1, 0}}), kSharp);
    EXPECT_EQ(s.end, as_scalar<double>(Ending::sky)) << c["id"];
    EXPECT_NEAR(2 * s.azimuth - kPi, expected, std::max(3e-12, 3e-14 / eps)) << c["id"];
  }
}

TEST(Schwarzschild, DeflectionOfRaysThatCameFromFarCloseToTheCriticalOne) {
  // From r = 1000 at the angle that belongs to b: azimuth to infinity = deflection + pi minus the part beyond
  // r, asin(b/r) + O(M b/r^2), which a ray with known deflection fixes. Perturbations grow as 1/epsilon.
  const std::vector<std::pair<double, double>> exact = {
      {1e-1, 2.0805336858689050150}, {1e-2, 4.2296618118375594197}, {1e-3, 6.5106448266014707212},
      {1e-4, 8.8104863549956068302}, {1e-6, 13.415285557794178382}, {1e-8, 18.020450767385114685}};
  const double r = 1000, f = 1 - 2 / r;
  // The azimuth from r to infinity of a ray that leaves: quadrature of dphi = b du / sqrt(1 - b^2 u^2 (1 -
  // 2u)).
  const auto beyond = [&](double b) {
    double sum = 0;
    constexpr int kN = 2000;
    for (int i = 0; i < kN; ++i) {  // Simpson's rule; the integrand is smooth
      const auto at = [&](double u) { return b / std::sqrt(1 - b * b * u * u * (1 - 2 * u)); };
      const double u0 = i / (kN * r), u1 = (i + 1) / (kN * r);
      sum += (u1 - u0) / 6 * (at(u0) + 4 * at(0.5 * (u0 + u1)) + at(u1));
    }
    return sum;
  };
  for (const auto& [eps, deflection] : exact) {
    const double b = kCritical * (1 + eps);
    const Vec4<double> event = {{0, r, 0, 0}};
    const Swept s = sweep({}, event, past({}, event, towards_hole(std::asin(b * std::sqrt(f) / r))), kSharp);
    EXPECT_EQ(s.end, as_scalar<double>(Ending::sky)) << eps;
    EXPECT_NEAR(s.azimuth + beyond(b) - kPi, deflection, 1e-11 + 5e-13 / eps) << eps;
    const Swept below =
        sweep({}, event, past({}, event, towards_hole(std::asin(kCritical * (1 - eps) * std::sqrt(f) / r))),
              kSharp);
    EXPECT_EQ(below.end, as_scalar<double>(Ending::captured)) << eps;
  }
}

TEST(Schwarzschild, CamerasSeeWhatTheOrbitEquationSays) {
  for (const json& c : cases_of("schwarzschild_camera")) {
    const double r = c["inputs"]["r_obs"], psi = c["inputs"]["view_angle_from_centre"];
    const Vec4<double> event = {{3, r, 0, 0}};
    const Swept s = sweep({}, event, past({}, event, towards_hole(psi)), kSharp);
    const std::string fate = c["expected"]["fate"];
    EXPECT_EQ(s.end == as_scalar<double>(Ending::sky), fate.starts_with("escapes")) << c["id"];
    if (!c["expected"].contains("azimuth_to_infinity")) continue;
    EXPECT_NEAR(s.azimuth, c["expected"]["azimuth_to_infinity"].get<double>(), 2e-10) << c["id"];
  }
}

TEST(Schwarzschild, ShadowEndsWhereItMust) {
  std::vector<std::pair<double, double>> cases;
  for (const json& c : cases_of("schwarzschild_shadow"))
    cases.push_back({c["inputs"]["r_obs"], c["expected"]["shadow_half_angle"]});
  for (const double above : {1e-3, 1e-6}) {  // observers that hover over the horizon; the sky is a small disc
    const double r = 2 * (1 + above), sine = kCritical * std::sqrt(above / (1 + above)) / r;
    cases.push_back({r, kPi - std::asin(sine)});
  }
  cases.push_back({1e6, std::asin(kCritical * std::sqrt(1 - 2e-6) / 1e6)});
  for (const auto& [r, angle] : cases) {
    // Close to the horizon light needs little energy, E^2 = f of the camera's: roundings of k, 1e-16/f, count
    // as 1e-16/f^2 of it.
    const double f = 1 - 2 / r, rim = (1e-7 + 1e-15 / (f * f)) * std::min(angle, kPi - angle);
    for (const double psi : {angle - rim, angle + rim}) {
      const Vec4<double> event = {{0, r, 0, 0}};
      const Followed ray = follow(KerrSchild{}, event, past({}, event, towards_hole(psi)), kSharp);
      EXPECT_EQ(ray.end, as_scalar<double>(psi < angle ? Ending::captured : Ending::sky)) << r << " " << psi;
      EXPECT_LT(std::fabs(dot(ray.at.p, ray.rate.x)), 1e-11 + 1e-14 / f) << r;
    }
  }
}

TEST(Kerr, RaysAlongTheAxisAndThroughBothPoles) {
  const KerrSchild hole{1, 0.9, 0};
  const Vec4<double> over = {{0, 0, 0, 20}};
  const Followed down = follow(hole, over, past(hole, over, {{0, 0, -1}}), kSharp);
  EXPECT_EQ(down.end, as_scalar<double>(Ending::captured));
  EXPECT_EQ(norm(Vec3<double>{{down.at.x[1], down.at.x[2], 0}}), 0);
  const Followed up = follow(hole, over, past(hole, over, {{0, 0, 1}}), kSharp);
  EXPECT_EQ(up.end, as_scalar<double>(Ending::sky));
  // Over one pole and, bent round the hole, the other: L_z = 0 all the way, Carter's constant and E too.
  for (const double psi : {0.27, 0.3, 0.5}) {
    const Vec4<double> k = past(hole, over, {{std::sin(psi), 0, -std::cos(psi)}});
    const auto before = hole.conserved(over, k);
    const Followed f = follow(hole, over, k, kSharp);
    const auto after = hole.conserved(f.at.x, f.rate.x);
    EXPECT_NEAR(before[1].second, 0, 1e-14);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(after[i].second, before[i].second, 1e-10 * (1 + std::fabs(before[2].second)))
          << psi << after[i].first;
    EXPECT_LT(std::fabs(dot(f.at.p, f.rate.x)), 1e-11);
  }
}

TEST(Kerr, CapturedRaysEndSoonWithLittleDrift) {
  const KerrSchild hole{1, 0.9, 0};
  Random random(5);
  const Accuracy accuracy{1e-8, 0, Integrator::dopri5};
  int captured = 0, many = 0;
  for (int i = 0; i < 3000; ++i) {
    const double angle = 0.2 * std::sqrt(random.uniform(0, 1)), around = random.uniform(0, 2 * kPi);
    const Vec4<double> event = {{0, 20 * std::sin(1.2), 0, 20 * std::cos(1.2)}};
    const Vec3<double> in = {{-std::sin(1.2), 0, -std::cos(1.2)}},
                       aside = {{-std::cos(1.2), 0, std::sin(1.2)}};
    const Vec3<double> m =
        std::cos(angle) * in +
        std::sin(angle) * (std::cos(around) * aside + std::sin(around) * Vec3<double>{{0, 1, 0}});
    const Followed f = follow(hole, event, past(hole, event, m), accuracy);
    ASSERT_FALSE(f.given_up);
    if (f.end != as_scalar<double>(Ending::captured)) continue;
    ++captured;
    const double drift = std::fabs(dot(f.at.p, f.rate.x)) / (f.at.p[0] * f.at.p[0]);
    EXPECT_LT(drift, f.steps > 100 ? 2e-6 : 1e-6);
    // Rays close to the critical ones go round the hole, as often as they like: straight in takes lambda
    // = 19.5.
    if (f.steps <= 100) continue;
    ++many;
    EXPECT_GT(f.lambda, 23);
  }
  EXPECT_GT(captured, 2500);
  EXPECT_LT(many, captured / 25);
}

TEST(Kerr, ObserversWhoFallInSeeTheSky) {
  // Inside the horizon, in the ingoing chart: the normal observer sees sky and blackness, and every ray ends.
  const KerrSchild hole{1, 0.9, 1};
  const Vec4<double> event = {{0, 1.3, 0.1, 0.2}};
  const Tetrad<double> frame = observer_tetrad(hole, event, ObserverFrame::normal);
  Random random(6);
  int sky = 0, dark = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3<double> m = random.direction();
    const Followed f = follow(hole, event, frame.to_chart({{-1, m[0], m[1], m[2]}}), kBalanced);
    ASSERT_FALSE(f.given_up) << i;
    (f.end == as_scalar<double>(Ending::sky) ? sky : dark) += 1;
  }
  EXPECT_GT(sky, 100);
  EXPECT_GT(dark, 100);
}

TEST(Integrator, ReachesEveryToleranceOrSaysSo) {
  const KerrSchild hole{1, 0.9, 0};
  const Vec4<double> event = {{0, 20, 0, 3}};
  for (int digits = 4; digits <= 15; ++digits)
    for (int i = 0; i < 4; ++i) {
      const Accuracy accuracy{std::pow(10, -digits), 0, static_cast<Integrator>(i)};
      for (const double psi : {0.05, 0.28, 0.9}) {
        const Followed f = follow(hole, event, past(hole, event, towards_hole(psi)), accuracy);
        EXPECT_TRUE(f.given_up || f.end > 0) << digits << kIntegratorNames[static_cast<std::size_t>(i)];
        EXPECT_FALSE(f.given_up && digits <= 12) << digits << kIntegratorNames[static_cast<std::size_t>(i)];
      }
    }
}

}  // namespace
}  // namespace nullcone::test
