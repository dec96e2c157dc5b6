// Connections between lamps at rest and events by shooting, against exact answers.
#include "metrics/goedel.h"
#include "metrics/kerr_schild.h"
#include "metrics/minkowski.h"
#include "tests/connected.h"
#include "tests/random_rays.h"
#include "tests/reference_cases.h"
#include "tests/sanitized.h"

namespace nullcone::test {
namespace {

TEST(Shooting, FlatSpaceHasOneConnection) {
  const Vec4<double> lamp = {{0, 3, -4, 1.5}};
  const std::array<Ball, 2> targets = {Ball{{{-2, 3, 0}}, 1.5}, Ball{{{3, -4, 2}}, 3}};
  const LampScan<Minkowski> scan({}, kSharp, lamp, 1, 1e6, targets.data(), 2);
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Ball& ball = targets[static_cast<std::size_t>(i % 2)];
    const Vec3<double> X = ball.centre + ball.radius * random.uniform(0.01, 1) * random.direction();
    const Vec3<double> way = spatial(lamp) - X;
    const Found found = connect(scan, {{7, X[0], X[1], X[2]}});
    ASSERT_EQ(found.connections.size(), 1u) << i;
    EXPECT_TRUE(found.complete);
    const Connection<double>& c = found.connections[0];
    EXPECT_NEAR(c.lambda, norm(way), 1e-11);
    EXPECT_NEAR(norm(spatial(c.past) - normalised(way)), 0, 1e-11);
    EXPECT_NEAR(c.det / dot(way, way), 1, 1e-8);  // as good as the last shot
    EXPECT_NEAR(c.tau, 7 - norm(way), 1e-11);
    EXPECT_EQ(found.windings[0], 0);
  }
}

/// Compares what is found with the images of a reference case, all of them up to the last.
void expect_images(const json& c, const Found& found) {
  EXPECT_TRUE(found.complete) << c["id"];
  const json& images = c["expected"]["images"];
  double last = 0;
  for (const json& image : images) last = std::max(last, image["affine_length"].get<double>());
  std::size_t n = 0;
  for (const Connection<double>& connection : found.connections) n += connection.lambda < last + 1e-6;
  ASSERT_EQ(n, images.size()) << c["id"];
  for (std::size_t i = 0; i < n; ++i) {
    const json& image = images[i];
    const Connection<double>& connection = found.connections[i];
    const bool general = image.contains("view_dir_123");
    const double travel = image[general ? "coordinate_travel_time" : "travel_time"];
    const Vec3<double> view = to_vec3(image[general ? "view_dir_123" : "view_dir_xyz"]);
    // The integration is good to 1e-12 a turn; next to a fold that is the square root of less.
    EXPECT_NEAR(connection.lambda, image["affine_length"].get<double>(), 1e-9) << c["id"] << i;
    EXPECT_NEAR(-connection.emitted[0], travel, 1e-9) << c["id"] << i;
    EXPECT_NEAR(norm(spatial(connection.past) - view), 0, 1e-9) << c["id"] << i;
    EXPECT_NEAR(connection.det, image["detD_signed"].get<double>(), 1e-7) << c["id"] << i;
  }
}

TEST(Shooting, GoedelAsInClosedForm) {
  for (const json& c : cases_of("godel_two_point")) {
    if (kSanitized && c["id"] != "godel.twopoint.4_z") continue;
    const json& in = c["inputs"];
    const double a = in["a"], r0 = in["r0"], phi0 = in["phi0"];
    const Vec3<double> lamp = {{r0 * std::cos(phi0), r0 * std::sin(phi0), in["z0"]}};
    double last = 10 * a;
    for (const json& image : c["expected"]["images"])
      last = std::max(last, 1.05 * image["affine_length"].get<double>());
    expect_images(c, connect(Goedel{a}, {{0, 0, 0, 0}}, lamp, 64, last));
  }
  for (const json& c : cases_of("godel_two_point_general")) {
    const json& in = c["inputs"];
    const Vec3<double> x = to_vec3(in["observer_xyz"]);
    double last = 0;
    for (const json& image : c["expected"]["images"])
      last = std::max(last, 1.05 * image["affine_length"].get<double>());
    expect_images(c, connect(Goedel{in["a"]}, {{0, x[0], x[1], x[2]}}, to_vec3(in["source_xyz"]), 64, last));
  }
}

/// Light between two places of Schwarzschild's spacetime by the orbit equation u'' + u = 3u^2, u = 1/r: from
/// r1 to r2 over the azimuth `angle`.
struct Orbit {
  double psi;  ///< at r1, from the way outwards
  double det;  ///< |det D| with its vertex there

