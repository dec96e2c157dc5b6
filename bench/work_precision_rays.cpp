#include "bench/work_precision_rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/trace/integrate.h"
#include "metrics/goedel.h"
#include "metrics/kerr_schild.h"
#include "metrics/minkowski.h"

namespace nullcone::study {

using namespace host;

namespace {

template <class F>
auto with_metric(const Place& place, F&& f) {
  if (place.metric == MetricId::minkowski) return f(Minkowski{});
  if (place.metric == MetricId::goedel) return f(Goedel{place.parameter});
  KerrSchild hole;
  hole.spin = place.parameter;
  return f(hole);
}

/// A photon that arrives from direction m (static tetrad), run into the past, as Hamilton's equations have
/// it.
Start past_ray(const Place& place, const Vec4<double>& event, const Vec3<double>& m) {
  return with_metric(place, [&](const auto& metric) {
    const Tetrad<double> tetrad = static_tetrad(metric, event);
    const Vec4<double> k = tetrad.to_chart({{-1, m[0], m[1], m[2]}});
    return Start{to_state(Phase<double>{event, metric.g(event) * k}).c};
  });
}

/// By the long double code of the stepper and the controller that are studied, at a tolerance that they
/// cannot reach in double.
template <Metric M>
bool follow_in(const M& metric, const Start& start, long double length, Numbers& out) {
  using L = long double;
  PrinceDormand87<L> stepper;
  const HamiltonSystem<M> system{metric};
  const Accuracy accuracy{1e-18, 0, Integrator::prince_dormand87};
  Flight<L> flight;
  for (std::size_t c = 0; c < 8; ++c) flight.y[c] = start.y[c];
  flight.dy = system.rate(flight.y);
  flight.h = 1e-3L * length_scale(metric, to_phase(flight.y).x);
  for (int attempts = 0; flight.lambda < length; ++attempts) {
    const L rest = length - flight.lambda;
    const bool last = rest <= flight.h;
    const auto a = attempt(stepper, system, accuracy, flight, last ? rest : flight.h);
    flight.h = a.h * a.factor;
    if (!a.accepted) continue;
    flight.y = a.y1, flight.dy = a.dy1;
    flight.lambda = last ? length : flight.lambda + a.h;
    const Phase<L> at = to_phase(flight.y), rate = to_phase(flight.dy);
    const L end = ending(metric, at, rate, 1e-9);
    if (attempts > 100000 || (end > 0 && end < as_scalar<L>(Ending::sky))) return false;
  }
  out = flight.y.c;
  return true;
}

Numbers goedel_end(const Place& place, const Start& start) {
  using L = long double;
  const Goedel metric{place.parameter};
  Vec4<L> x, p;
  for (std::size_t i = 0; i < 4; ++i) x[i] = start.y[i], p[i] = start.y[4 + i];
  const Vec4<L> k = host::inverse(metric.g(x)) * p;  // at the origin the tetrad is that of the chart
  const auto there = metric.path(x, k).at(static_cast<L>(place.length));
  return to_state(Phase<L>{there.event, metric.g(there.event) * there.tangent}).c;
}

/// Azimuth that a ray sweeps from radius r_a (inwards, impact parameter b) to r_b, spin 0, in the x-y plane.
double swept_azimuth(double b, double r_a, double r_b) {
  const Place place{"", MetricId::kerr_schild, 0, r_a, 0};
  const double sine = b * std::sqrt(1 - 2 / r_a) / r_a, cosine = std::sqrt(1 - sine * sine);
  const Start start = past_ray(place, {{0, r_a, 0, 0}}, {{-cosine, sine, 0}});
  long double length = r_a + r_b;
  Numbers y{};
  for (int i = 0; i < 60; ++i) {  // to where r = r_b: Newton's method with dr/dlambda of order 1
    follow(place, start, length, y);
    const long double r = std::hypot(y[1], y[2]);
    length -= (r - r_b) / std::sqrt(1 - (1 - 2 / r) * b * b / (r * r));
    if (std::fabs(r - r_b) < 1e-15L * r_b) break;
  }
  const auto angle = static_cast<double>(std::atan2(y[2], y[1]));
  return angle < 0 ? angle + 2 * std::numbers::pi : angle;
}

}  // namespace

bool follow(const Place& place, const Start& start, long double length, Numbers& end) {
  return with_metric(place, [&](const auto& metric) { return follow_in(metric, start, length, end); });
}

double error_of(const std::array<double, 8>& y, const Numbers& truth, double scale) {
  long double x = 0, p = 0, largest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    x = std::max(x, std::fabs(y[i] - truth[i]));
    p = std::max(p, std::fabs(y[4 + i] - truth[4 + i]));
    largest = std::max(largest, std::fabs(truth[4 + i]));
  }
  return static_cast<double>(std::max(x / scale, p / largest));
}

