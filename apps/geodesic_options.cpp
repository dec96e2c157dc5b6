#include "apps/geodesic_options.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "core/base/error.h"
#include "core/record/whole_file.h"

namespace nullcone {

namespace {

struct Given {
  const char* name;
  bool is_given;
};

/// Options that describe a geodesic by numbers; none of them goes with a scene.
std::vector<Given> options_by_numbers(const GeodesicOptions& o) {
  return {{"--metric", !o.metric.empty()},
          {"--set", !o.settings.empty()},
          {"--event", !o.event.empty()},
          {"--direction", !o.direction.empty()},
          {"--speed", !o.speed.empty()},
          {"--at", !o.at.empty()},
          {"--fan", o.fan != 0},
          {"--plane", !o.plane.empty()},
          {"--killing", !o.killing.empty()},
          {"--eta", !o.eta.empty()}};
}

/// --connect asks for geodesics by their ends: nothing else says how they run, and there is no picture.
void check_connect(const GeodesicOptions& o) {
  const std::vector<Given> needed = {
      {"--metric", !o.metric.empty()}, {"--event", !o.event.empty()}, {"--source", !o.source.empty()}};
  const std::vector<Given> others = {{"SCENE", !o.scene.empty()},
                                     {"--pixel", !o.pixel.empty()},
                                     {"--direction", !o.direction.empty()},
                                     {"--speed", !o.speed.empty()},
                                     {"--at", !o.at.empty()},
                                     {"--points", o.points != 0},
                                     {"--paths", !o.paths.empty()},
                                     {"--accuracy", !o.accuracy.empty()},
                                     {"--integrator", !o.integrator.empty()},
                                     {"--fan", o.fan != 0},
                                     {"--plane", !o.plane.empty()},
                                     {"--killing", !o.killing.empty()},
                                     {"--eta", !o.eta.empty()},
                                     {"--plot", !o.plot.empty()},
                                     {"--csv", o.csv}};
  for (const auto& [name, is_given] : others)
    if (is_given) throw InputError(name, "does not go with --connect");
  for (const auto& [name, is_given] : needed)
    if (!is_given) throw InputError(name, "is required with --connect");
}

}  // namespace

void add_geodesic_options(CLI::App& app, GeodesicOptions& o) {
  app.add_option("SCENE", o.scene, "Scene (.json) or dataset (.exr), to follow the ray of a pixel of it");
  app.add_option("--pixel", o.pixel, "The pixel X,Y of the scene, counted from 0 at the top left");
  app.add_option("--metric", o.metric, "Spacetime; then --event, --direction and --at are required");
  app.add_option("--set", o.settings, "Parameter of the spacetime, key=value")->allow_extra_args(false);
  app.add_option("--event", o.event, "Where it passes: t,x,y,z");
  app.add_option("--direction", o.direction,
                 "Unit spatial direction n1,n2,n3 in the static tetrad, future-directed");
  app.add_option("--speed", o.speed, "Local speed of a particle (below 1); without it, light");
  app.add_option("--at", o.at, "Affine parameters l1,l2,... (negative: the past)");
  app.add_option(
         "--points", o.points,
         "So many points, evenly spaced between the least and the greatest of --at, or along the ray of "
         "the pixel (default 400)")
      ->check(CLI::Range(2, 1000000));
  app.add_option("--paths", o.paths, "How the path is found (default: closed, where the spacetime offers it)")
      ->check(CLI::IsMember({"closed", "integrated"}));
  app.add_option("--accuracy", o.accuracy,
                 "Of integrated paths: draft, balanced, reference, or a relative tolerance");
  std::vector<std::string> names(kIntegratorNames.begin(), kIntegratorNames.end());
  app.add_option("--integrator", o.integrator, "Of integrated paths")->check(CLI::IsMember(names));
  app.add_option("--fan", o.fan, "So many geodesics, their directions evenly spaced in a plane")
      ->check(CLI::Range(1, 10000));
  app.add_option("--plane", o.plane,
                 "With --fan: second direction n1,n2,n3 of the plane (default: a quarter turn about e3 on)");
  app.add_option("--killing", o.killing,
                 "Carries the geodesic along the Killing field of this constant of motion");
  app.add_option("--eta", o.eta, "With --killing: how far, e1,e2,...");
  app.add_flag("--connect", o.connect,
               "All light that reaches --event from an observer at rest at --source, by affine length");
  app.add_option("--source", o.source, "With --connect: x,y,z of the source");
  app.add_option("--windings", o.windings,
                 "With --connect: how often the light may go round, counted from 1 (default 1)")
      ->check(CLI::Range(1, 1000));
  app.add_option("--plot", o.plot, "Draws the x-y projection into this file (.svg)");
  auto* json = app.add_flag("--json", o.json, "Report as JSON");
  app.add_flag("--csv", o.csv, "Report as CSV (default without --plot)")->excludes(json);
}

void check_combination(const GeodesicOptions& o) {
  if (o.connect) return check_connect(o);
  if (!o.source.empty()) throw InputError("--source", "needs --connect");
  if (o.windings != 0) throw InputError("--windings", "needs --connect");
  if (!o.scene.empty()) {
    for (const auto& [name, is_given] : options_by_numbers(o))
      if (is_given) throw InputError(name, "does not go with a scene, which says all of it");
    if (o.pixel.empty()) throw InputError("--pixel", "is required with a scene");
    return;
  }
  if (!o.pixel.empty()) throw InputError("--pixel", "needs a SCENE");
  for (const auto& [name, is_given] : options_by_numbers(o)) {
    const std::string_view option = name;
    const bool wanted =
        option == "--metric" || option == "--event" || option == "--direction" || option == "--at";
    if (wanted && !is_given) throw InputError(name, "is required, unless a SCENE and --pixel are given");
  }
  if (o.fan != 0 && !o.killing.empty()) throw InputError("--fan", "does not go with --killing");
  if (o.fan == 0 && !o.plane.empty()) throw InputError("--plane", "needs --fan");
  if (o.killing.empty() != o.eta.empty())
    throw InputError(o.eta.empty() ? "--eta" : "--killing", "is required: the one needs the other");
}

std::vector<double> numbers(const std::string& option, const std::string& text, std::size_t count) {
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

Accuracy accuracy_of(const GeodesicOptions& o, Accuracy otherwise) {
  Accuracy out = otherwise;
  if (o.accuracy == "draft") {
    out = kDraft;
  } else if (o.accuracy == "balanced") {
    out = kBalanced;
  } else if (o.accuracy == "reference") {
    out = kReference;
  } else if (!o.accuracy.empty()) {
    char* end = nullptr;
    out.rtol = std::strtod(o.accuracy.c_str(), &end);
    if (*end != '\0' || !(out.rtol >= 1e-15 && out.rtol <= 1e-2))  // as scenes may ask for
      throw InputError("--accuracy", "expected draft, balanced, reference, or a number from 1e-15 to 0.01");
  }
  for (std::size_t i = 0; i < kIntegratorNames.size(); ++i)
    if (o.integrator == kIntegratorNames[i]) out.integrator = static_cast<Integrator>(i);
  return out;
}

bool integrates(const GeodesicOptions& o, const MetricDescription& metric, bool otherwise) {
  if (o.paths == "closed" && !metric.closed_paths)
    throw InputError("--paths", "the spacetime '" + std::string(metric.name) + "' has no closed-form paths");
  return o.paths.empty() ? otherwise : o.paths == "integrated";
}

void check_plot_place(const std::string& path) {
  if (path.size() <= 4 || !path.ends_with(".svg"))
    throw InputError("--plot " + path, "expected a name that ends in .svg");
  if (std::filesystem::is_directory(path))
    throw InputError("--plot " + path, "is a folder; expected the name of a file");
  try {
    const WholeFile created_and_removed(path);
  } catch (const WorkError&) {
    throw InputError("--plot " + path, "cannot write there");
  }
}

}  // namespace nullcone
