// The kernel of one spacetime: camera ray -> path -> crossings -> records, a band of pixels at a time.
#pragma once

#include <variant>

#include "core/base/boost.h"
#include "core/base/status.h"
#include "core/trace/crossing.h"
#include "core/trace/spacetime.h"

NULLCONE_KERNEL_BEGIN

/// An object made ready: as the search sees it, and as the record sees it.
template <class Placing, class Body, class Shape>
struct Placed {
  Placing placing;
  Body body;
  Shape shape;
};
template <class M>
using AnyPlaced =
    std::variant<Placed<RestPlacing<M>, LocalBody<M>, Sphere>, Placed<RestPlacing<M>, LocalBody<M>, Quad>,
                 Placed<RestPlacing<M>, ChartBody<M>, Sphere>, Placed<RestPlacing<M>, ChartBody<M>, Quad>,
                 Placed<MovingPlacing<M>, LocalBody<M>, Sphere>,
                 Placed<MovingPlacing<M>, LocalBody<M>, Quad>>;

/// The rays of a band, and the nearest crossing found so far; structure of arrays, padded to whole packs.
struct BandRays {
  std::size_t count = 0, padded = 0;
  std::unique_ptr<double[]> memory;
  std::array<double*, 4> k{};  ///< past-directed tangent in the static tetrad
  double *limit = nullptr, *steps = nullptr;
  std::unique_ptr<std::uint32_t[]> nearest;  ///< object number from 1, 0 for none
  std::unique_ptr<bool[]> doubtful;

  explicit BandRays(std::size_t rays)
      : count(rays),
        padded((rays + 7) / 8 * 8),
        memory(new double[6 * padded]),
        nearest(new std::uint32_t[padded]()),
        doubtful(new bool[padded]()) {
    for (std::size_t i = 0; i < 4; ++i) k[i] = memory.get() + i * padded;
    limit = memory.get() + 4 * padded;
    steps = memory.get() + 5 * padded;
  }
};

/// Camera rays of a band: the photon that arrives at each pixel, followed into the past.
template <class S>
void aim(const Camera& camera, const Vec4<double>& u_camera, int first_line, double lookback,
         BandRays& rays) {
  const Vec4<S> u = convert<S>(u_camera);
  const auto width = static_cast<std::size_t>(camera.width);
  for (std::size_t i = 0; i < rays.padded; i += Lanes<S>::count) {
    std::array<double, Lanes<S>::count> x{}, y{};
    for (std::size_t lane = 0; lane < x.size(); ++lane) {
      const std::size_t pixel = std::min(i + lane, rays.count - 1);
      x[lane] = static_cast<double>(pixel % width) + 0.5;
      y[lane] = first_line + static_cast<double>(pixel / width) + 0.5;
    }
    const Vec3<S> look = look_direction(camera, Lanes<S>::load(x.data()), Lanes<S>::load(y.data()));
    const Vec4<S> past = -seen_photon(u, look);
    for (std::size_t c = 0; c < 4; ++c) Lanes<S>::store(past[c], rays.k[c] + i);
    Lanes<S>::store(S(lookback), rays.limit + i);
    Lanes<S>::store(S(0.0), rays.steps + i);
  }
}

/// Finds where the rays meet one object, and keeps what is nearer than anything before.
template <class S, class Placing, class Body, class Shape>
void search(const Placed<Placing, Body, Shape>& object, std::uint32_t number, const Vec4<double>& event,
            double resolution, BandRays& rays) {
  for (std::size_t i = 0; i < rays.padded; i += Lanes<S>::count) {
    RayStart<S> start{event, {}};
    for (std::size_t c = 0; c < 4; ++c) start.k[c] = Lanes<S>::load(rays.k[c] + i);
    const S limit = Lanes<S>::load(rays.limit + i);
    const Crossing<S> found = first_crossing(object.placing.ray(start), object.shape, limit, S(resolution));
    Lanes<S>::store(Lanes<S>::load(rays.steps + i) + found.steps, rays.steps + i);
    Lanes<S>::store(select(found.met, found.lambda, limit), rays.limit + i);
    std::array<bool, Lanes<S>::count> met{}, given_up{};
    Lanes<S>::store(found.met, met.data());
    Lanes<S>::store(found.given_up, given_up.data());
    for (std::size_t lane = 0; lane < met.size(); ++lane) {
      if (met[lane]) rays.nearest[i + lane] = number;
      rays.doubtful[i + lane] |= given_up[lane];
    }
  }
}

/// Everything a record says about one crossing.
template <Metric M, class Placing, class Body, class Shape>
HitRecord record(const M& metric, const Placed<Placing, Body, Shape>& object, const Vec4<double>& observation,
                 const Vec4<double>& past, double lambda, double tau_origin) {
  const auto path = metric.path(observation, past);
  const Meeting here = polish(path, object.body, object.shape, lambda);
  const PathPoint<double> P = path.at(lambda);
  const Matrix4<double> g = metric.g(P.event);

  // The surface's 4-velocity: d/dtau at a fixed point of the object.
  using D = Dual<double, 1>;
  const Vec4<D> moving = object.body.event(D::variable(here.tau, 0), convert<D>(here.X));
  Vec4<double> u = Vec4<double>::map([&](std::size_t i) { return moving[i].d[0]; });
  u = (1 / sqrt(inner(g, u, u))) * u;
  const double frequency = -inner(g, P.tangent, u);

  // The emission angle: between the photon and the unit normal, on the side to which the photon leaves.
  const double steepness = sqrt(-dot(here.gradient, solve(g, here.gradient)));
  const double mu = std::fabs(dot(here.gradient, P.tangent)) / (frequency * steepness);
  const auto [tex_u, tex_v] = object.shape.uv(here.X);
  const double n_z = past[3] / past[0];
  return {0,
          0,
          metric.caustics(-past[0] * lambda, n_z),
          lambda,
          tex_u,
          tex_v,
          1 / frequency,
          P.event[0] - observation[0],
          here.tau - tau_origin,
          std::fmin(mu, 1.0)};
}

NULLCONE_KERNEL_END
