// Meshes as rays meet them.
//
// Each lane looks for itself. Along a straight line the step is that to the first triangle; a triangle counts
// as met where the line passes through it and its plane is as near as rounding. A curved ray stays within a
// thickening line for a while: its step is one before which it can meet no triangle. Every surface is met,
// whichever side it is met from: a mesh may overlap itself.
#pragma once

#include <limits>

#include "core/trace/mesh_face.h"
#include "core/trace/mesh_triangle.h"

NULLCONE_KERNEL_BEGIN

struct MeshShape {
  MeshView mesh;
  bool from_inside = false;
  static constexpr bool isotropic = false;

  bool closed() const { return mesh.closed; }
  double bounding_radius() const { return mesh.ball; }
  bool starts_inside() const { return from_inside; }
  bool is_smooth() const { return mesh.normals != nullptr; }

  template <class S>
  S safe_step(const Sight<S>& ray, const S& resolution) const {
    return by_lane(ray, resolution, [&](const Bow& bow) { return step(bow); });
  }
  /// Who goes on behind a surface has skipped it.
  template <class S>
  S onward_step(const Sight<S>& ray, const S& resolution, const Mask<S>&) const {
    return safe_step(ray, resolution);
  }

  /// How far a ray that meets triangles here has to go on to be past them. The flatter it meets them, the
  /// longer it stays as near as rounding.
  template <class S>
  S skip(const Sight<S>& ray, const S& rounding) const {
    return by_lane(ray, rounding, [&](const Bow& bow) { return skip(bow); });
  }

  /// Whether X is within it: whether the surface winds around it.
  template <class S>
  Mask<S> holds(const Vec3<S>& X) const {
    std::array<double, Lanes<S>::count> within{};
    for (std::size_t lane = 0; lane < within.size(); ++lane)
      within[lane] = winds_around(mesh, in_units(X, lane)) ? 1 : 0;
    return Lanes<S>::load(within.data()) > S(0.0);
  }

  /// Whether an observer at X could not see out (or, for one that is seen from inside, not in).
  bool hides(const Vec3<double>& X) const {
    if (closed()) return winds_around(mesh, in_units(X, 0)) != from_inside;
    return face_near(mesh, in_units(X, 0)).distance <= 1e-12;
  }

  /// The surface near X, for the record; and the one that shading takes the normal from.
  FacetNumbers numbers_near(const Vec3<double>& X) const {
    return numbers_of(mesh, face_near(mesh, in_units(X, 0)), in_units(X, 0));
  }
  FacetNumbers shading_near(const Vec3<double>& X) const {
    return shading_numbers_of(mesh, face_near(mesh, in_units(X, 0)));
  }

 private:
  template <class S>
  Vec3<double> in_units(const Vec3<S>& X, std::size_t lane) const {
    return Vec3<double>::map([&](std::size_t i) { return Lanes<S>::get(X[i], lane) / mesh.unit; });
  }

  /// f(bow) of each lane that is near.
  template <class S, class F>
  S by_lane(const Sight<S>& ray, const S& rounding, F&& f) const {
    std::array<double, Lanes<S>::count> out{};
    for (std::size_t lane = 0; lane < out.size(); ++lane) {
      const auto of = [&](const S& x) { return Lanes<S>::get(x, lane); };
      if (of(ray.clearance) > 0) continue;
      const Bow bow{in_units(ray.X, lane), in_units(ray.slope, lane), of(ray.bend_max) / mesh.unit,
                    of(ray.valid), of(rounding) * of(ray.slope_max) / mesh.unit};
      // What is not a number must not pass for a ray that meets nothing.
      const double square = dot(bow.X, bow.X) + dot(bow.W, bow.W);
      out[lane] = square < std::numeric_limits<double>::infinity() ? f(bow) : square - square;
    }
    return Lanes<S>::load(out.data());
  }

  double step(const Bow& ray) const { return ray.bend > 0 ? curved_step(ray) : straight_step(ray); }

  /// To the first triangle; 0 where one is met; kFar without one.
  double straight_step(const Bow& ray) const {
    MeshLine line(mesh, ray.X, ray.W);
    const Shear shear(line.foot, ray.W);
    double first = kFar;
    line.look(0, ray.until, ray.rounding);
    line.walk(mesh, [&](const LeafRange& leaf) {
      for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
        const MeshTriangle& triangle = mesh.triangles[i];
        if (!shear.areas(triangle).crossed()) continue;
        const TrianglePlane plane(triangle, ray.X, ray.W);
        if (abs(plane.rate) <= kEdgeOn * line.speed) continue;
        const double near = ray.rounding + plane.blur;
        if (abs(plane.ahead) <= near && is_beside(triangle, ray.X, 2 * near)) {
          first = 0;
          return true;
        }
        const double t = plane.ahead / plane.rate;
        if (t > 0 && t < first) first = t, line.look(t);
      }
      return false;
    });
    return first;
  }

  double curved_step(Bow ray) const {
    // Not so far that the line becomes thick beside the mesh.
    const double off = max(norm(ray.X - mesh.centre) - 2 * mesh.half, 0.0);
    const double valid = ray.until;
    ray.until = min(valid, sqrt((0.0625 * mesh.half + 0.25 * off) / ray.bend));
    MeshLine line(mesh, ray.X, ray.W);
    line.look(0, ray.until, ray.thickness());
    line.walk(mesh, [&](const LeafRange& leaf) {
      for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
        const double least = not_before(mesh.triangles[i], ray);
        if (least >= ray.until) continue;
        ray.until = least;
        if (least <= 0) return true;
        line.look(0, ray.until, ray.thickness());
      }
      return false;
    });
    return ray.until;
  }

  double skip(Bow ray) const {
    MeshLine line(mesh, ray.X, ray.W);
    const Shear shear(line.foot, ray.W);
    const double over_speed = 1 / max(line.speed, 1e-290);
    double out = 8 * ray.rounding * over_speed;
    ray.bend = 0, ray.until = 1;
    line.look(0, 0, 16 * ray.rounding);
    line.walk(mesh, [&](const LeafRange& leaf) {
      for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
        const MeshTriangle& triangle = mesh.triangles[i];
        const TrianglePlane plane(triangle, ray.X, ray.W);
        const double near = ray.rounding + plane.blur;
        if (abs(plane.ahead) > 4 * near || !is_beside(triangle, ray.X, 4 * near)) continue;
        if (abs(plane.rate) <= kEdgeOn * line.speed) continue;
        double most = kBesideSkip * ray.rounding * over_speed;
        if (shear.areas(triangle).crossed()) {
          for (std::size_t k = 0; k < 3; ++k)
            most =
                max(most, over_speed * norm(corner_of(triangle, k) - corner_of(triangle, k < 2 ? k + 1 : 0)));
        } else {
          Bow here = ray;
          here.rounding = 4 * near;
          if (not_before(triangle, here) > 0) continue;
        }
        out = max(out, min(8 * near / abs(plane.rate), most));
      }
      return false;
    });
    return out;
  }

  /// Rays that run in a triangle's plane do not meet it.
  static constexpr double kEdgeOn = 1e-14;
  /// What a ray passes beside, by rounding, it shall not meet; but it may run beside it for long.
  static constexpr double kBesideSkip = 4e3;
};

NULLCONE_KERNEL_END
