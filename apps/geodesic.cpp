// nullcone-geodesic: one light ray or falling particle, by numbers.
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/tool.h"
#include "core/base/error.h"
#include "metrics/registry.h"

namespace {

using namespace nullcone;
using json = nlohmann::ordered_json;

/// Values of a metric's parameters, defaults overridden by "key=value".
std::vector<double> parameter_values(const MetricDescription& metric,
                                     const std::vector<std::string>& settings) {
  std::vector<double> values;
  for (const MetricParameter& p : metric.parameters) values.push_back(p.fallback);
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    const std::string key = setting.substr(0, equals);
    std::size_t i = 0, used = 0;
    while (i < metric.parameters.size() && metric.parameters[i].name != key) ++i;
    if (equals == std::string::npos || i == metric.parameters.size())
      throw InputError("--set " + setting,
                       "expected key=value with a parameter of " + std::string(metric.name));
    const std::string text = setting.substr(equals + 1);
    try {
      values[i] = std::stod(text, &used);
    } catch (const std::exception&) {
      used = 0;
    }
    const MetricParameter& p = metric.parameters[i];
    if (used != text.size() || text.empty() || !(values[i] >= p.least && values[i] <= p.most)) {
      throw InputError("--set " + setting,
                       "expected a number from " + json(p.least).dump() + " to " + json(p.most).dump());
    }
  }
  return values;
}

/// "1,-2,.5": finite numbers with single commas between them; `count` of them, or any number where it is 0.
std::vector<double> numbers(const std::string& option, const std::string& text, std::size_t count = 0) {
  std::vector<double> out;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(',', from), text.size());
    const std::string one = text.substr(from, to - from);
    char* end = nullptr;
    out.push_back(std::strtod(one.c_str(), &end));
    if (one.empty() || *end != '\0' || !std::isfinite(out.back()))
      throw InputError(option, "expected finite numbers with single commas between them, found '" +
                                   printable(one, 40) + "'");
    from = to + 1;
  }
  if (count != 0 && out.size() != count)
    throw InputError(option,
                     "expected " + std::to_string(count) + " numbers, found " + std::to_string(out.size()));
  return out;
}

/// Components in the static tetrad: a photon of frequency 1, or gamma (1, speed n) over gamma, so that lambda
/// = gamma tau.
Event tangent_in_tetrad(std::vector<double> n, double speed) {
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  if (!(std::fabs(length - 1) < 1e-6))
    throw InputError("--direction", "expected a unit vector; its length is " + std::to_string(length));
  for (double& component : n) component *= speed / length;
  return {1, n[0], n[1], n[2]};
}

json point_entry(const GeodesicPoint& point) {
  bool finite = true;
  for (std::size_t i = 0; i < 4; ++i)
    finite = finite && std::isfinite(point.event[i]) && std::isfinite(point.tangent[i]);
  return {{"lambda", point.lambda},
          {"event", point.event},
          {"tangent", point.tangent},
          {"status", finite ? "ok" : "not_finite"}};
}

void print_table(const std::vector<GeodesicPoint>& points) {
  std::cout << "lambda\tt\tx\ty\tz\n";
  std::cout.precision(15);
  for (const GeodesicPoint& p : points)
    std::cout << p.lambda << '\t' << p.event[0] << '\t' << p.event[1] << '\t' << p.event[2] << '\t'
              << p.event[3] << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Follows one geodesic, null or timelike, through a spacetime.", "nullcone-geodesic");
  std::string name, paths = "closed";
  std::vector<std::string> settings;
  std::string event_text, direction_text, at_text;
  double speed = 1;
  bool as_json = false;
  ToolOptions options;
  app.add_option("--metric", name, "Spacetime")->required();
  app.add_option("--set", settings, "Parameter of the spacetime, key=value")->allow_extra_args(false);
  app.add_option("--event", event_text, "Where it passes: t,x,y,z")->required();
  app.add_option("--direction", direction_text,
                 "Unit spatial direction n1,n2,n3 in the static tetrad, future-directed")
      ->required();
  const auto* has_speed =
      app.add_option("--speed", speed, "Local speed of a particle (below 1); without it, light");
  app.add_option("--paths", paths, "How the path is found")->check(CLI::IsMember({"closed"}));
  app.add_option("--at", at_text, "Affine parameters l1,l2,... (negative: the past)")->required();
  app.add_flag("--json", as_json, "Report as JSON");
  add_common_options(app, options);

  return run_tool(app, argc, argv, [&] {
    const Spacetime& spacetime = find_spacetime(name);
    const std::vector<double> values = parameter_values(spacetime.description(), settings);
    const std::vector<double> event = numbers("--event", event_text, 4), at = numbers("--at", at_text);
    const std::vector<double> direction = numbers("--direction", direction_text, 3);
    if (*has_speed && !(speed >= 0 && speed < 1))
      throw InputError("--speed", "expected a number from 0 to below 1");
    const Event k = tangent_in_tetrad(direction, speed), start = {event[0], event[1], event[2], event[3]};
    const auto points = spacetime.geodesic(values, start, k, at);
    if (!as_json) return print_table(points), 0;
    json report = {{"metric", name}, {"points", json::array()}, {"conserved", json::object()}};
    for (const GeodesicPoint& point : points) report["points"].push_back(point_entry(point));
    const double here = 0;
    for (const auto& [key, value] :
         spacetime.conserved(values, spacetime.geodesic(values, start, k, {&here, 1})[0]))
      report["conserved"][std::string(key)] = value;
    std::cout << report.dump(2) << '\n';
    return 0;
  });
}
