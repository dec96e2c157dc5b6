// The critical curve of a lamp near a centre: the directions between rays that fall in, or pass through, and
// rays that come back. Beside it the turning of rays grows as the logarithm of the distance from it.
#pragma once

#include <limits>
#include <numbers>

#include "core/base/dual.h"

NULLCONE_KERNEL_BEGIN

/// e^-x for x > 0, else 1; good to a part in a dozen. By products alone: the exp of one lane would be code
/// that instruction sets share.
inline double decay(double x) {
  constexpr double kPart = 1.0 / 16, kFactor = 0.9394130628134758;  // e^-1/16
  double out = 1;
  for (; x > 0; x -= kPart) out *= kFactor;
  return out;
}

/// psi_c(phi), in polar angles about the direction to the centre; and coordinates (e, phi) of the sphere
/// of directions in which it is e = 0, the centre's direction e = -1 and the opposite one e = 1.
struct CriticalCurve {
  static constexpr std::size_t kColumns = 32, kAngles = 4 * kColumns;
  static constexpr double kTurn = 2 * std::numbers::pi;

  bool exists = false;
  Vec3<double> centre{}, a{}, b{};
  std::array<double, kAngles> psi{};

  template <class S>
  Vec3<S> direction_at(const S& angle, const S& phi) const {
    const auto [s, c] = sincos(phi);
    const auto [sine, cosine] = sincos(angle);
    return cosine * convert<S>(centre) + sine * (c * convert<S>(a) + s * convert<S>(b));
  }
  /// Of a place in the mesh: (e, phi, 0), or where there is no curve the direction itself.
  template <class S>
  Vec3<S> direction(const Vec3<S>& place) const {
    if (!exists) return normalised(place);
    const S critical = interpolated(place[1]);
    const S range = plain(place[0]) < 0 ? critical : S(std::numbers::pi) - critical;
    return direction_at(critical + place[0] * range, place[1]);
  }
  static double phi_of(std::size_t angle) { return kTurn * static_cast<double>(angle) / kAngles; }
  /// From one place to another; angles the short way round.
  Vec3<double> way(const Vec3<double>& from, const Vec3<double>& to) const {
    Vec3<double> out = to - from;
    if (exists) out[1] -= kTurn * floor(out[1] / kTurn + 0.5);
    return out;
  }

  /// Rows of a mesh: e from -1 to 1, so fine next to the curve that light is resolved which turns up to
  /// `turning`.
  template <class F>
  void for_each_row(double turning, F&& f) const {
    constexpr double kRatio = 1.0 / 3, kMostAngle = 0.2, kNearest = 0.01, kRounding = 1e-12, kFree = 2.2,
                     kSpreading = 1.15;  // of perturbations, a radian; more than 1 for light against a spin
    double least = std::numbers::pi;
    for (const double angle : psi) least = min(least, angle);
    const double end = max(kRounding, kNearest * decay(kSpreading * (turning - kFree)));
    const auto side = [&](double sign, double range, double last) {
      for (double e = 1; e > last; e -= min(kMostAngle / range, kRatio * e)) f(sign * e);
    };
    side(-1, least, end);
    side(1, std::numbers::pi, end * least / std::numbers::pi);
  }

 private:
  /// Lagrange's formula through the eight nearest angles.
  template <class S>
  S interpolated(const S& phi) const {
    const S x = S(kAngles / kTurn) * phi;
    const double first = floor(plain(x)) - 3;
    S out(0.0);
    for (int i = 0; i < 8; ++i) {
      S weight(1.0);
      for (int j = 0; j < 8; ++j)
        if (j != i) weight = S(1.0 / (i - j)) * weight * (x - S(first + j));
      const auto n = static_cast<long>(first + i) % static_cast<long>(kAngles);
      out = out + S(psi[static_cast<std::size_t>(n < 0 ? n + static_cast<long>(kAngles) : n)]) * weight;
    }
    return out;
  }
};

NULLCONE_KERNEL_END
