// Boosts, aberration, Doppler factor, and moving spheres in flat spacetime.
#include "core/base/boost.h"

#include <numbers>

#include "tests/random_rays.h"
#include "tests/reference_cases.h"
#include "tests/sanitized.h"
#include "tests/traced.h"

namespace nullcone::test {
namespace {

using namespace nullcone::host;

TEST(SpecialRelativity, DopplerAndAberrationTables) {
  for (const json& c : cases_of("sr_doppler_aberration")) {
    const double beta = c["inputs"]["beta"];
    const Vec4<double> u = four_velocity(Vec3<double>{{0, 0, beta}});
    for (const json& row : c["expected"]["rows"]) {
      const double theta = row["theta_deg"].get<double>() * std::numbers::pi / 180;
      const Vec4<double> photon = {{1, std::sin(theta), 0, std::cos(theta)}};
      const Vec4<double> seen = boost(u, photon);
      // 1 - beta cos(theta) loses digits in plain form: gamma^2 eps.
      const double rounding = 4e-16 * u[0] * u[0];
      EXPECT_NEAR(seen[0], row["D_borchers"].get<double>(),
                  (1e-13 + rounding) * row["D_borchers"].get<double>() + 1e-13);
      EXPECT_NEAR(seen[3] / seen[0], row["cos_theta_prime"].get<double>(), 1e-12 + rounding)
          << c["id"] << row["theta_deg"];
    }
  }
}

TEST(SpecialRelativity, AberrationInThreeDimensions) {
  for (const json& c : cases_of("sr_aberration_3d")) {
    const Vec4<double> u = four_velocity(to_vec3(c["inputs"]["beta_vec"]));
    const Vec3<double> look = to_vec3(c["inputs"]["look_dir_S"]);
    const Vec4<double> seen = boost(u, Vec4<double>{{1, -look[0], -look[1], -look[2]}});
    expect_case(c, "D", seen[0], c["expected"]["D_borchers"]);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(-seen[i + 1] / seen[0], c["expected"]["look_dir_Sprime"][i].get<double>(), 2e-14);
    const Vec3<double> m = {{-seen[1] / seen[0], -seen[2] / seen[0], -seen[3] / seen[0]}};
    const Vec4<double> back = seen_photon(u, m);  // the photon seen there, frequency 1 for the observer
    EXPECT_NEAR(back[0] * seen[0], 1, 1e-13);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(-back[i + 1] / back[0], look[i], 1e-13);
  }
}

TEST(SpecialRelativity, BoostIsALorentzTransformation) {
  Random random(1);
  for (int n = 0; n < 1000; ++n) {
    const Vec4<double> u = four_velocity(random.uniform(0, 0.999) * random.direction());
    const Vec4<double> x = random.event(3), y = boost(opposite(u), boost(u, x));
    const Vec4<double> rest = boost(u, u);
    EXPECT_NEAR(rest[0], 1, 1e-12);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(y[i], x[i], 1e-13 * u[0] * u[0] * norm(x));
  }
}

std::string moving_sphere(double beta, double t, const std::string& more = "") {
  return R"({"metric": {"name": "minkowski"}, "observer": {"event": [)" + std::to_string(t) +
         R"(, 0, 0, 0])" + more +
         R"(}, "camera": {"type": "perspective", "fov_deg": 100, "resolution": [400, 300]},
    "objects": [{"name": "ball", "shape": {"type": "sphere", "radius": 1}, "placing": {"type": "local",
    "worldline": {"type": "geodesic", "event": [0, 4, 0, 0], "velocity": [0, )" +
         std::to_string(beta) + ", 0]}}}]}";
}

/// Penrose 1959: the outline of a moving sphere is a circle. For a static sphere at distance d the outline is
/// the cone of half angle asin(R/d) about its direction; a boost maps cones to cones. Every ray must agree
/// with the cone.
TEST(MovingSphere, OutlineIsACircleAndShiftIsDoppler) {
  for (const double beta : {0.0, 0.5, 0.9, 0.99}) {
    for (const double t : kSanitized ? std::vector{4.0} : std::vector{3.0, 4.0, 7.0}) {
      const Traced traced = trace_text(moving_sphere(beta, t));
      const Vec4<double> u = four_velocity(Vec3<double>{{0, beta, 0}});
      // The observation event in the sphere's rest frame (about its event at proper time 0).
      const Vec4<double> place = boost(u, Vec4<double>{{t, -4, 0, 0}});
      const Vec3<double> from_centre = spatial(place);
      const double distance = norm(from_centre), cone = std::sqrt(distance * distance - 1) / distance;
      std::vector<bool> hit(400 * 300, false);
      traced.for_each_hit([&](const HitRecord& h, std::size_t x, std::size_t y) {
        hit[y * 400 + x] = true;
        const Vec3<double> look = traced.look(x, y);
        const Vec4<double> seen = boost(u, moving(-look));  // the photon in the sphere's frame
        EXPECT_NEAR(h.shift * seen[0], 1, 1e-12);
        // In the sphere's frame everything is a straight line: distance from a quadratic.
        const Vec3<double> n = (-1 / seen[0]) * spatial(seen);
        const double b = dot(n, from_centre), path = -b - std::sqrt(b * b - distance * distance + 1);
        // lambda is measured at frequency 1 for the observer: path / frequency; near the edge the root is
        // steep.
        EXPECT_NEAR(h.Z * seen[0], path, 1e-13 / h.mu * distance * u[0]);
        EXPECT_NEAR(h.mu, std::sqrt(std::max(0.0, 1 - (distance * distance - b * b))),
                    1e-12 * distance * u[0] / h.mu);
      });
      EXPECT_EQ(traced.rays_with(Status::step_limit), 0U);
      int edge = 0;
      for (std::size_t y = 0; y < 300; ++y)
        for (std::size_t x = 0; x < 400; ++x) {
          const Vec4<double> seen = boost(u, moving(-traced.look(x, y)));
          const double cosine = dot((1 / seen[0]) * spatial(seen), from_centre) / distance;
          if (std::fabs(cosine - cone) < 1e-11) continue;  // within rounding of the outline
          EXPECT_EQ(hit[y * 400 + x], cosine > cone)
              << "beta " << beta << " t " << t << " pixel " << x << "," << y;
          edge += cosine > cone;
        }
      if (beta < 0.6) {
        EXPECT_GT(edge, 100) << "the sphere should be in the picture";
      }
    }
  }
}

TEST(MovingObserver, SeesAberration) {
  const double beta = 0.8;
  const Traced traced =
      trace_text(moving_sphere(0, 0, R"(, "velocity": [)" + std::to_string(beta) + ", 0, 0]"));
  // The sphere ahead shrinks: sin of its half angle in the observer's frame by tan(a'/2) = sqrt((1-b)/(1+b))
  // tan(a/2).
  const double half = std::asin(0.25),
               seen = 2 * std::atan(std::sqrt((1 - beta) / (1 + beta)) * std::tan(half / 2));
  double widest = 0;
  traced.for_each_hit([&](const HitRecord& h, std::size_t x, std::size_t y) {
    const Vec3<double> look = traced.look(x, y);
    widest = std::max(widest, std::acos(look[0]));
    const double gamma = 1 / std::sqrt(1 - beta * beta);
    EXPECT_NEAR(h.shift, 1 / (gamma * (1 - beta * look[0])), 1e-12);
  });
  EXPECT_LT(widest, seen);
  EXPECT_GT(widest, seen - 0.006);  // a pixel
}

TEST(Sky, IsSeenByDirectionInTheStaticFrame) {
  const Traced traced = trace_text(R"({"metric": {"name": "minkowski"}, "observer": {"event": [0, 0, 0, 0],
    "velocity": [0, 0, 0.6]}, "camera": {"type": "sphere", "resolution": [64, 32]},
    "objects": [{"name": "heaven", "shape": {"type": "sky"}}]})");
  EXPECT_EQ(traced.hits(), 64U * 32U);
  EXPECT_EQ(traced.rays_with(Status::sky), 64U * 32U);
  const Vec4<double> u = four_velocity(Vec3<double>{{0, 0, 0.6}});
  traced.for_each_hit([&](const HitRecord& h, std::size_t x, std::size_t y) {
    const Vec4<double> photon = seen_photon(u, traced.look(x, y));
    EXPECT_NEAR(h.shift, 1 / photon[0], 1e-14);
    EXPECT_NEAR(std::sin((h.v - 0.5) * std::numbers::pi), -photon[3] / photon[0], 1e-13);
    EXPECT_TRUE(std::isinf(h.Z));
  });
}

}  // namespace
}  // namespace nullcone::test
