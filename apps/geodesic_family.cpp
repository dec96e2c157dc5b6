// Geodesics by numbers: one, a fan of directions, or one carried along a Killing field.
#include <cmath>
#include <numbers>

#include "apps/geodesic_inquiry.h"
#include "apps/geodesic_killing.h"
#include "apps/metric_options.h"
#include "core/base/error.h"
#include "core/trace/metric.h"
#include "metrics/registry.h"

namespace nullcone {

namespace {

using Direction = host::Vec3<double>;
using host::cross, host::dot, host::norm;

/// A direction of any length but zero; `unit` asks for length 1.
Direction direction_of(const std::string& option, const std::string& text, bool unit) {
  const std::vector<double> n = numbers(option, text, 3);
  const Direction out = {{n[0], n[1], n[2]}};
  const double length = norm(out);
  if (unit && !(std::fabs(length - 1) < 1e-6))
    throw InputError(option, "expected a unit vector; its length is " + std::to_string(length));
  if (!(length > 1e-100 && std::isfinite(length)))
    throw InputError(option, "expected a direction; its length is " + std::to_string(length));
  return (1 / length) * out;
}

double speed_of(const GeodesicOptions& options) {
  if (options.speed.empty()) return 1;
  const double speed = numbers("--speed", options.speed, 1)[0];
  if (!(speed >= 0 && speed < 1)) throw InputError("--speed", "expected a number from 0 to below 1");
  return speed;
}

/// Components in the static tetrad: a photon of frequency 1, or gamma (1, speed n) over gamma, so that lambda
/// = gamma tau.
Event tangent_in_tetrad(const Direction& n, double speed) {
  return {1, speed * n[0], speed * n[1], speed * n[2]};
}

/// The second axis of a fan's plane, at right angles to the first.
Direction second_axis(const GeodesicOptions& options, const Direction& first) {
  const Direction e3 = {{0, 0, 1}};
  const Direction wish =
      options.plane.empty() ? cross(e3, first) : direction_of("--plane", options.plane, false);
  const Direction out = wish - dot(wish, first) * first;
  if (!(norm(out) > 1e-9))
    throw InputError("--plane", options.plane.empty()
                                    ? "is required where --direction stands along e3"
                                    : "expected a direction that is not parallel to --direction");
  return (1 / norm(out)) * out;
}

void spread_fan(const GeodesicOptions& options, const Direction& first, double speed, Inquiry& inquiry) {
  const Direction second = second_axis(options, first);
  const Ray ray = inquiry.members[0].ray;
  inquiry.members.clear();
  inquiry.parameter_name = "angle_deg";
  for (int i = 0; i < options.fan; ++i) {
    const double degrees = 360.0 * i / options.fan, angle = degrees * std::numbers::pi / 180;
    inquiry.members.push_back({degrees, ray});
    inquiry.members.back().ray.k =
        tangent_in_tetrad(std::cos(angle) * first + std::sin(angle) * second, speed);
  }
  inquiry.title += ": a fan of " + std::to_string(options.fan);
}

void carry_along(const GeodesicOptions& options, Inquiry& inquiry) {
  const std::vector<double> etas = numbers("--eta", options.eta);
  const Ray ray = inquiry.members[0].ray;
  const KillingField field(*inquiry.spacetime, inquiry.parameters, options.killing, ray.event);
  inquiry.members.clear();
  inquiry.parameter_name = "eta";
  for (const double eta : etas) {
    const auto carried = field.carry({ray.event, ray.at(0.0).tangent}, eta);
    inquiry.members.push_back({eta, ray});
    Ray& member = inquiry.members.back().ray;
    member.event = carried.event;
    member.k = in_static_tetrad(*inquiry.spacetime, inquiry.parameters, carried.event, carried.vector);
  }
  inquiry.title += ", carried along " + options.killing;
}

/// Which affine parameters are reported, and which stretch a picture shows.
void choose_lambda(const GeodesicOptions& options, Inquiry& inquiry) {
  inquiry.lambda = numbers("--at", options.at);
  const auto [least, greatest] = std::minmax_element(inquiry.lambda.begin(), inquiry.lambda.end());
  inquiry.plot_from = *least, inquiry.plot_to = *greatest;
  if (*least == *greatest) (*least < 0 ? inquiry.plot_to : inquiry.plot_from) = 0;
  if (options.points == 0) return;
  if (*least == *greatest) throw InputError("--points", "needs at least two values of --at to stand between");
  inquiry.lambda = evenly_spaced(*least, *greatest, options.points);
}

}  // namespace

Inquiry inquire_by_numbers(const GeodesicOptions& options) {
  const Spacetime& spacetime = find_spacetime(options.metric);
  const MetricDescription metric = spacetime.description();
  Inquiry out{};
  out.spacetime = &spacetime;
  out.parameters = parameter_values(metric, options.settings);
  const std::vector<double> event = numbers("--event", options.event, 4);
  const Direction direction = direction_of("--direction", options.direction, true);
  const double speed = speed_of(options);
  choose_lambda(options, out);
  const Accuracy accuracy = accuracy_of(options, kBalanced);
  Ray ray{&spacetime,
          out.parameters,
          {event[0], event[1], event[2], event[3]},
          tangent_in_tetrad(direction, speed),
          {}};
  if (integrates(options, metric, !metric.closed_paths)) ray.accuracy = accuracy;
  check_tetrad(spacetime, out.parameters, ray.event, "--event");
  out.members.push_back({0, ray});
  out.title = speed < 1 ? "Falling particle" : "Light";
  if (options.fan != 0) spread_fan(options, direction, speed, out);
  if (!options.killing.empty()) carry_along(options, out);
  return out;
}

}  // namespace nullcone
