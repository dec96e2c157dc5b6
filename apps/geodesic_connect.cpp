#include "apps/geodesic_connect.h"

#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>

#include "apps/geodesic_ray.h"
#include "apps/metric_options.h"
#include "core/base/error.h"
#include "metrics/registry.h"

namespace nullcone {

namespace {

using json = nlohmann::ordered_json;

/// Plus 0: no minus sign before a zero.
json entry(const ConnectionReport& c) {
  return {{"lambda", c.lambda},
          {"travel_time", c.travel_time + 0.0},
          {"view", {c.view[0] + 0.0, c.view[1] + 0.0, c.view[2] + 0.0}},
          {"area_distance", c.area_distance},
          {"parity", c.parity},
          {"winding", c.winding}};
}

void write_json(const ConnectionsReport& report, std::ostream& out) {
  json whole = {{"connections", json::array()}, {"complete", report.complete}};
  for (const ConnectionReport& c : report.connections) whole["connections"].push_back(entry(c));
  out << whole.dump(2) << '\n';
}

void write_table(const ConnectionsReport& report, std::ostream& out) {
  const auto column = [&out](const auto& what) { out << std::setw(16) << what; };
  for (const char* name :
       {"lambda", "travel_time", "view_1", "view_2", "view_3", "area_distance", "parity", "winding"})
    column(name);
  out << '\n' << std::setprecision(9);
  for (const ConnectionReport& c : report.connections) {
    for (const double x : {c.lambda, c.travel_time, c.view[0], c.view[1], c.view[2], c.area_distance})
      column(x + 0.0);
    column(c.parity);
    column(c.winding);
    out << '\n';
  }
  if (report.connections.empty()) out << "no light found\n";
  if (!report.complete) out << "some may have been missed\n";
}

}  // namespace

void connect_events(const GeodesicOptions& options, std::ostream& out) {
  const Spacetime& spacetime = find_spacetime(options.metric);
  const std::vector<double> parameters = parameter_values(spacetime.description(), options.settings);
  const std::vector<double> event = numbers("--event", options.event, 4);
  const std::vector<double> source = numbers("--source", options.source, 3);
  const Event at = {event[0], event[1], event[2], event[3]};
  check_tetrad(spacetime, parameters, at, "--event");
  check_tetrad(spacetime, parameters, {event[0], source[0], source[1], source[2]}, "--source");
  const ConnectionsReport report = spacetime.connect(parameters, at, {source[0], source[1], source[2]},
                                                     options.windings == 0 ? 1 : options.windings);
  options.json ? write_json(report, out) : write_table(report, out);
}

}  // namespace nullcone
