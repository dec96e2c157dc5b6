// nullcone-check-metric: is a spacetime what its header claims?
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/metric_options.h"
#include "apps/tool.h"
#include "metrics/check.h"
#include "metrics/registry.h"

namespace {

using namespace nullcone;
using json = nlohmann::ordered_json;

void print_line(const CheckResult& check) {
  char numbers[120];
  std::snprintf(numbers, sizeof numbers, "worst %.2g (limit %g), %zu events", check.worst, check.limit,
                check.events);
  std::cout << (check.holds() ? "ok      " : "FAILED  ") << check.name
            << std::string(check.name.size() < 46 ? 46 - check.name.size() : 1, ' ') << numbers
            << (check.holds() ? "" : "; " + check.where) << '\n';
}

json entry(const CheckResult& check) {
  json out = {{"check", check.name},
              {"ok", check.holds()},
              {"worst", check.worst},
              {"limit", check.limit},
              {"events", check.events}};
  if (!std::isfinite(check.worst)) out["worst"] = nullptr;  // JSON has no infinity
  if (!check.holds()) out["where"] = check.where;
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Checks a spacetime at random events, off the equator: the metric, its derivatives, Hamilton's "
      "equations, constants of motion, closed paths, isometries, static observers and infinity.",
      "nullcone-check-metric");
  std::string name;
  std::vector<std::string> settings;
  CheckOptions check;
  bool as_json = false;
  ToolOptions options;
  app.add_option("metric", name, "Spacetime")->required();
  app.add_option("--set", settings, "Parameter of the spacetime, key=value")->allow_extra_args(false);
  app.add_option("--seed", check.seed, "Of the random events");
  app.add_option("--events", check.events, "How many events and rays")->check(CLI::Range(10, 1000000));
  app.add_flag("--json", as_json, "Report as JSON");
  add_common_options(app, options);

  return run_tool(app, argc, argv, [&] {
    const std::vector<double> values = parameter_values(find_spacetime(name).description(), settings);
    const std::vector<CheckResult> results = check_spacetime(name, values, check);
    bool all_hold = true;
    json report = {{"metric", name}, {"checks", json::array()}};
    for (const CheckResult& result : results) {
      all_hold = all_hold && result.holds();
      if (as_json)
        report["checks"].push_back(entry(result));
      else
        print_line(result);
    }
    report["ok"] = all_hold;
    if (as_json) std::cout << report.dump(2) << '\n';
    return all_hold ? 0 : 1;
  });
}
