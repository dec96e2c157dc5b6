// Whether the light cone of a lamp at rest is whole: no light is lost, and every connection is a geodesic.
#include <gtest/gtest.h>

#include "metrics/ellis_wormhole.h"
#include "metrics/kerr_schild.h"
#include "tests/connected.h"
#include "tests/followed.h"
#include "tests/random_rays.h"
#include "tests/sanitized.h"

namespace nullcone::test {
namespace {

/// The static observer's unit vector away from the hole.
template <class M>
Vec4<double> outwards(const M& metric, const Vec4<double>& event) {
  const Matrix4<double> g = metric.g(event);
  const Vec4<double> rest = {{1, 0, 0, 0}};
  Vec4<double> out = {{0, event[1], event[2], event[3]}};
  out = out - inner(g, out, rest) / inner(g, rest, rest) * rest;
  return 1 / std::sqrt(-inner(g, out, out)) * out;
}

/// E g^2 summed over all light that reaches a point of a surface at right angles to `outwards`.
template <class M>
double flux(const LampScan<M>& scan, const M& metric, const Vec4<double>& lamp, const Vec4<double>& event) {
  const Matrix4<double> g = metric.g(event);
  const Vec4<double> normal = outwards(metric, event);
  const double ratio2 = metric.g(lamp)[0][0] / g[0][0];
  const Found found = connect(scan, event);
  EXPECT_TRUE(found.complete);
  double out = 0;
  for (const Connection<double>& c : found.connections) {
    const double cosine = inner(g, static_tetrad(metric, event).to_chart(c.past), normal);
    out += cosine / std::fabs(c.det) * ratio2;
  }
  return out;
}

/// The same through the element of the sphere about the origin that has the area 1 in the chart.
template <class M>
double flux_through_sphere(const LampScan<M>& scan, const M& metric, const Vec4<double>& lamp,
                           const Vec4<double>& event) {
  const Matrix4<double> g = metric.g(event);
  const Vec4<double> rest = {{1, 0, 0, 0}};
  const auto beside = beside_direction(normalised(spatial(event)));
  std::array<Vec4<double>, 2> side;
  for (std::size_t i = 0; i < 2; ++i) side[i] = {{0, beside[i][0], beside[i][1], beside[i][2]}};
  const Tetrad<double> tetrad = static_tetrad(metric, event);
  double out = 0;
  const Found found = connect(scan, event);
  for (const Connection<double>& c : found.connections) {
    // cos(alpha) dA: the volume that the photon's direction and the element's sides span for the observer.
    const auto local = [&](const Vec4<double>& v) {
      return Vec3<double>::map([&](std::size_t i) { return -inner(g, v, tetrad.e[i + 1]); });
    };
    const double element = determinant(-spatial(c.past), local(side[0]), local(side[1]));
    out += element / std::fabs(c.det) * metric.g(lamp)[0][0] / inner(g, rest, rest);
  }
  return out;
}

TEST(LightCone, LightOfALampByAHoleIsNeitherLostNorMade) {
  // Through a sphere about lamp and hole goes what the hole does not catch: all but the cone of half angle
  // psi, sin psi = 3 sqrt3 sqrt(1 - 2/r)/r.
  const KerrSchild hole;
  const double R = 12;
  for (const double r : {6.0, 10.0}) {
    if (kSanitized && r > 6) continue;
    const Vec4<double> lamp = {{0, 0, r, 0}};
    const Ball target{{{0, 0, 0}}, R};
    const LampScan<KerrSchild> scan(hole, kBalanced, lamp, 2, 1e6, &target, 1);
    constexpr int kPoints = 64;
    double sum = 0;
    for (int i = 0; i < kPoints; ++i) {  // evenly in t with theta = pi (3 t^2 - 2 t^3): no ends to care for
      const double t = (i + 0.5) / kPoints, theta = kPi * t * t * (3 - 2 * t);
      const Vec4<double> event = {
          {0, R * std::sin(theta) * 0.6, R * std::cos(theta), R * std::sin(theta) * 0.8}};
      const double area = 2 * kPi * R * R * std::sin(theta) * kPi * 6 * t * (1 - t) / kPoints;
      sum += flux(scan, hole, lamp, event) * area;
    }
    const double psi = std::asin(3 * std::sqrt(3.0) * std::sqrt(1 - 2 / r) / r);
    EXPECT_NEAR(sum / (2 * kPi * (1 + std::cos(psi))), 1, 1e-3) << r;
  }
}

/// The past-directed ray of a connection, and the Jacobi determinant by its neighbours, from the event.
/// Errors of direction grow with the distance to the neighbours.
template <class M>
void expect_geodesic(const M& metric, const Vec4<double>& event, const Vec4<double>& lamp,
                     const Connection<double>& c) {
  const Tetrad<double> tetrad = static_tetrad(metric, event);
  const auto at = [&](const Vec3<double>& n) {
    return follow(metric, event, tetrad.to_chart({{-1, n[0], n[1], n[2]}}), kSharp, c.lambda);
  };
  const Vec3<double> n = spatial(c.past);
  const double h = 1e-6;
  const auto beside = beside_direction(n);
  std::array<Vec4<double>, 2> J;
  for (std::size_t i = 0; i < 2; ++i)
    J[i] = 0.5 / h * (at(normalised(n + h * beside[i])).at.x - at(normalised(n - h * beside[i])).at.x);
  const Matrix4<double> g = metric.g(lamp);
  const double aa = inner(g, J[0], J[0]), ab = inner(g, J[0], J[1]), bb = inner(g, J[1], J[1]);
  EXPECT_NEAR(c.det * c.det / (aa * bb - ab * ab), 1, 1e-4);
  const Followed end = at(n);
  const double precision = 1e-11 * (1 + norm(J[0]) + norm(J[1]));
  EXPECT_LT(norm(spatial(end.at.x - lamp)), precision);
  EXPECT_NEAR(end.at.x[0], c.emitted[0], precision);
  EXPECT_LT(norm(end.rate.x - c.tangent), 10 * precision);
}

TEST(LightCone, KerrFindsGeodesicsThatEndAtTheLampAndAllOfThem) {
  const KerrSchild hole{1, 0.9, 0};
  const Vec4<double> lamp = {{0, 6, 1, 2}};
  const double R = 10;
  const Ball target{{{0, 0, 0}}, R + 0.1};
  const LampScan<KerrSchild> scan(hole, kSharp, lamp, 1, 1e6, &target, 1);
  Random random(3);
  for (int i = 0; i < 6; ++i) {
    const Vec3<double> X = random.uniform(3, 9) * random.direction();
    const Vec4<double> event = {{0.5, X[0], X[1], X[2]}};
    const Found found = connect(scan, event);
    EXPECT_TRUE(found.complete);
    EXPECT_GE(found.connections.size(), 2u);
    for (const Connection<double>& c : found.connections) expect_geodesic(hole, event, lamp, c);
  }
  // Light that goes round at most once: of all directions at the lamp, those that reach the sphere.
  const Tetrad<double> tetrad = static_tetrad(hole, lamp);
  constexpr int kRays = 4000, kPoints = 600;
  int out = 0;
  for (int i = 0; i < kRays; ++i) {
    const Vec3<double> n = golden_point(i, kRays);
    out += follow(hole, lamp, tetrad.to_chart({{1, n[0], n[1], n[2]}}), kBalanced).end ==
           as_scalar<double>(Ending::sky);
  }
  const LampScan<KerrSchild> once(hole, kBalanced, lamp, 1, 1e6, &target, 1);
  double sum = 0;
  for (int i = 0; i < kPoints; ++i) {
    const Vec3<double> X = R * golden_point(i, kPoints);
    const Vec4<double> event = {{0, X[0], X[1], X[2]}};
    // The area of the coordinate sphere's element, at right angles to its true normal: by its tangents.
    sum += flux_through_sphere(once, hole, lamp, event) * 4 * kPi * R * R / kPoints;
  }
  EXPECT_NEAR(sum / (4 * kPi) * kRays / out, 1, 0.02);
}

TEST(LightCone, LightThroughAWormhole) {
  const EllisWormhole hole;
  const Vec4<double> lamp = {{0, 2, 0, 0}};
  const Ball target{{{0.06, 0, 0}}, 0.16};
  const LampScan<EllisWormhole> scan(hole, kSharp, lamp, 1, 1e6, &target, 1);
  // Straight through: l runs from -b^2/4rho + rho to that of the lamp, and J'' = b^2/(b^2 + l^2)^2 J.
  const Vec4<double> behind = {{3, 0.1, 0, 0}};
  const auto l = [](double rho) { return rho - 0.25 / rho; };
  const double length = l(2) - l(0.1), h = length / 20000;
  Vec<double, 2> J = {{0, 1}};
  for (int i = 0; i < 20000; ++i) {  // leapfrog
    const auto curved = [&](double at) { return 1 / std::pow(1 + at * at, 2); };
    J[0] += 0.5 * h * J[1];
    J[1] += h * curved(l(0.1) + (i + 0.5) * h) * J[0];
    J[0] += 0.5 * h * J[1];
  }
  const Found straight = connect(scan, behind);
  ASSERT_GE(straight.connections.size(), 1u);
  EXPECT_NEAR(straight.connections[0].lambda, length, 1e-10);
  EXPECT_NEAR(straight.connections[0].det / (J[0] * J[0]), 1, 1e-6);
  EXPECT_NEAR(straight.connections[0].past[1], 1, 1e-12);
  Random random(4);
  for (int i = 0; i < 20; ++i) {  // round either side of the throat
    const double rho = random.uniform(0.05, 0.2), angle = random.uniform(0.2, 0.6);
    const Vec4<double> event = {
        {0, rho * std::cos(angle), 0.6 * rho * std::sin(angle), 0.8 * rho * std::sin(angle)}};
    const Found found = connect(scan, event);
    EXPECT_TRUE(found.complete);
    EXPECT_EQ(found.connections.size(), 2u) << rho << " " << angle;
    for (const Connection<double>& c : found.connections) expect_geodesic(hole, event, lamp, c);
  }
}

}  // namespace
}  // namespace nullcone::test
