// Rays against meshes: no triangle is missed, none is invented, no ray slips through where triangles meet,
// and each crossing is where long double finds it. Straight rays and curved ones.
#include <gtest/gtest.h>

#include "core/trace/closed_onward.h"
#include "core/trace/details.h"
#include "metrics/minkowski_kernel.h"
#include "tests/mesh_oracle.h"
#include "tests/mesh_shapes.h"
#include "tests/sanitized.h"

namespace nullcone::test {
namespace {

using namespace nullcone::host;

constexpr int kRays = kSanitized ? 300 : 6'000;

double round_as(const Vec3<double>&) { return 1; }
double bumpy(const Vec3<double>& d) { return 1 + 0.2 * std::sin(5 * d[0]) * std::sin(4 * d[1] + 1); }

struct Tally {
  int rays = 0, hits = 0, missed = 0, invented = 0, misplaced = 0, given_up = 0, turned = 0, doubled = 0;
  double worst = 0;  ///< over the rounding that is allowed
  double steps = 0;

  void expect_clean(int least_hits) const {
    EXPECT_EQ(missed, 0);
    EXPECT_EQ(invented, 0);
    EXPECT_EQ(misplaced, 0);
    EXPECT_EQ(given_up, 0);
    EXPECT_EQ(turned, 0);
    EXPECT_EQ(doubled, 0);
    EXPECT_LT(worst, 0.5);
    EXPECT_GT(hits, least_hits);
  }
};

/// All crossings of a ray, as closed_onward.h finds them.
template <class Ray>
std::vector<double> all_crossings(const Ray& ray, const AnyShape& shape, double limit, double resolution,
                                  Tally& tally) {
  std::vector<double> out;
  double lambda = 0;
  for (int i = 0; i < 2000; ++i) {
    Search<double> search(limit);
    search.lambda = lambda;
    advance(ray, Onward<double, AnyShape>{shape, false}, limit, resolution, kSearchLimit, search);
    tally.given_up += search.given_up;
    tally.steps += search.steps;
    if (!search.met) return out;
    out.push_back(search.lambda);
    lambda = past_crossing(ray, shape, search, resolution);
  }
  ++tally.given_up;
  return out;
}

/// A mesh, and how its surface counts: `rounding` is a length, what may be called either way.
struct Subject {
  const TriangleSoup& soup;
  const AnyShape& shape;
  double rounding;
  bool closed;
};

/// What a ray has to meet: where all triangles about the place are crossed in the same direction, and the
/// place is within one of them, or the mesh has no edges. Returns the least of their steepnesses there, else
/// 0.
L clear_steepness(const std::vector<TrueCrossing>& all, const TrueCrossing& c, const Subject& subject) {
  const L steep = std::fabs(c.steepness), clear = 30 * subject.rounding;
  L least = steep;
  bool within = false;
  for (const TrueCrossing& other : all) {
    const L apart = std::fabs(other.t - c.t) * std::max(steep, std::fabs(other.steepness));
    if (apart > clear) continue;
    if (other.triangle != c.triangle && !subject.closed) return 0;
    if ((other.steepness > 0) != (c.steepness > 0)) return 0;
    if (std::fabs(other.steepness) < 1e-4L * other.speed) return 0;
    least = std::min(least, std::fabs(other.steepness));
    within |= other.inside > clear;
  }
  return subject.closed || within ? least : 0;
}

template <class Ray, class Curve>
void compare(const Subject& subject, const Curve& curve, const Ray& ray, double limit, double resolution,
             Tally& tally) {
  ++tally.rays;
  const std::vector<double> found = all_crossings(ray, subject.shape, limit, resolution, tally);
  const auto all = true_crossings(subject.soup, curve, limit, 3 * L(subject.rounding));
  std::size_t clear = 0;
  double first = kFar;
  for (const TrueCrossing& c : all) {
    const L steepness = clear_steepness(all, c, subject);
    if (steepness == 0 || c.t > 0.999L * limit || c.inside < -0.01L * subject.rounding) continue;
    ++clear;
    first = std::min(first, static_cast<double>(c.t));
    const L apart = 25 * subject.rounding / (c.inside > 25 * subject.rounding ? steepness : c.speed);
    const bool alone = std::ranges::none_of(all, [&](const TrueCrossing& other) {
      return std::fabs(other.t - c.t) < 2 * apart && (other.steepness > 0) != (c.steepness > 0);
    });
    double off = 1e300, at = 0;
    int times = 0;
    for (const double lambda : found) {
      const auto d = static_cast<double>(std::fabs((lambda - c.t) * steepness));
      times += std::fabs(lambda - c.t) < apart;
      if (d < off) off = d, at = lambda;
    }
    tally.doubled += alone && times > 1;
    tally.missed += off > 1e3 * subject.rounding;
    tally.misplaced += off > subject.rounding;
    tally.worst = std::max(tally.worst, off / subject.rounding);
    if (c.inside < 30 * subject.rounding) continue;
    const Vec3<double> X =
        Vec3<double>::map([&](std::size_t i) { return static_cast<double>(curve.at(at)[i]); });
    const auto facet = subject.shape.facet(X);
    tally.turned +=
        !(dot(facet.normal(X),
              Vec3<double>::map([&](std::size_t i) { return static_cast<double>(c.normal[i]); })) > 0.99) ||
        !(std::fabs(facet.value(X)) < subject.rounding);
  }
  tally.hits += clear > 0;
  for (const double lambda : found)
    tally.invented += std::ranges::none_of(all, [&](const TrueCrossing& c) {
      return std::fabs((lambda - c.t) * c.steepness) < 2 * subject.rounding ||
             std::fabs(lambda - c.t) < 2 * subject.rounding;
    });
  const Search<double> search = first_crossing(ray, subject.shape, limit, resolution);
  tally.missed += first < kFar && !(search.met && search.lambda < first + 1e-6);
}

RestPlacing<Minkowski> at_origin(double ball) {
  return {{}, {{0, 0, 0, 0}}, true, {Vec3<double>{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}, 1.001 * ball};
}

/// One straight ray towards `aim`, from `from`.
void straight(const Subject& subject, const Vec3<double>& from, const Vec3<double>& aim, Tally& tally) {
  const Vec3<double> n = normalised(aim - from);
  const auto placing = at_origin(subject.shape.bounding_radius());
  const auto ray = placing.ray(placing.launch(Vec4<double>{{0, from[0], from[1], from[2]}}),
                               Vec4<double>{{-1, n[0], n[1], n[2]}});
  const double limit = 50 * std::max(1.0, subject.shape.bounding_radius());
  compare(subject, Parabola{convert<L>(from), convert<L>(n), {}}, ray, limit, 4e-15 * norm(from), tally);
}

/// Rays from outside and from inside towards the mesh.
Tally straight_rays(unsigned seed, const TriangleSoup& soup, bool closed, int count, double blunt = 1) {
  Random random(seed);
  const Mesh mesh = make_mesh(soup);
  EXPECT_EQ(mesh.closed, closed);
  const AnyShape shape(MeshShape{view_of(mesh)});
  Tally tally;
  while (tally.rays < count) {
    const bool inside = tally.rays % 4 == 0;
    const Vec3<double> aim = mesh.ball * random.uniform(0, 1) * random.direction();
    const Vec3<double> from =
        inside ? 0.7 * mesh.ball * random.uniform(0, 1) * random.direction()
               : std::max(1.0, 2 * mesh.ball) * random.uniform(1.1, 20) * random.direction();
    const double rounding = blunt * (1e-14 * norm(from) + 1e-13 * mesh.ball);
    straight({soup, shape, rounding, closed}, from, aim, tally);
  }
  return tally;
}

TEST(Mesh, ClosedMeshesAreMetFromEverywhere) {
  for (const double size : {1.0, 1e-9, 3e7}) {
    SCOPED_TRACE(size);
    // The smallest is known to a ten thousandth of its size.
    TriangleSoup soup = sphere_soup(size < 1 ? 4 : 16, false, bumpy);
    ASSERT_EQ(soup.triangles.size(), size < 1 ? 320U : 5120U);
    move_and_scale(soup, {{0.1, -0.2, 0.3}}, size);
    straight_rays(1, soup, true, kRays).expect_clean(kRays / 2);
  }
}

TEST(Mesh, SoupsAndSlivers) {
  Random random(2);
  for (int n = 0; n < 6; ++n) {
    straight_rays(3, random_soup(random, 600, 1e-3), false, kRays / 6).expect_clean(kRays / 20);
    // The plane of a sliver is known to rounding times length over height.
    straight_rays(4, random_soup(random, 600, 0.1, 1e-3), false, kRays / 6, 1e3).expect_clean(kRays / 20);
  }
}

TEST(Mesh, RaysThatGrazeTriangles) {
  Random random(8);
  const TriangleSoup soup = random_soup(random, 400, 0.1);
  const Mesh mesh = make_mesh(soup);
  const AnyShape shape(MeshShape{view_of(mesh)});
  Tally tally;
  for (int n = 0; n < kRays; ++n) {
    const auto& t = soup.triangles[static_cast<std::size_t>(n) % soup.triangles.size()];
    const Vec3<double> a{soup.positions[t[0]]}, b{soup.positions[t[1]]}, c{soup.positions[t[2]]};
    const Vec3<double> aim = a + 0.3 * (b - a) + 0.3 * (c - a), normal = normalised(cross(b - a, c - a));
    const Vec3<double> along = normalised(cross(normal, random.direction()));
    const double angle = random.logarithmic(2e-4, 0.1), far = random.uniform(3, 20);
    straight({soup, shape, 1e-14 * far, false}, aim - far * (along + angle * normal), aim, tally);
  }
  tally.expect_clean(kRays / 2);
}

TEST(Mesh, NoRaySlipsThroughVerticesAndEdges) {
  const TriangleSoup soup = sphere_soup(8, false, bumpy);
  const Mesh mesh = make_mesh(soup);
  const AnyShape shape(MeshShape{view_of(mesh)});
  Random random(5);
  Tally tally;
  for (int n = 0; n < kRays; ++n) {
    const auto& t = soup.triangles[static_cast<std::size_t>(random.uniform(0, 0.999999) *
                                                            static_cast<double>(soup.triangles.size()))];
    const Vec3<double> a{soup.positions[t[0]]}, b{soup.positions[t[1]]};
    const double part = n % 2 == 0 ? 0 : n % 4 == 1 ? 0.5 : random.uniform(0, 1);
    const Vec3<double> from = (n % 3 == 0 ? 0.2 : 3.0) * random.direction();
    straight({soup, shape, 1e-13 * (1 + norm(from)), true}, from, a + part * (b - a), tally);
  }
  tally.expect_clean(kRays / 2);
}

TEST(Mesh, RaysAlongTheAxesThroughACube) {
  // Exactly through vertices, along edges and diagonals, and within faces.
  TriangleSoup soup;
  for (unsigned i = 0; i < 8; ++i)
    soup.positions.push_back({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0});
  for (const auto& q : {std::array<unsigned, 4>{0, 2, 3, 1},
                        {4, 5, 7, 6},
                        {0, 1, 5, 4},
                        {2, 6, 7, 3},
                        {0, 4, 6, 2},
                        {1, 3, 7, 5}}) {
    soup.triangles.push_back({q[0], q[1], q[2]});
    soup.triangles.push_back({q[0], q[2], q[3]});
  }
  const Mesh mesh = make_mesh(soup);
  ASSERT_TRUE(mesh.closed);
  const AnyShape shape(MeshShape{view_of(mesh)});
  Tally tally;
  for (double x = -1.5; x <= 1.5; x += 0.25)
    for (double y = -1.5; y <= 1.5; y += 0.25) {
      straight({soup, shape, 1e-13, true}, {{x, y, -5}}, {{x, y, 5}}, tally);
      straight({soup, shape, 1e-13, true}, {{-4 + x, -4 + y, -4}}, {{4 + x, 4 + y, 4}}, tally);
      // From within the square of a face on, through it and no other.
      Tally own;
      const auto placing = at_origin(mesh.ball);
      const auto ray = placing.ray(placing.launch(Vec4<double>{{0, x, y, -5}}), Vec4<double>{{-1, 0, 0, 1}});
      const auto found = all_crossings(ray, shape, 100, 2e-14, own);
      if (std::max(std::fabs(x), std::fabs(y)) < 1) {
        EXPECT_EQ(found.size(), 2U) << x << " " << y;
      }
      if (std::max(std::fabs(x), std::fabs(y)) > 1) {
        EXPECT_EQ(found.size(), 0U) << x << " " << y;
      }
      EXPECT_EQ(own.given_up, 0);
    }
  tally.expect_clean(40);
}

TEST(Mesh, HoldsWhatItsSurfaceWindsAround) {
  TriangleSoup soup = sphere_soup(6, false, bumpy);
  // A second sphere that overlaps the first: inside of both is inside still.
  TriangleSoup other = sphere_soup(5, false, round_as);
  move_and_scale(other, {{0.8, 0.1, 0}}, 1);
  const auto first = static_cast<std::uint32_t>(soup.positions.size());
  soup.positions.insert(soup.positions.end(), other.positions.begin(), other.positions.end());
  for (auto t : other.triangles) soup.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  const Mesh mesh = make_mesh(soup);
  ASSERT_TRUE(mesh.closed);
  const MeshShape shape{view_of(mesh)};
  Random random(6);
  int inside = 0;
  for (int n = 0; n < kRays; ++n) {
    Vec3<double> X = 1.9 * random.uniform(0, 1) * random.direction();
    if (n % 5 == 0) X[n % 3] = 0;
    // The solid angle of the surface as seen from X (van Oosterom and Strackee 1983).
    L angle = 0;
    for (const auto& t : soup.triangles) {
      Point p[3];
      for (std::size_t k = 0; k < 3; ++k) p[k] = convert<L>(soup.positions[t[k]]) - convert<L>(X);
      const L a = norm(p[0]), b = norm(p[1]), c = norm(p[2]);
      angle += 2 * std::atan2(dot(p[0], cross(p[1], p[2])),
                              a * b * c + dot(p[0], p[1]) * c + dot(p[1], p[2]) * a + dot(p[2], p[0]) * b);
    }
    const bool expected = std::fabs(angle) > 2 * std::numbers::pi_v<L>;
    inside += expected;
    ASSERT_EQ(shape.holds(X), expected) << n;
    ASSERT_EQ(shape.hides(X), expected) << n;
  }
  EXPECT_GT(inside, kRays / 10);
}

/// A curve as the search sees it: bounds that hold for a while.
struct ParabolaRay {
  Vec3<double> X, W, A;
  double valid;

  Sight<double> at(double t) const {
    Sight<double> out;
    out.X = X + t * (W + (0.5 * t) * A), out.slope = W + t * A;
    out.valid = valid, out.bend_max = norm(A);
    const double speed = norm(out.slope), change = out.bend_max * valid;
    out.slope_min = std::max(speed - change, 0.0), out.slope_max = speed + change;
    return out;
  }
};
struct CircleRay {
  Circle circle;
  double radius;

  Sight<double> at(double t) const {
    Sight<double> out;
    const Point X = circle.at(t), slope = circle.slope(t);
    for (std::size_t i = 0; i < 3; ++i)
      out.X[i] = static_cast<double>(X[i]), out.slope[i] = static_cast<double>(slope[i]);
    out.valid = kFar, out.bend_max = out.slope_min = out.slope_max = radius;
    return out;
  }
};

TEST(Mesh, CurvedRays) {
  for (const bool closed : {true, false}) {
    Random random(7);
    TriangleSoup soup = closed ? sphere_soup(8, false, bumpy) : random_soup(random, 600, 1e-2);
    const double size = closed ? 1 : 1e-6;
    move_and_scale(soup, {}, size);
    const Mesh mesh = make_mesh(soup);
    const AnyShape shape(MeshShape{view_of(mesh)});
    Tally parabolas, circles;
    for (int n = 0; n < kRays; ++n) {
      const Subject subject{soup, shape, 4e-12 * size, closed};
      const Vec3<double> aim = size * random.uniform(0, 1.2) * random.direction();
      const Vec3<double> X = size * random.logarithmic(0.2, 20) * random.direction();
      const Vec3<double> A = size * random.logarithmic(1e-8, 10) * random.direction();
      const Vec3<double> W = aim - X - 0.5 * A;  // at the aim at t = 1
      const ParabolaRay parabola{X, W, A, random.logarithmic(0.03, 10)};
      compare(subject, Parabola{convert<L>(X), convert<L>(W), convert<L>(A)}, parabola, 4, 1e-15, parabolas);
      const Vec3<double> u = random.direction(), v = normalised(cross(u, random.direction()));
      const double radius = size * random.logarithmic(0.05, 20);
      const Vec3<double> centre = aim - radius * u;
      const Circle circle{convert<L>(centre), convert<L>(radius * v), convert<L>(-radius * u)};
      compare(subject, circle, CircleRay{circle, radius}, 6, 1e-15, circles);
    }
    parabolas.expect_clean(kRays / 3);
    circles.expect_clean(kRays / 3);
    EXPECT_LT(parabolas.steps / parabolas.rays, 60);
    EXPECT_LT(circles.steps / circles.rays, 60);
  }
}

/// What is recorded of the first crossing of a ray with a mesh.
struct WhatIsRecorded {
  Crossed<double> crossed;
  Detailed<double> details;
};
WhatIsRecorded record(const AnyShape& shape, const Vec3<double>& from, const Vec3<double>& n) {
  const auto placing = at_origin(shape.bounding_radius());
  const RestBody body{placing.axes};
  const auto path = placing.path(placing.launch(Vec4<double>{{0, from[0], from[1], from[2]}}),
                                 Vec4<double>{{-1, n[0], n[1], n[2]}});
  const auto ray = placing.ray(placing.launch(Vec4<double>{{0, from[0], from[1], from[2]}}),
                               Vec4<double>{{-1, n[0], n[1], n[2]}});
  const Search<double> search = first_crossing(ray, shape, 100.0, 4e-15 * norm(from));
  EXPECT_TRUE(search.met);
  WhatIsRecorded out{record_crossing(Minkowski{}, path, body, shape, search.lambda,
                                     [](const Vec4<double>& event) { return event; }),
                     {}};
  find_directions(out.crossed, body, shape, out.details);
  return out;
}

TEST(MeshRecord, AMeshSphereConvergesAtSecondOrder) {
  std::vector<double> depth_error, mu_error, flat_error;
  for (const int n : {6, 12, 24, 48}) {
    TriangleSoup soup = sphere_soup(n, true, round_as), flat_soup = soup;
    flat_soup.normals.clear();
    const Mesh mesh = make_mesh(std::move(soup)), flat = make_mesh(std::move(flat_soup));
    Random random(9);
    double depth = 0, mu = 0, of_flat = 0;
    for (int i = 0; i < kRays / 3; ++i) {
      const Vec3<double> from = 5.0 * random.direction(), side = cross(random.direction(), normalised(from));
      const double part = random.uniform(0, 0.9) / norm(side);
      const Vec3<double> along = normalised(part * side - from);
      const double near = -dot(from, along), half = std::sqrt(1 - (25 - near * near));
      const WhatIsRecorded smooth = record(AnyShape(MeshShape{view_of(mesh)}), from, along);
      depth = std::max(depth, std::fabs(smooth.crossed.record.Z - (near - half)));
      mu = std::max(mu, std::fabs(smooth.crossed.record.mu - half));
      of_flat = std::max(
          of_flat,
          std::fabs(record(AnyShape(MeshShape{view_of(flat)}), from, along).crossed.record.mu - half));
    }
    depth_error.push_back(depth), mu_error.push_back(mu), flat_error.push_back(of_flat);
  }
  for (std::size_t i = 1; i < depth_error.size(); ++i) {
    EXPECT_NEAR(depth_error[i - 1] / depth_error[i], 4, 0.8);
    EXPECT_NEAR(mu_error[i - 1] / mu_error[i], 4, 0.8);
    EXPECT_NEAR(flat_error[i - 1] / flat_error[i], 2, 0.5) << "normals of the planes are of first order";
  }
}

TEST(MeshRecord, NormalsFaceTheRayAndAgreeWithMu) {
  // A coarse sphere with the normals of a fine one: near its rim rays look on the backs of normals.
  TriangleSoup soup = sphere_soup(2, true, round_as);
  const Mesh mesh = make_mesh(soup);
  const AnyShape smooth(MeshShape{view_of(mesh)});
  Mesh without = mesh;
  without.normals.clear();
  const AnyShape flat(MeshShape{view_of(without)});
  Random random(10);
  int leant = 0;
  for (int i = 0; i < kRays; ++i) {
    const bool inside = i % 3 == 0;
    const Vec3<double> from = (inside ? 0.5 : 5.0) * random.direction();
    const Vec3<double> along = normalised(0.99 * random.uniform(0.9, 1) * random.direction() - from);
    const auto placing = at_origin(mesh.ball);
    const auto ray = placing.ray(placing.launch(Vec4<double>{{0, from[0], from[1], from[2]}}),
                                 Vec4<double>{{-1, along[0], along[1], along[2]}});
    if (!first_crossing(ray, smooth, 100.0, 1e-14).met) continue;
    const WhatIsRecorded a = record(smooth, from, along), b = record(flat, from, along);
    leant += a.crossed.lean > 0;
    // The crossing is the plane's; K is the way of the light, N on the side that is seen.
    EXPECT_EQ(a.crossed.record.Z, b.crossed.record.Z);
    EXPECT_NEAR(norm(a.details.N), 1, 1e-14);
    EXPECT_NEAR(norm(a.details.K + along), 0, 1e-7);
    EXPECT_NEAR(dot(a.details.N, a.details.K), a.crossed.record.mu, 1e-14);
    EXPECT_GE(a.crossed.record.mu, 0);
    EXPECT_LE(a.crossed.record.mu, 1);
    EXPECT_GT(dot(a.details.N, b.details.N), 0);
    EXPECT_GT(dot(b.details.N, b.details.K), 0);
    if (a.crossed.lean == 0) {
      const Vec3<double> radial = normalised(a.crossed.here.X);
      EXPECT_GT((inside ? -1 : 1) * dot(a.details.N, radial), 0.9);
    } else {
      EXPECT_LT(a.crossed.record.mu, 1e-12);
    }
  }
  EXPECT_GT(leant, kRays / 400);
}

TEST(MeshRecord, TextureCoordinatesAreInterpolatedAndWrapped) {
  TriangleSoup soup;
  soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
  soup.triangles = {{0, 1, 2}};
  soup.uv = {{{{2.9F, -0.5F}, {3.4F, -0.5F}, {2.9F, 0.5F}}}};
  move_and_scale(soup, {}, 1e-3);
  const Mesh mesh = make_mesh(soup);
  const AnyShape shape(MeshShape{view_of(mesh)});
  Random random(11);
  for (int i = 0; i < kRays; ++i) {
    double x = random.uniform(0, 1), y = random.uniform(0, 1);
    if (x + y > 1) x = 1 - x, y = 1 - y;
    const Vec3<double> at = {{1e-3 * x, 2e-3 * y, 0}};
    const auto n = normalised(Vec3<double>{{0.2, 0.1, i % 2 == 0 ? -1.0 : 1.0}});
    const auto crossed = record(shape, at - 3.0 * n, n).crossed;
    const double u = 2.9 + 0.5 * x, v = -0.5 + y;
    EXPECT_NEAR(crossed.record.u, u - std::floor(u), 1e-6);
    EXPECT_NEAR(crossed.record.v, v - std::floor(v), 1e-6);
    EXPECT_GE(crossed.record.u, 0);
    EXPECT_LE(crossed.record.u, 1);
  }
}

}  // namespace
}  // namespace nullcone::test