  Orbit(double r1, double r2, double angle) {
    const double f1 = 1 - 2 / r1, f2 = 1 - 2 / r2, u2 = 1 / r2;
    double low = 1e-9, high = kPi - 1e-9;  // psi; u grows with it
    for (int i = 0; i < 60; ++i) {
      psi = 0.5 * (low + high);
      (at(r1, angle)[0] > u2 ? high : low) = psi;
    }
    const double sine2 = std::sin(psi) * r1 / std::sqrt(f1) * std::sqrt(f2) / r2;
    const double in_plane = std::fabs(at(r1, angle)[2]) / (u2 * u2) / std::sqrt(f2) * sine2;
    det = in_plane * r2 * std::fabs(std::sin(angle)) / std::sin(psi);
  }
  /// u, du/dphi, and the derivatives of both along psi.
  std::array<double, 4> at(double r1, double angle) const {
    constexpr int kSteps = 4000;
    const double speed = std::sqrt(1 - 2 / r1) / r1, h = angle / kSteps;
    Vec4<double> y = {{1 / r1, -speed / std::tan(psi), 0, speed / std::pow(std::sin(psi), 2)}};
    const auto rate = [](const Vec4<double>& v) {
      return Vec4<double>{{v[1], (3 * v[0] - 1) * v[0], v[3], (6 * v[0] - 1) * v[2]}};
    };
    for (int i = 0; i < kSteps; ++i) {
      if (y[0] > 0.5) return {1, 0, 0, 0};  // captured
      if (y[0] < 0) return {-1, 0, 0, 0};   // escaped
      const Vec4<double> a = rate(y), b = rate(y + 0.5 * h * a), c = rate(y + 0.5 * h * b),
                         d = rate(y + h * c);
      y = y + h / 6 * (a + 2.0 * b + 2.0 * c + d);
    }
    return y.c;
  }
};

TEST(Shooting, SchwarzschildAsByTheOrbitEquation) {
  const KerrSchild hole;
  const Vec4<double> lamp = {{0, 8, 0, 0}};
  const Ball target{{{0, 0, 0}}, 12};
  const LampScan<KerrSchild> scan(hole, kSharp, lamp, 2, 1e6, &target, 1);
  Random random(2);
  for (int i = 0; i < (kSanitized ? 2 : 40); ++i) {
    const double r = random.uniform(2.5, 12), angle = random.uniform(0.1, kPi - 0.1);
    const double turn = random.uniform(0, 2 * kPi);
    const Vec3<double> out = {
        {std::cos(angle), std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn)}};
    const Vec3<double> along = {
        {-std::sin(angle), std::cos(angle) * std::cos(turn), std::cos(angle) * std::sin(turn)}};
    const Vec4<double> event = {{1, r * out[0], r * out[1], r * out[2]}};
    const Found found = connect(scan, event);
    EXPECT_TRUE(found.complete) << i;
    EXPECT_EQ(found.connections.size(), 4u) << i << " r " << r << " angle " << angle;
    const Tetrad<double> tetrad = static_tetrad(hole, event);
    const Matrix4<double> g = hole.g(event);
    for (int n = 0; n < 4; ++n) {
      // Light comes round the hole on either side, in the plane of lamp and event.
      const double sweep = (n % 2 == 0 ? angle : 2 * kPi - angle) + 2 * kPi * (n / 2);
      const Orbit orbit(r, 8, sweep);
      double nearest = 1e9, det = 0;
      for (const Connection<double>& c : found.connections) {
        const Vec4<double> k =
            tetrad.to_chart(c.past);  // against unit vectors outwards and along the azimuth
        const Vec4<double> radial = {{0, out[0], out[1], out[2]}},
                           azimuth = {{0, along[0], along[1], along[2]}};
        const double around = -inner(g, k, azimuth) * (n % 2 == 0 ? -1 : 1);
        const double off = std::fabs(std::sin(orbit.psi) - around);
        const Vec4<double> time_like = {{1, 0, 0, 0}};
        const Vec4<double> r_static =
            radial + (-inner(g, radial, time_like) / inner(g, time_like, time_like)) * time_like;
        const double outwards = -inner(g, k, r_static) / std::sqrt(-inner(g, r_static, r_static));
        const double miss = std::hypot(off, outwards - std::cos(orbit.psi));
        if (miss < nearest) nearest = miss, det = c.det;
      }
      EXPECT_LT(nearest, 1e-9) << i << " " << n << " r " << r << " angle " << angle;
      EXPECT_NEAR(std::fabs(det) / orbit.det, 1, 1e-6) << i << " " << n;
      EXPECT_EQ(det < 0, n % 2 == 1);
    }
  }
}

