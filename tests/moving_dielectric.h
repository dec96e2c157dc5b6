// Light in a moving dielectric, as a spacetime (Gordon 1923): with the 4-velocity u of the medium and its
// index n, g_mn = eta_mn + (1/n^2 - 1) u_m u_n. Here a drop of glass that turns, or flows, and thins out: the
// second worked example of docs/adding-a-spacetime.md.
#pragma once

#include "core/trace/metric.h"

NULLCONE_KERNEL_BEGIN

struct MovingDielectric {
  double index = 1.5;  ///< refractive index in the middle
  double radius = 1;   ///< of the drop: n = 1 + (index - 1)/(1 + rho^2/radius^2)^2
  double swirl = 0.4;  ///< about z: spatial part of u, swirl (-y, x, 0)/(radius (1 + rho^2/radius^2))
  double stream = 0;   ///< along x: to be added to it

  static constexpr std::string_view name = "moving_dielectric";
  static constexpr std::tuple parameters{
      Parameter<MovingDielectric>{"index", &MovingDielectric::index, 1, 5},
      Parameter<MovingDielectric>{"radius", &MovingDielectric::radius, 1e-6, 1e12},
      Parameter<MovingDielectric>{"swirl", &MovingDielectric::swirl, -10, 10},
      Parameter<MovingDielectric>{"stream", &MovingDielectric::stream, -10, 10}};
  static constexpr int skies = 1;

  template <class S>
  Matrix4<S> g(const Vec4<S>& x) const {
    const S one(1.0), thin = one / (one + S(1 / (radius * radius)) * dot(spatial(x), spatial(x)));
    const S n = one + S(index - 1) * thin * thin, turn = S(swirl / radius) * thin;
    const S ux = S(stream) - turn * x[2], uy = turn * x[1];
    const Vec4<S> u = {{sqrt(one + ux * ux + uy * uy), -ux, -uy, S(0.0)}};  // lower indices
    const S slower = one / (n * n) - one;
    Matrix4<S> out;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j)
        out[i][j] = S(i != j ? 0.0 : i == 0 ? 1.0 : -1.0) + slower * u[i] * u[j];
    return out;
  }

  template <class S>
  S length_scale(const Vec4<S>& x) const {
    return max(S(radius), norm(spatial(x)));
  }

  /// Far out, n - 1 falls as 1/rho^4, and so does what is left of the bending.
  template <class S>
  S ending(const Phase<S>& at, const Phase<S>& rate, double precision) const {
    const Vec3<S> X = spatial(at.x);
    const S thin = S(radius * radius) / dot(X, X),
            glass = S(10 * (index - 1) * (1 + stream * stream)) * thin * thin;
    const auto escaped = (dot(X, spatial(rate.x)) > S(0.0)) & (glass < S(0.1 * precision)) & (thin < S(0.01));
    return select(escaped, as_scalar<S>(Ending::sky), as_scalar<S>(Ending::none));
  }

  template <class S>
  auto conserved(const Vec4<S>& x, const Vec4<S>& k) const {
    using C = std::pair<std::string_view, S>;
    return std::array<C, 1>{C{"E", (g(x) * k)[0]}};
  }
};

NULLCONE_KERNEL_END
