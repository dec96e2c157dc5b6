// What is recorded of a crossing with a mesh: where, with which normal, with which texture coordinates.
#include <gtest/gtest.h>

#include "core/trace/closed_onward.h"
#include "core/trace/details.h"
#include "metrics/goedel_kernel.h"
#include "tests/mesh_shapes.h"
#include "tests/sanitized.h"

namespace nullcone::test {
namespace {

using namespace nullcone::host;

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

/// Rays towards a mesh of a sphere, and towards the sphere.
template <class Placing>
void compare_with_sphere(const Placing& placing, const Vec4<double>& event, double radius,
                         const AnyShape& mesh, Random& random, int& met, int& other) {
  const auto launch = placing.launch(event);
  const double limit = 4 * std::numbers::pi * placing.metric.a, resolution = 4e-15 * norm(spatial(event));
  for (int n = 0; n < 300; ++n) {
    const Vec3<double> k = random.direction();
    const auto ray = placing.ray(launch, Vec4<double>{{-1, k[0], k[1], k[2]}});
    const Sphere sphere{radius};
    const Search<double> a = first_crossing(ray, mesh, limit, resolution),
                         b = first_crossing(ray, sphere, limit, resolution);
    EXPECT_FALSE(a.given_up);
    EXPECT_LT(a.steps, 200);
    met += b.met;
    if (a.met != b.met) {
      ++other;
      continue;
    }
    if (!b.met) continue;
    const auto at = ray.at(b.lambda);
    const double mu = std::fabs(dot(at.X, at.slope)) / (norm(at.X) * norm(at.slope));
    if (mu > 0.1) {
      EXPECT_NEAR(a.lambda, b.lambda, 2e-3 * radius / mu);
    }
  }
}

TEST(MeshRecord, AMeshSphereInGoedelsUniverse) {
  Random random(12);
  int met = 0, other = 0, rays = 0;
  for (int n = 0; n < (kSanitized ? 60 : 300); ++n) {
    const double radius = random.logarithmic(1e-3, 0.5);
    TriangleSoup soup = sphere_soup(24, false, round_as);
    move_and_scale(soup, {}, radius);
    const Mesh scaled = make_mesh(std::move(soup));
    const Goedel metric{random.uniform(0.8, 3)};
    const Vec3<double> z = random.direction(), x = normalised(cross(random.direction(), z));
    const RestPlacing<Goedel> placing{
        metric, random.event(0.8), true, {x, cross(z, x), z}, 1.001 * scaled.ball};
    Vec4<double> event = random.event(0.8);
    const Vec3<double> from = spatial(metric.to_origin(placing.place, event));
    if (norm(from) < 1.5 * radius) continue;
    rays += 300;
    compare_with_sphere(placing, event, radius, AnyShape(MeshShape{view_of(scaled)}), random, met, other);
  }
  EXPECT_GT(met, rays / 300);
  EXPECT_LT(other, 1 + met / 100) << "rays between the sphere and the mesh within it";
}

}  // namespace
}  // namespace nullcone::test