TEST(Shooting, EventsSideBySideAreAsOneByOne) {
  const KerrSchild hole{1, 0.5, 0};
  const Ball target{{{-4, 3, 0}}, 1};
  const LampScan<KerrSchild> scan(hole, kBalanced, {{0, 7, 2, 1}}, 1, 1e6, &target, 1);
  constexpr std::size_t kEvents = 9, kRoom = 4;
  std::array<Vec4<double>, kEvents> events;
  Random random(6);
  for (Vec4<double>& event : events) {
    const Vec3<double> X = target.centre + random.uniform(0, 1) * random.direction();
    event = {{0, X[0], X[1], X[2]}};
  }
  std::array<Connection<double>, kEvents * kRoom> out{};
  std::array<int, kEvents * kRoom> winding{};
  std::array<std::size_t, kEvents> counts{};
  std::array<bool, kEvents> complete{};
  scan.connect(events.data(), kEvents, {out.data(), winding.data(), kRoom, counts.data(), complete.data()});
  for (std::size_t i = 0; i < kEvents; ++i) {
    const Found found = connect(scan, events[i]);
    EXPECT_TRUE(complete[i]);
    ASSERT_EQ(counts[i], found.connections.size());
    EXPECT_EQ(counts[i], 2u);
    for (std::size_t n = 0; n < counts[i]; ++n) {
      EXPECT_EQ(out[i * kRoom + n].lambda, found.connections[n].lambda);
      EXPECT_EQ(out[i * kRoom + n].det, found.connections[n].det);
      EXPECT_EQ(out[i * kRoom + n].past.c, found.connections[n].past.c);
    }
  }
  // Without room the nearest stay, and it is said.
  Connection<double> one;
  int turns = 0;
  bool all = true;
  EXPECT_EQ(scan.connect(events[0], &one, &turns, 1, all), 1u);
  EXPECT_FALSE(all);
  EXPECT_EQ(one.lambda, out[0].lambda);
}

TEST(Shooting, ReportsOfOneEvent) {
  const Vec4<double> event = {{2, 1, 2, 2}};
  const auto flat = shoot_connections(Minkowski{}, kSharp, event, {{1, 5, -1}}, 1);
  ASSERT_EQ(flat.connections.size(), 1u);
  EXPECT_TRUE(flat.complete);
  EXPECT_NEAR(flat.connections[0].travel_time, std::sqrt(18), 1e-11);
  EXPECT_NEAR(flat.connections[0].area_distance, std::sqrt(18), 1e-7);
  EXPECT_NEAR(flat.connections[0].view[2], -1 / std::sqrt(2), 1e-11);
  EXPECT_EQ(flat.connections[0].parity, 1);
  const auto bent = shoot_connections(KerrSchild{}, kBalanced, {{0, 5, 1, 0}}, {{-7, 1, 0.5}}, 2);
  ASSERT_EQ(bent.connections.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(bent.connections[i].winding, i / 2);
    EXPECT_EQ(bent.connections[i].parity, i % 2 == 0 ? 1 : -1);
  }
  // In the hole no lamp can be at rest.
  const auto none = shoot_connections(KerrSchild{}, kBalanced, {{0, 5, 1, 0}}, {{1, 0.5, 0}}, 1);
  EXPECT_TRUE(none.connections.empty());
  EXPECT_FALSE(none.complete);
}

}  // namespace
}  // namespace nullcone::test
