// Directions at a lamp, in coordinates in which Newton's method may move them.
#pragma once

#include "core/trace/critical_curve.h"

NULLCONE_KERNEL_BEGIN

/// Vectors that make a right-handed orthonormal frame (a, b, n) with a unit vector n (T. Duff et al., JCGT 6
/// (2017) 1).
template <class S>
std::array<Vec3<S>, 2> beside_direction(const Vec3<S>& n) {
  const S sign = select(n[2] < S(0.0), S(-1.0), S(1.0)), a = S(-1.0) / (sign + n[2]), b = n[0] * n[1] * a;
  return {Vec3<S>{{S(1.0) + sign * n[0] * n[0] * a, sign * b, -(sign * n[0])}},
          Vec3<S>{{b, sign + n[1] * n[1] * a, -n[1]}}};
}

/// A direction and its derivatives along two coordinates: those along and across the critical curve close to
/// it, where a straight step aside would lead away from the curve by more than its distance; else two angles.
struct Aim {
  bool along_curve = false;
  Vec3<double> place{};  ///< in the mesh, if along_curve
  Vec3<double> n{}, a{}, b{};

  Aim() = default;
  Aim(const CriticalCurve& curve, const Vec3<double>& start) {
    constexpr double kNear = 0.3;
    along_curve = curve.exists && abs(start[0]) < kNear;
    set(curve, start, curve.direction(start));
  }
  Aim moved(const CriticalCurve& curve, double along_a, double along_b) const {
    Aim out = *this;
    out.set(curve, place + Vec3<double>{{along_a, along_b, 0}}, normalised(n + along_a * a + along_b * b));
    return out;
  }
  /// Which part of a step keeps on this side of the curve.
  double allowed(double along_a) const { return along_curve ? 0.5 * abs(place[0]) / abs(along_a) : kFar; }

 private:
  void set(const CriticalCurve& curve, const Vec3<double>& new_place, const Vec3<double>& direction) {
    if (along_curve) {
      using D = Dual<double, 2>;
      place = new_place;
      const Vec3<D> at =
          curve.direction(Vec3<D>{{D::variable(place[0], 0), D::variable(place[1], 1), D(0.0)}});
      n = plain(at);
      for (std::size_t c = 0; c < 3; ++c) a[c] = at[c].d[0], b[c] = at[c].d[1];
    } else {
      n = direction;
      const auto frame = beside_direction(n);
      a = frame[0], b = frame[1];
    }
  }
};

/// Side by side.
template <class S>
struct Aims {
  std::array<Aim, Lanes<S>::count> lane{};

  Vec3<S> load(Vec3<double> Aim::*vector) const {
    return Vec3<S>::map([&](std::size_t c) {
      std::array<double, Lanes<S>::count> values{};
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = (lane[i].*vector)[c];
      return Lanes<S>::load(values.data());
    });
  }
  S allowed(const S& along_a) const {
    std::array<double, Lanes<S>::count> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = lane[i].allowed(Lanes<S>::get(along_a, i));
    return Lanes<S>::load(values.data());
  }
  Aims moved(const CriticalCurve& curve, const S& along_a, const S& along_b) const {
    Aims out;
    for (std::size_t i = 0; i < lane.size(); ++i)
      out.lane[i] = lane[i].moved(curve, Lanes<S>::get(along_a, i), Lanes<S>::get(along_b, i));
    return out;
  }
};
template <class S>
Aims<S> select(const Mask<S>& choose, const Aims<S>& x, const Aims<S>& y) {
  std::array<bool, Lanes<S>::count> first{};
  Lanes<S>::store(choose, first.data());
  Aims<S> out = y;
  for (std::size_t i = 0; i < first.size(); ++i)
    if (first[i]) out.lane[i] = x.lane[i];
  return out;
}

NULLCONE_KERNEL_END
