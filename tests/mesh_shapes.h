// Meshes for tests: spheres of triangles, soups, slivers.
#pragma once

#include <cmath>
#include <map>
#include <numbers>

#include "core/scene/mesh_tree.h"
#include "core/trace/any_shape.h"
#include "core/trace/placing.h"
#include "metrics/minkowski_kernel.h"
#include "tests/random_rays.h"
#include "tests/sanitized.h"

namespace nullcone::test {
namespace {

constexpr int kRays = kSanitized ? 300 : 6'000;  ///< of a test of meshes

/// The icosahedron with each edge in n parts, its points drawn out to radius(direction): 20 n^2 triangles.
template <class Radius>
TriangleSoup sphere_soup(int n, bool smooth, const Radius& radius) {
  using V = host::Vec3<double>;
  const double golden = std::numbers::phi;
  std::vector<V> corners;
  for (const double s : {-1.0, 1.0})
    for (const double t : {-golden, golden}) {
      corners.push_back({{0, s, t}});
      corners.push_back({{s, t, 0}});
      corners.push_back({{t, 0, s}});
    }
  TriangleSoup out;
  std::map<std::array<long, 3>, std::uint32_t> known;
  const auto number = [&](const V& p) {
    std::array<long, 3> key;
    for (std::size_t i = 0; i < 3; ++i) key[i] = std::lround(1e9 * p[i]);
    const auto [found, is_new] = known.try_emplace(key, static_cast<std::uint32_t>(out.positions.size()));
    const V direction = host::normalised(p);
    if (is_new) out.positions.push_back((radius(direction) * direction).c);
    return found->second;
  };
  const auto add = [&](const V& a, const V& b, const V& c) {
    out.triangles.push_back({number(a), number(b), number(c)});
    if (!smooth) return;
    MeshNormals normals;
    const V* const at[] = {&a, &b, &c};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < 3; ++i)
        normals.corner[k][i] = static_cast<float>(host::normalised(*at[k])[i]);
    out.normals.push_back(normals);
  };
  for (std::size_t i = 0; i < 12; ++i)
    for (std::size_t j = 0; j < 12; ++j)
      for (std::size_t k = 0; k < 12; ++k) {
        const V a = corners[i], b = corners[j], c = corners[k];
        const auto near = [](const V& x, const V& y) { return std::fabs(host::norm(x - y) - 2) < 1e-9; };
        if (i > j || i > k || !near(a, b) || !near(b, c) || !near(c, a)) continue;
        if (host::dot(host::cross(b - a, c - a), a) < 0) continue;
        const auto at = [&](int x, int y) {
          return (1.0 / n) * ((double(n - x - y)) * a + double(x) * b + double(y) * c);
        };
        for (int x = 0; x < n; ++x)
          for (int y = 0; x + y < n; ++y) {
            add(at(x, y), at(x + 1, y), at(x, y + 1));
            if (x + y + 1 < n) add(at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
          }
      }
  return out;
}

inline double round_as(const host::Vec3<double>&) { return 1; }

/// Of an object at rest there, whose bounding ball is a little larger than it need be.
inline host::RestPlacing<host::Minkowski> at_origin(double ball) {
  using host::Vec3;
  return {{}, {{0, 0, 0, 0}}, true, {Vec3<double>{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}, 1.001 * ball};
}

inline void move_and_scale(TriangleSoup& soup, const host::Vec3<double>& by, double scale) {
  for (auto& p : soup.positions)
    for (std::size_t i = 0; i < 3; ++i) p[i] = scale * (p[i] + by[i]);
}

/// Triangles anywhere within a ball of radius 1, of edges from `least` to 1; `thin`: their height is a part
/// of their length as small as that.
inline TriangleSoup random_soup(Random& random, std::uint32_t count, double least, double thin = 1) {
  TriangleSoup out;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double size = 0.3 * random.logarithmic(least, 1);
    const auto a = random.uniform(0, 0.7) * random.direction(), along = random.direction();
    const auto b = a + size * along,
               c = a + size * random.uniform(0, 1) * along +
                   size * random.logarithmic(std::min(thin, 0.99), 1) * random.direction();
    for (const auto& p : {a, b, c}) out.positions.push_back(p.c);
    out.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return out;
}

}  // namespace
}  // namespace nullcone::test
