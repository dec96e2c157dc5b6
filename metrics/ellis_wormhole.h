// The wormhole of Ellis (1973), ds^2 = dt^2 - dl^2 - (b^2 + l^2) dOmega^2, in isotropic coordinates
// l = rho - b^2/(4 rho), where one Cartesian chart holds both sides:
//
//   ds^2 = dt^2 - n^2 (dx^2 + dy^2 + dz^2),  n = 1 + b^2/(4 rho^2)
//
// The throat is rho = b/2; X -> b^2 X/(4 rho^2) is an isometry and exchanges the sides. rho = 0 is the
// infinity of the other side.
#pragma once

#include "core/trace/metric.h"

NULLCONE_KERNEL_BEGIN

struct EllisWormhole {
  double throat = 1;  ///< b: the throat is a sphere of circumference 2 pi b

  static constexpr std::string_view name = "ellis_wormhole";
  static constexpr std::tuple parameters{
      Parameter<EllisWormhole>{"throat", &EllisWormhole::throat, 1e-6, 1e12}};
  static constexpr int skies = 2;
  static constexpr bool central = true;

  double quarter() const { return 0.25 * throat * throat; }

  template <class S>
  Matrix4<S> g(const Vec4<S>& X) const {
    const S n = S(1.0) + S(quarter()) / dot(spatial(X), spatial(X));
    Matrix4<S> out{};
    out[0][0] = S(1.0);
    out[1][1] = out[2][2] = out[3][3] = -(n * n);
    return out;
  }

  /// H = p_t^2/2 - p^2/(2 n^2): a medium of refractive index n. With q = b^2/4, 1/n = rho^2/(rho^2 + q),
  /// which is regular at rho = 0, and dp = -(p^2/n^3) dn = (2 q p^2 rho^2/(rho^2 + q)^3) X.
  template <class S>
  NULLCONE_INLINE Phase<S> rhs(const Vec4<S>& X, const Vec4<S>& p) const {
    const S rho2 = X[1] * X[1] + X[2] * X[2] + X[3] * X[3], over = S(1.0) / (rho2 + S(quarter()));
    const S over_n = rho2 * over, over_n2 = over_n * over_n;
    const S p2 = p[1] * p[1] + p[2] * p[2] + p[3] * p[3],
            force = S(2 * quarter()) * p2 * over_n * (over * over);
    return {{{p[0], -(over_n2 * p[1]), -(over_n2 * p[2]), -(over_n2 * p[3])}},
            {{S(0.0), force * X[1], force * X[2], force * X[3]}}};
  }

  /// Errors count against rho, on either side: the isometry keeps relative errors of rho. The throat's own
  /// size would hide, on the far side, where rho < b/2, all that happens.
  template <class S>
  S length_scale(const Vec4<S>& X) const {
    return norm(spatial(X));
  }

  template <class S>
  S ending(const Phase<S>& at, const Phase<S>& rate, double precision) const;
  template <class S>
  Vec3<S> sky_direction(const Phase<S>& at, const Phase<S>& rate, const S& end) const;

  template <class S>
  auto conserved(const Vec4<S>& x, const Vec4<S>& k) const {
    const Vec4<S> p = g(x) * k;
    using C = std::pair<std::string_view, S>;
    return std::array<C, 4>{C{"E", p[0]}, C{"L_x", x[2] * p[3] - x[3] * p[2]},
                            C{"L_y", x[3] * p[1] - x[1] * p[3]}, C{"L_z", x[1] * p[2] - x[2] * p[1]}};
  }

 private:
  /// A point and a direction of motion as the side that they end on has them: the exchange map where far.
  template <class S>
  struct Seen {
    Vec3<S> X, n;
  };
  template <class S>
  Seen<S> seen_from(const Mask<S>& other_side, const Vec3<S>& X, const Vec3<S>& V) const {
    const S rho2 = dot(X, X), over = S(1.0) / rho2;
    const Vec3<S> mirrored = V - (S(2.0) * dot(X, V) * over) * X;
    const auto choose = [&](const Vec3<S>& there, const Vec3<S>& here) {
      return Vec3<S>::map([&](std::size_t i) { return select(other_side, there[i], here[i]); });
    };
    return {choose((S(quarter()) * over) * X, X), normalised(choose(mirrored, V))};
  }
};

// With R^2 = b^2 + l^2 and the sine w = B/R of the angle between ray and radius, the azimuth that is left is
// the integral of dw / sqrt((1 - w^2)(1 - w^2 b^2/B^2)) up to w; its flat part is that angle itself. What
// remains,
//   (b^2/2R^2) w (1/3 + w^2/10 + 3 w^4/56 + ...) + O(b^4 w/R^4),
// is the bending still to come. sky_direction adds the terms shown; ending waits until the rest is small.
template <class S>
S EllisWormhole::ending(const Phase<S>& at, const Phase<S>& rate, double precision) const {
  const Vec3<S> position = spatial(at.x);
  const Mask<S> other_side = dot(position, position) < S(quarter());
  const auto [X, n] = seen_from<S>(other_side, position, spatial(rate.x));
  const S rho2 = dot(X, X), along = dot(X, n), ratio = S(throat * throat) / rho2;
  const S w2 = S(1.0) - along * along / rho2, w4 = w2 * w2;  // n has length 1
  const S to_come = ratio * (S(0.15) * w4 * w2 + S(0.5) * ratio);
  const auto escaped = (along > S(0.0)) & (to_come < S(0.1 * precision)) & (ratio < S(0.01));
  const S which = select(other_side, as_scalar<S>(Ending::second_sky), as_scalar<S>(Ending::sky));
  return select(escaped, which, as_scalar<S>(Ending::none));
}

template <class S>
Vec3<S> EllisWormhole::sky_direction(const Phase<S>& at, const Phase<S>& rate, const S& end) const {
  const Mask<S> other_side = end > as_scalar<S>(Ending::sky);
  const auto [X, n] = seen_from<S>(other_side, spatial(at.x), spatial(rate.x));
  const S over = S(1.0) / dot(X, X), along = dot(X, n), w2 = S(1.0) - along * along * over;
  const S bend = S(0.5 * throat * throat) * over * (S(1.0 / 3) + w2 * (S(0.1) + S(3.0 / 56) * w2));
  return n - (bend * sqrt(over)) * (X - along * n);
}

NULLCONE_KERNEL_END