Start screen_ray(const Place& place, double X, double Y) {
  const double theta = 80 * std::numbers::pi / 180, c = std::cos(theta), s = std::sin(theta);
  const double r = place.radius, to_angle = 1 / r;  // of the direction's tangent
  const Vec3<double> forward = {{-s, 0, -c}}, right = {{0, 1, 0}}, up = {{-c, 0, s}};
  const Vec3<double> m = normalised(forward + (X * to_angle) * right + (Y * to_angle) * up);
  return past_ray(place, {{0, r * s, 0, r * c}}, m);
}

std::vector<Start> screen(const Place& place, std::size_t n, double half_width) {
  std::vector<Start> out;
  if (place.radius == 0) {
    const auto count = static_cast<double>(n * n);
    for (std::size_t i = 0; i < n * n; ++i) {  // a spiral of equal areas
      const double z = (2 * static_cast<double>(i) + 1) / count - 1, rho = std::sqrt(1 - z * z);
      const double angle = static_cast<double>(i) * std::numbers::pi * (3 - std::sqrt(5.0));
      out.push_back(past_ray(place, {}, {{rho * std::cos(angle), rho * std::sin(angle), z}}));
    }
    return out;
  }
  for (const auto& [X, Y] : screen_points(n, half_width)) out.push_back(screen_ray(place, X, Y));
  return out;
}

double length_scale_at(const Place& place, const Numbers& y) {
  const Vec4<double> x{{static_cast<double>(y[0]), static_cast<double>(y[1]), static_cast<double>(y[2]),
                        static_cast<double>(y[3])}};
  return with_metric(place, [&](const auto& metric) { return length_scale(metric, x); });
}

bool true_end(const Place& place, const Start& start, Numbers& end) {
  if (place.metric == MetricId::goedel) return end = goedel_end(place, start), true;
  if (place.metric == MetricId::kerr_schild) return follow(place, start, place.length, end);
  for (std::size_t i = 0; i < 4; ++i) {
    end[4 + i] = start.y[4 + i];
    end[i] = start.y[i] + (i == 0 ? 1.0L : -1.0L) * start.y[4 + i] * place.length;
  }
  return true;
}

std::vector<std::array<double, 2>> screen_points(std::size_t n, double half_width) {
  std::vector<std::array<double, 2>> out;
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) {
      const auto at = [&](std::size_t k) {
        return half_width * ((2 * static_cast<double>(k) + 1) / static_cast<double>(n) - 1);
      };
      out.push_back({at(i), at(j)});
    }
  return out;
}

double check_azimuths() {
  // Carlson's elliptic integrals, tests/data/reference_cases.json: schw.traveltime.1 and .3
  return std::max(std::fabs(swept_azimuth(6, 20, 30) - 4.355368863131607),
                  std::fabs(swept_azimuth(15, 100, 50) - 3.022854102310727));
}

double refused_share(const Place& place, const Accuracy& accuracy, const std::vector<Start>& start) {
  double attempts = 0, refused = 0;
  with_metric(place, [&](const auto& metric) {
    const HamiltonSystem<std::remove_cvref_t<decltype(metric)>> system{metric};
    return with_stepper<double>(accuracy.integrator, [&](auto& stepper) {
      using Stepper = std::remove_cvref_t<decltype(stepper)>;
      for (const Start& ray : start) {
        Flight<double> flight;
        flight.y.c = ray.y;
        flight.dy = system.rate(flight.y);
        flight.h = first_step<Stepper::kRoots>(metric, flight.y, flight.dy, accuracy.rtol);
        double end = 0;
        for (int i = 0; i < 20000 && flight.lambda < place.length; ++i) {
          if (end != 0 && end < as_scalar<double>(Ending::sky)) break;
          const auto a = attempt(stepper, system, accuracy, flight,
                                 next_step(metric, flight, place.length - flight.lambda));
          learn(flight, a, true);
          attempts += 1;
          refused += !a.accepted;
          if (!a.accepted) continue;
          flight.y = a.y1, flight.dy = a.dy1, flight.lambda += a.h;
          end = ending(metric, to_phase(flight.y), to_phase(flight.dy), accuracy.rtol);
        }
      }
      return 0;
    });
  });
  return refused / attempts;
}

}  // namespace nullcone::study
