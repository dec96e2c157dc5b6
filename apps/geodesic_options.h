// The command line of nullcone-geodesic: its words, and which of them go together.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/read_scene.h"

namespace nullcone {

/// As given; texts are empty where an option is not.
struct GeodesicOptions {
  std::string scene, pixel;
  std::string metric, event, direction, speed, at;
  std::vector<std::string> settings;
  std::string paths, accuracy, integrator;
  std::string plane, killing, eta;
  std::string plot;
  std::string source;
  int fan = 0, points = 0, windings = 0;
  bool json = false, csv = false, connect = false;
};

void add_geodesic_options(CLI::App& app, GeodesicOptions& options);

/// Throws InputError for options that are missing, or do not go together.
void check_combination(const GeodesicOptions& options);

/// "1,-2,.5": finite numbers with single commas between them; `count` of them, or any number where it is 0.
std::vector<double> numbers(const std::string& option, const std::string& text, std::size_t count = 0);

/// How rays are integrated: --accuracy and --integrator, over what else holds.
Accuracy accuracy_of(const GeodesicOptions& options, Accuracy otherwise);

/// Whether rays are integrated: --paths, or what the spacetime offers.
bool integrates(const GeodesicOptions& options, const MetricDescription& metric, bool otherwise);

/// Throws InputError where the file of --plot cannot be written: better before the work than after.
void check_plot_place(const std::string& path);

}  // namespace nullcone
