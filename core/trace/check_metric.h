// Is a spacetime what it claims to be? All that a metric may offer (core/trace/metric.h), held against g
// alone.
#pragma once

#include "core/trace/check_equations.h"

NULLCONE_KERNEL_BEGIN

/// Closed-form paths against Runge-Kutta integration, and the static tetrad's components that they hand out.
template <Metric M>
void check_path(const M& metric, const std::vector<Sample>& samples, Checks& out) {
  if constexpr (HasClosedPaths<M>) {
    Worst worst("closed paths against integration", 1e-6);
    for (const Sample& s : samples) {
      if (!s.is_static) continue;
      double length = 0;
      Phase<double> at = s.at;
      if (!follow(metric, at, length)) continue;
      worst.count();
      const auto end = metric.path(s.at.x, s.local).at(length);
      const auto tangent = rhs(metric, at.x, at.p).x,
                 local = static_tetrad(metric, end.event).to_chart(end.local);
      for (std::size_t i = 0; i < 4; ++i) {
        worst.compare(end.event[i], at.x[i], length * largest(s.tangent), s.at.x,
                      [&] { return coordinate(i); });
        worst.compare(end.tangent[i], tangent[i], largest(s.tangent), s.at.x,
                      [&] { return "tangent, " + coordinate(i); });
        worst.compare(local[i], tangent[i], largest(s.tangent), s.at.x,
                      [&] { return "tangent by tetrad components, " + coordinate(i); });
      }
    }
    out.push_back(worst.result());
  }
}

/// The isometry of an event P: it keeps g, carries P to the origin, and from_origin undoes it.
template <Metric M>
void check_isometry(const M& metric, const std::vector<Sample>& samples, Checks& out) {
  if constexpr (HasIsometry<M>) {
    using D = Dual<double, 4>;
    Worst kept("the isometry keeps g", 1e-10), undone("the isometry and its inverse", 1e-10);
    for (std::size_t n = 0; n + 1 < samples.size(); n += 2) {
      const Vec4<double> x = samples[n].at.x, P = samples[n + 1].at.x;
      kept.count(), undone.count();
      const auto y =
          metric.to_origin(convert<D>(P), Vec4<D>::map([&](std::size_t i) { return D::variable(x[i], i); }));
      const Vec4<double> image = Vec4<double>::map([&](std::size_t i) { return y[i].v; });
      const Matrix4<double> there = metric.g(image), here = metric.g(x);
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) {
          double pulled_back = 0, scale = 0;
          for (std::size_t k = 0; k < 4; ++k)
            for (std::size_t l = 0; l < 4; ++l) {
              const double term = there[k][l] * y[k].d[i] * y[l].d[j];
              pulled_back += term, scale += std::fabs(term);
            }
          kept.compare(pulled_back, here[i][j], scale, x, [&] { return component("g_", i, j); });
        }
      const Vec4<double> back = metric.from_origin(P, image), origin = metric.to_origin(P, P);
      const double scale = largest(x) + largest(P) + largest(image);
      for (std::size_t i = 0; i < 4; ++i) {
        undone.compare(back[i], x[i], scale, x, [&] { return coordinate(i) + " after both"; });
        undone.compare(origin[i], 0, scale, P, [&] { return coordinate(i) + " of P at the origin"; });
      }
    }
    for (const Worst* w : {&kept, &undone}) out.push_back(w->result());
  }
}

/// The observer at rest is timelike, and the axes of the static tetrad are orthonormal.
template <Metric M>
void check_tetrad(const M& metric, const std::vector<Sample>& samples, Checks& out) {
  Worst worst("static tetrad is orthonormal", 1e-11);
  for (const Sample& s : samples) {
    if (!s.is_static) continue;
    worst.count();
    const auto tetrad = static_tetrad(metric, s.at.x);
    const Matrix4<double> g = metric.g(s.at.x);
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i; j < 4; ++j) {
        double scale = 0;
        for (std::size_t k = 0; k < 4; ++k)
          for (std::size_t l = 0; l < 4; ++l) scale += std::fabs(tetrad.e[i][k] * g[k][l] * tetrad.e[j][l]);
        const double expected = i != j ? 0 : i == 0 ? 1 : -1;
        worst.compare(inner(g, tetrad.e[i], tetrad.e[j]), expected, scale, s.at.x,
                      [&] { return "e" + std::to_string(i) + ".e" + std::to_string(j); });
      }
  }
  out.push_back(worst.result());
}

/// A sky needs an infinity: a million lengths from the origin, g is flat but for a few millionths.
template <Metric M>
void check_flatness(const M& metric, Sampler<M>& sampler, int events, Checks& out) {
  if constexpr (skies_of<M>() > 0) {
    Worst worst("flat far out, where the sky is", 1e-4);
    for (int n = 0; n < events; ++n) {
      Vec4<double> x = sampler.event();
      const double stretch = 1e6 * sampler.length() / norm(spatial(x));
      for (std::size_t i = 1; i < 4; ++i) x[i] *= stretch;
      worst.count();
      const Matrix4<double> g = metric.g(x);
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
          worst.compare(g[i][j], i != j ? 0 : i == 0 ? 1 : -1, 1, x, [&] { return component("g_", i, j); });
    }
    out.push_back(worst.result());
  }
}

/// What errors are measured against must not vanish, nor break down.
template <Metric M>
void check_length_scale(const M& metric, const std::vector<Sample>& samples, Checks& out) {
  Worst worst("length scale is positive", 0);
  for (const Sample& s : samples) {
    worst.count();
    const double length = length_scale(metric, s.at.x);
    worst.compare(length > 0 && std::isfinite(length) ? 1 : 0, 1, 1, s.at.x,
                  [&] { return "length scale " + std::to_string(length) + ", positive and finite"; });
  }
  out.push_back(worst.result());
}

/// The other checks mean little where hardly any event has an observer and a ray that goes on.
inline CheckResult covered(std::size_t samples, std::size_t events) {
  const double missing = 1 - static_cast<double>(samples) / static_cast<double>(events);
  return {"events that the chart covers: share missing", missing, 0.75, events,
          std::to_string(samples) + " rays found, " + std::to_string(events) + " wanted"};
}

/// All checks, in the order in which a mistake should be looked for.
template <Metric M>
Checks check_metric(const M& metric, const CheckOptions& options) {
  Sampler<M> sampler(metric, options.seed);
  std::vector<Vec4<double>> events;
  std::vector<Sample> samples;
  events.reserve(static_cast<std::size_t>(options.events));
  for (int n = 0; n < options.events; ++n) events.push_back(sampler.event());
  for (int n = 0; n < 4 * options.events && samples.size() < events.size(); ++n) {
    Sample s;
    if (sampler.sample(s)) samples.push_back(s);
  }
  Checks out{covered(samples.size(), events.size())};
  check_components(metric, events, out);
  check_derivatives(metric, events, out);
  check_tetrad(metric, samples, out);
  check_rhs(metric, samples, out);
  check_brackets(metric, samples, out);
  check_along_rays(metric, samples, out);
  check_path(metric, samples, out);
  check_isometry(metric, samples, out);
  check_flatness(metric, sampler, options.events, out);
  check_length_scale(metric, samples, out);
  return out;
}

NULLCONE_KERNEL_END
