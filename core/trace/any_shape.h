// Every shape but the sphere, in one type: which one it is, is asked once a step of a whole pack.
#pragma once

#include "core/trace/mesh_shape.h"
#include "core/trace/shapes.h"
#include "core/trace/solid_shape.h"

NULLCONE_KERNEL_BEGIN

/// The numbers of a rectangle in the xy plane with the normal +z: u along x, v along y.
inline FacetNumbers numbers_of_quad(double half_x, double half_y) {
  FacetNumbers out;
  out.linear[2] = 1;
  out.at_u = out.at_v = 0.5;
  out.by_u[0] = 0.5 / half_x, out.by_v[1] = 0.5 / half_y;
  return out;
}

class AnyShape {
 public:
  static constexpr bool isotropic = false;

  AnyShape() = default;
  explicit AnyShape(const Box& box) : box_(box) {
    as_primitive_.type = PrimitiveType::box;
    as_primitive_.half = {box.half_x, box.half_y, box.half_z};
  }
  explicit AnyShape(const SolidShape& solid) : type_(Type::solid), solid_(solid) {}
  explicit AnyShape(const MeshShape& mesh) : type_(Type::mesh), mesh_(mesh) {}

  /// f(shape), in its own type.
  template <class F>
  decltype(auto) with(F&& f) const {
    return type_ == Type::box ? f(box_) : type_ == Type::solid ? f(solid_) : f(mesh_);
  }

  double bounding_radius() const {
    return with([](const auto& shape) { return shape.bounding_radius(); });
  }
  bool starts_inside() const {
    return with([](const auto& shape) { return shape.starts_inside(); });
  }
  /// Whether it has no inside.
  bool is_open() const {
    return type_ == Type::box ? box_.flat() : type_ == Type::solid ? !solid_.closed() : !mesh_.closed();
  }
  /// Whether a search does not care on which side of it a ray is.
  bool is_sheet() const { return type_ == Type::mesh || is_open(); }
  template <class S>
  Vec3<S> outward(const Vec3<S>& X) const {
    return facet(X).normal(X);
  }
  template <class S>
  Mask<S> holds(const Vec3<S>& X) const {
    return with([&](const auto& shape) { return shape.holds(X); });
  }
  bool hides(const Vec3<double>& X) const {
    return with([&](const auto& shape) { return shape.hides(X); });
  }
  template <class S>
  S safe_step(const Sight<S>& ray, const S& resolution) const {
    return with([&](const auto& shape) { return shape.safe_step(ray, resolution); });
  }
  template <class S>
  S onward_step(const Sight<S>& ray, const S& resolution, const Mask<S>& inside) const {
    return with([&](const auto& shape) { return shape.onward_step(ray, resolution, inside); });
  }
  template <class S>
  S skip(const Sight<S>& ray, const S& rounding) const {
    return with([&](const auto& shape) { return shape.skip(ray, rounding); });
  }

  /// Whether its normal in the record is another than that of its surface.
  bool is_smooth() const { return type_ == Type::mesh && mesh_.is_smooth(); }
  /// A surface with that normal near X.
  template <class S>
  Facet<S> shading(const Vec3<S>& X) const {
    return Facet<S>::near(X, [&](const Vec3<double>& at) { return mesh_.shading_near(at); });
  }

  /// The surface near X, for the record.
  template <class S>
  Facet<S> facet(const Vec3<S>& X) const {
    return Facet<S>::near(X, [&](const Vec3<double>& at) {
      if (type_ == Type::mesh) return mesh_.numbers_near(at);
      if (type_ == Type::solid) return solid_.numbers_near(at);
      return box_.flat() ? numbers_of_quad(box_.half_x, box_.half_y)
                         : numbers_of(face_near(as_primitive_, at));
    });
  }

 private:
  enum class Type { box, solid, mesh };
  Type type_ = Type::box;
  Box box_{1, 1, 1};
  Primitive as_primitive_;
  SolidShape solid_{};
  MeshShape mesh_{};
};

/// The surface of a shape near a point of it: what has a value, a normal and texture coordinates.
template <class Shape, class S>
auto surface_near(const Shape& shape, const Vec3<S>& X) {
  if constexpr (requires { shape.facet(X); })
    return shape.facet(X);
  else
    return shape;
}

NULLCONE_KERNEL_END
