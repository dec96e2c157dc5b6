#include "core/trace/follow.h"

#include <cmath>

#include "core/base/boost.h"
#include "core/base/error.h"
#include "core/trace/ground.h"

namespace nullcone {

using host::Tetrad;
using host::V4;
using host::Vec3;

Followed follow(const Spacetime& spacetime, std::span<const double> parameters, const Motion& motion,
                ObserverFrame frame, double tau, const std::string& place) {
  const auto traveller = set_out({spacetime, parameters}, motion, frame, place);
  traveller->go(tau);
  return traveller->now();
}

void settle_observer(const Spacetime& spacetime, std::span<const double> parameters, Scene& scene,
                     const std::string& place) {
  Observer& observer = scene.observer;
  if (!observer.moves) return;
  const Followed now = follow(spacetime, parameters, observer.motion, observer.frame, observer.proper_time,
                              place + ": /observer");
  const Ground ground{spacetime, parameters};
  const V4 x{now.event};
  const host::Matrix4<double> g = metric_at(ground, x);
  const Tetrad<double> tetrad = tetrad_at(ground, x, observer.frame);
  const auto local = [&](std::size_t i) { return host::local_components(g, tetrad, V4{now.axes[i]}); };
  const V4 u = local(0);
  if (!std::isfinite(u[0] + u[1] + u[2] + u[3]))
    throw InputError(place + ": /observer",
                     "comes to where no observer of this frame can be; near and in a black hole, try "
                     "\"frame\": \"normal\"");
  observer.event = now.event;
  for (std::size_t i = 0; i < 3; ++i) observer.velocity[i] = u[i + 1] / u[0];
  std::array<Vec3<double>, 3> axes;  // among those that the boost along u makes
  for (std::size_t i = 0; i < 3; ++i) axes[i] = host::spatial(host::boost(u, local(i + 1)));
  for (Triple* direction : {&scene.camera.forward, &scene.camera.left, &scene.camera.up}) {
    const Vec3<double> d{*direction};
    *direction = (d[0] * axes[0] + d[1] * axes[1] + d[2] * axes[2]).c;
  }
  observer.moves = false;
}

}  // namespace nullcone
