// What a crossing tells on request: directions in the object's frame, and how texture coordinates change from
// pixel to pixel.
#pragma once

#include "core/trace/band.h"

NULLCONE_KERNEL_BEGIN

/// The details of some crossings, side by side.
template <class S>
struct Detailed {
  std::array<S, 4> duv{};
  Vec3<S> N{}, K{}, P{};
};

/// Which details a scene asks for. What is skipped stays zero.
struct Wanted {
  bool directions = false, duv = false;

  // Worked out at compile time: a table that code reads would be shared by instruction sets.
  static constexpr ChannelSet kDirections = ChannelSet::of("N") | ChannelSet::of("K") | ChannelSet::of("P"),
                              kChanges = ChannelSet::of("duv");

  Wanted() = default;
  explicit Wanted(ChannelSet channels)
      : directions((channels & kDirections).bits != 0), duv((channels & kChanges).bits != 0) {}
  bool any() const { return directions || duv; }
};

/// (Zeros are taken from: unary minus of zero has another sign in AVX-512.)
/// Two unit vectors at right angles to the unit vector n (Duff et al. 2017); e_x and e_y for n = e_z.
template <class S>
std::array<Vec3<S>, 2> across(const Vec3<S>& n) {
  const S zero(0.0), one(1.0), side = select(n[2] < S(0.0), -one, one), a = -(one / (side + n[2])),
                               b = n[0] * n[1] * a;
  return {Vec3<S>{{one + side * n[0] * n[0] * a, side * b, zero - side * n[0]}},
          Vec3<S>{{b, side + n[1] * n[1] * a, zero - n[1]}}};
}

/// The normal of a crossing in the object's frame, outwards.
template <class S, class Shape>
Vec3<S> normal_of(const Crossed<S>& c, const Shape& shape) {
  const Vec3<S> normal = surface_near(shape, c.here.X).normal(c.here.X);
  if constexpr (requires { shape.is_smooth(); })
    if (shape.is_smooth()) return normalised(shape.shading(c.here.X).normal(c.here.X) + c.lean * normal);
  return normal;
}

/// N and K. The object's frame vectors are d event/dX_i; where they are orthonormal in the surface's rest
/// frame (flat spacetime, the Goedel universe, small objects elsewhere), K is the photon's direction along
/// them. Where they are stretched, N stays the shape's own normal, K.N is the true cosine mu, and the part
/// of K in the tangent plane is measured in the orthonormal pair nearest to the frame's (h^-1/2 of its
/// metric h). So K is always of length 1, and K.N = mu to rounding.
template <class S, class Body, class Shape>
void find_directions(const Crossed<S>& c, const Body& body, const Shape& shape, Detailed<S>& out) {
  using D = Dual<S, 2>;
  const Vec3<S> normal = normal_of(c, shape);
  const auto [a, b] = across(normal);
  const auto X = Vec3<D>::map([&](std::size_t i) { return D(c.here.X[i], Vec<S, 2>{{a[i], b[i]}}); });
  const Vec4<D> event = body.event(D(c.here.tau), X);
  const auto A = Vec4<S>::map([&](std::size_t i) { return event[i].d[0]; }),
             B = Vec4<S>::map([&](std::size_t i) { return event[i].d[1]; });
  const Vec4<S> lower_A = c.g * A, lower_B = c.g * B;
  const S Au = dot(lower_A, c.u), Bu = dot(lower_B, c.u);
  const S aa = Au * Au - dot(lower_A, A), ab = Au * Bu - dot(lower_A, B), bb = Bu * Bu - dot(lower_B, B);
  const S over_frequency = S(1.0) / c.frequency;
  const S Ka = over_frequency * dot(lower_A, c.at.tangent) + Au,
          Kb = over_frequency * dot(lower_B, c.at.tangent) + Bu;

  // h^-1/2 of the 2 x 2 matrix h, by Cayley and Hamilton: sqrt(h) = (h + sqrt(det h)) / sqrt(tr h + 2
  // sqrt(det h)).
  const S root = sqrt(max(aa * bb - ab * ab, S(0.0))), p = aa + root, q = bb + root;
  const S scale = sqrt(p + q) / (p * q - ab * ab);
  out.N = select(c.rising > S(0.0), Vec3<S>{} - normal, normal);
  out.K = c.record.mu * out.N + (scale * (q * Ka - ab * Kb)) * a + (scale * (p * Kb - ab * Ka)) * b;
}

