#include "apps/geodesic_ray.h"

#include <cmath>

#include "core/base/error.h"
#include "core/trace/metric.h"

namespace nullcone {

std::vector<GeodesicPoint> Ray::at(std::span<const double> lambda) const {
  return spacetime->geodesic(parameters, event, k, lambda, accuracy ? &*accuracy : nullptr, frame);
}

std::vector<NamedValue> Ray::conserved(const GeodesicPoint& point) const {
  return spacetime->conserved(parameters, point);
}

double Ray::square(const GeodesicPoint& point) const {
  const auto g = spacetime->metric(parameters, point.event);
  double out = 0;
  for (std::size_t m = 0; m < 4; ++m)
    for (std::size_t n = 0; n < 4; ++n) out += g[m][n] * point.tangent[m] * point.tangent[n];
  return out;
}

std::string status_word(const GeodesicPoint& point) {
  if (point.status != Status::hit) return std::string(kStatusNames[static_cast<std::size_t>(point.status)]);
  for (std::size_t i = 0; i < 4; ++i)
    if (!std::isfinite(point.event[i]) || !std::isfinite(point.tangent[i])) return "not_finite";
  return "ok";
}

Event in_static_tetrad(const Spacetime& spacetime, std::span<const double> parameters, const Event& event,
                       const Event& vector) {
  const auto axes = spacetime.static_tetrad(parameters, event);
  host::Matrix4<double> columns;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t a = 0; a < 4; ++a) columns[i][a] = axes[a][i];
  return host::solve(columns, host::Vec4<double>{vector}).c;
}

void check_tetrad(const Spacetime& spacetime, std::span<const double> parameters, const Event& event,
                  const std::string& place) {
  for (const Event& axis : spacetime.static_tetrad(parameters, event))
    for (const double component : axis)
      if (!std::isfinite(component))
        throw InputError(place, "no observer is at rest there, so directions have no meaning");
}

std::vector<double> evenly_spaced(double from, double to, int count) {
  std::vector<double> out(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double part = static_cast<double>(i) / (count - 1);
    out[static_cast<std::size_t>(i)] = (1 - part) * from + part * to;
  }
  return out;
}

}  // namespace nullcone
