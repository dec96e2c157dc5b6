// Vectors of one spacetime, outside of kernels.
#pragma once

#include "core/trace/metric.h"
#include "core/trace/travel.h"

NULLCONE_KERNEL_BEGIN

using V4 = Vec4<double>;

inline Matrix4<double> metric_at(const Ground& ground, const V4& x) {
  const auto rows = ground.spacetime.metric(ground.parameters, x.c);
  return {V4{rows[0]}, V4{rows[1]}, V4{rows[2]}, V4{rows[3]}};
}
inline double inner(const Ground& ground, const V4& x, const V4& a, const V4& b) {
  return inner(metric_at(ground, x), a, b);
}
/// Gamma^mu_ab u^a v^b.
inline V4 connection(const Ground& ground, const V4& x, const V4& u, const V4& v) {
  return V4{ground.spacetime.connection(ground.parameters, x.c, u.c, v.c)};
}
inline Tetrad<double> tetrad_at(const Ground& ground, const V4& x, ObserverFrame frame) {
  const auto axes = ground.spacetime.observer_tetrad(ground.parameters, x.c, frame);
  return {{V4{axes[0]}, V4{axes[1]}, V4{axes[2]}, V4{axes[3]}}};
}

NULLCONE_KERNEL_END
