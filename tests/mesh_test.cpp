// Rays against meshes: no triangle is missed, none is invented, no ray slips through where triangles meet,
// and each crossing is where long double finds it. Straight rays and curved ones.
#include <gtest/gtest.h>

#include "tests/mesh_compare.h"
#include "tests/mesh_shapes.h"
#include "tests/sanitized.h"

namespace nullcone::test {
namespace {

using namespace nullcone::host;

double bumpy(const Vec3<double>& d) { return 1 + 0.2 * std::sin(5 * d[0]) * std::sin(4 * d[1] + 1); }

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
    straight_rays(3, random_soup(random, 600, 1e-3), false, kRays / 6).expect_clean(kRays / 60);
    // The plane of a sliver is known to rounding times length over height.
    straight_rays(4, random_soup(random, 600, 0.1, 1e-3), false, kRays / 6, 1e3).expect_clean(kRays / 60);
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

TEST(Mesh, NeedlesOfAClosedMesh) {
  TriangleSoup soup = sphere_soup(8, false, bumpy);
  for (auto& p : soup.positions) p[0] *= 1e-5;
  straight_rays(13, soup, true, kRays, 1e3).expect_clean(kRays / 20);

  // And through their vertices and edges.
  const Mesh mesh = make_mesh(soup);
  const AnyShape shape(MeshShape{view_of(mesh)});
  Random random(15);
  Tally tally;
  for (int n = 0; n < kRays; ++n) {
    const auto& t = soup.triangles[static_cast<std::size_t>(n) % soup.triangles.size()];
    const Vec3<double> a{soup.positions[t[0]]}, b{soup.positions[t[1]]};
    const Vec3<double> from = 3.0 * random.direction();
    straight({soup, shape, 1e-10, true}, from, a + (n % 4 * 0.25) * (b - a), tally);
  }
  tally.expect_clean(kRays / 2);
}

TEST(Mesh, ATinyTriangleIsNotMetBeforeItsEdge) {
  // Rounding of the distance is as large as what the ray is off the plane there.
  TriangleSoup soup;
  soup.positions = {{0, 0, 0}, {1e-9, 0, 0}, {0, 1e-9, 0}};
  soup.triangles = {{0, 1, 2}};
  const Mesh mesh = make_mesh(soup);
  const AnyShape shape(MeshShape{view_of(mesh)});
  const auto placing = at_origin(mesh.ball);
  Random random(14);
  int met = 0;
  for (int n = 0; n < kRays; ++n) {
    const Vec3<double> aim = {{1e-10 * random.uniform(3, 5), 1e-10 * random.uniform(1, 4), 0}},
                       along = normalised(Vec3<double>{{1, 0.1, random.logarithmic(4e-6, 4e-5)}}),
                       from = aim - random.uniform(0.5, 1) * along;
    const auto ray = placing.ray(placing.launch(Vec4<double>{{0, from[0], from[1], from[2]}}),
                                 Vec4<double>{{-1, along[0], along[1], along[2]}});
    const Search<double> search = first_crossing(ray, shape, 100.0, 4e-15 * norm(from));
    if (!search.met) continue;
    ++met;
    const Vec3<double> X = ray.at(search.lambda).X;
    EXPECT_GT(X[0], -1e-13);
    EXPECT_LT(X[0], 1e-9 + 1e-13);
  }
  EXPECT_GT(met, kRays / 2);
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

TEST(Mesh, HoldsIsNotMisledByVertices) {
  // Two tetrahedra whose tips look at X, along the line by which it is asked for: three triangles meet there,
  // and one behind them.
  const Vec3<double> W = {{0.5377, 0.6181, 0.5731}};
  const Vec3<double> u = normalised(cross(W, Vec3<double>{{0, 0, 1}})), v = normalised(cross(W, u));
  TriangleSoup soup;
  for (const double side : {1.0, -1.0}) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const Vec3<double>& p : {2.0 * W, 4.0 * W + u, 4.0 * W + v, 4.0 * W - u - v})
      soup.positions.push_back((side * p).c);
    for (std::array<std::uint32_t, 3> t :
         {std::array{0U, 1U, 2U}, {0U, 2U, 3U}, {0U, 3U, 1U}, {1U, 3U, 2U}}) {
      if (side < 0) std::swap(t[1], t[2]);
      soup.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }
  const Mesh mesh = make_mesh(soup);
  ASSERT_TRUE(mesh.closed);
  const MeshShape shape{view_of(mesh)};
  EXPECT_FALSE(shape.holds(Vec3<double>{}));
  EXPECT_TRUE(shape.holds(3.5 * W));
  EXPECT_TRUE(shape.holds(-3.5 * W));
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

}  // namespace
}  // namespace nullcone::test
