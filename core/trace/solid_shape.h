// Solids as rays meet them.
//
// A point of a ray is inside of a solid or outside of it, by its sides of the primitives; until one of the
// deciding primitives may be passed, that cannot change. So a search goes from one such bound to the next,
// and a crossing is where the side changes. Who is inside, is inside of a solid that is larger by a few
// roundings: rays along its faces are told apart.
#pragma once

#include "core/trace/facet.h"
#include "core/trace/primitive.h"
#include "core/trace/solid_face.h"

NULLCONE_KERNEL_BEGIN

/// Closed primitives, joined; or one that is not closed, alone.
struct SolidShape {
  const Primitive* primitives;
  const SolidStep* steps;
  std::size_t count;  ///< of steps
  double ball;
  bool from_inside = false;
  static constexpr bool isotropic = false;

  bool closed() const { return count > 1 || primitives[0].closed(); }
  double bounding_radius() const { return ball; }
  bool starts_inside() const { return from_inside; }

  template <class S>
  S safe_step(const Sight<S>& ray, const S& resolution) const {
    return onward_step(ray, resolution, S(from_inside ? 1.0 : 0.0) > S(0.0));
  }

  template <class S>
  S onward_step(const Sight<S>& ray, const S& resolution, const Mask<S>& inside) const {
    if (!closed()) return step_to_sheet(primitives[0], ray, resolution);
    const S grown = select(inside, S(4.0) * resolution * ray.slope_max + S(4e-15 * ball), S(0.0));
    const Side<S> now = side(ray, grown);
    return select((now.in & !inside) | (inside & !now.in), S(0.0), now.until);
  }

  template <class S>
  S skip(const Sight<S>& ray, const S& rounding) const {
    return closed() ? S(0.0) : skip_sheet(primitives[0], ray, rounding, ball);
  }

  /// Whether X is within it.
  template <class S>
  Mask<S> holds(const Vec3<S>& X) const {
    const S none(0.0);
    if (!closed()) return none > none;
    return side(Sight<S>{X, Vec3<S>{}, none, S(kFar), none, none, none}, none).in;
  }

  /// Whether an observer at X could not see out (or, for one that is seen from inside, not in).
  bool hides(const Vec3<double>& X) const {
    if (closed()) return holds(X) != from_inside;
    const Sight<double> here{X, {}, 0, kFar, 0, 1, 0};
    return step_to_sheet(primitives[0], here, 1e-12 * ball) == 0;
  }

  /// The surface near X, for the record.
  FacetNumbers numbers_near(const Vec3<double>& X) const {
    return numbers_of(face_near(primitives, steps, count, X));
  }

 private:
  template <class S>
  Side<S> side(const Sight<S>& ray, const S& grown) const {
    if (count == 1) return side_of(primitives[0], ray, grown);
    std::array<Side<S>, Solid::kMostDepth> stack;
    std::size_t top = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const SolidStep& step = steps[i];
      if (step.join == Join::take) {
        // What is taken away shrinks as the solid grows.
        stack[top++] = side_of(primitives[step.primitive], ray, step.taken_away ? -grown : grown);
        continue;
      }
      const Side<S> b = stack[--top], a = stack[--top];
      stack[top++] = step.join == Join::unite       ? either(a, b)
                     : step.join == Join::intersect ? both(a, b)
                                                    : both(a, outside_of(b));
    }
    return stack[0];
  }
};

NULLCONE_KERNEL_END