/// Changes of the event at the same lambda, a pixel to the right and a pixel down.
template <class S>
using EventChange = std::array<Vec4<S>, 2>;

/// Marks changes that broke down: infinite, which says that nothing is known.
template <class S>
std::array<S, 4> known(const std::array<S, 4>& duv) {
  const S nothing = (duv[0] - duv[0]) + (duv[1] - duv[1]) + (duv[2] - duv[2]) + (duv[3] - duv[3]);
  std::array<S, 4> out;
  for (std::size_t i = 0; i < 4; ++i)
    out[i] = select(nothing == S(0.0), duv[i], S(std::numeric_limits<double>::infinity()));
  return out;
}

/// Changes of (u, v), from those of the event: the neighbouring ray meets the surface a little sooner or
/// later, at another proper time of the object. Duals know no seam of u.
template <class S, class Body, class Shape>
std::array<S, 4> change_of_uv(const Crossed<S>& c, const Body& body, const Shape& shape,
                              const EventChange<S>& change) {
  using D = Dual<S, 4>;  // to the right, down, along the ray, proper time
  const auto x = Vec4<D>::map([&](std::size_t i) {
    return D(c.at.event[i], Vec<S, 4>{{change[0][i], change[1][i], c.at.tangent[i], S(0.0)}});
  });
  const std::pair<D, Vec3<D>> seen = body.local(x, D::variable(c.here.tau, 3));
  const auto surface = surface_near(shape, c.here.X);
  const D &late = seen.first, f = surface.value(seen.second);
  const Vec<D, 2> uv = surface.uv(seen.second);
  const S over = S(1.0) / (late.d[2] * f.d[3] - late.d[3] * f.d[2]);
  std::array<S, 4> out;
  for (std::size_t i = 0; i < 2; ++i) {
    const S along = over * (late.d[3] * f.d[i] - late.d[i] * f.d[3]);
    const S later = over * (late.d[i] * f.d[2] - late.d[2] * f.d[i]);
    for (std::size_t k = 0; k < 2; ++k) out[2 * i + k] = uv[k].d[i] + along * uv[k].d[2] + later * uv[k].d[3];
  }
  return known(out);
}

/// The details of the sky in a direction of any length, whose changes a pixel to the right and down are
/// given: light comes out of its surface straight at us.
inline HitDetail sky_detail(const Vec3<double>& direction, const std::array<Vec3<double>, 2>& change) {
  using D = Dual<double, 2>;
  HitDetail out;
  const Vec<D, 2> uv = Sphere::uv(Vec3<D>::map([&](std::size_t i) {
    return D(direction[i], Vec<double, 2>{{change[0][i], change[1][i]}});
  }));
  out.duv = known<double>({uv[0].d[0], uv[1].d[0], uv[0].d[1], uv[1].d[1]});
  const Vec3<double> n = normalised(direction);
  for (std::size_t i = 0; i < 3; ++i) {
    out.N[i] = out.K[i] = -n[i];
    out.P[i] = n[i] == 0 ? 0 : std::copysign(std::numeric_limits<double>::infinity(), n[i]);
  }
  return out;
}

/// Puts the details of a group of crossings at their places.
template <class S, class Group>
void scatter(const Detailed<S>& d, const Group& group, HitDetail* details) {
  for (std::size_t lane = 0; lane < group.filled; ++lane) {
    HitDetail& to = details[group.ray[lane]];
    for (std::size_t i = 0; i < 4; ++i) to.duv[i] = Lanes<S>::get(d.duv[i], lane);
    for (std::size_t i = 0; i < 3; ++i) {
      to.N[i] = Lanes<S>::get(d.N[i], lane);
      to.K[i] = Lanes<S>::get(d.K[i], lane);
      to.P[i] = Lanes<S>::get(d.P[i], lane);
    }
  }
}

NULLCONE_KERNEL_END
