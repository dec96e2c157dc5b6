// nullcone-info: what a dataset holds, how it came to be, and whether it is whole.
#include <algorithm>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/tool.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/record/dataset_file.h"

namespace {

using namespace nullcone;
using json = nlohmann::ordered_json;

json number(float x) { return std::isfinite(x) ? json(x) : json(nullptr); }

json status_counts(const Rays& rays) {
  std::array<std::size_t, kStatusNames.size()> counts{};
  for (const std::uint32_t status : rays.status)
    if (status < counts.size()) ++counts[status];
  json out = json::object();
  for (std::size_t i = 0; i < counts.size(); ++i) out[std::string(kStatusNames[i])] = counts[i];
  return out;
}

/// Least and greatest finite value of every floating-point channel.
json ranges(const Hits& hits) {
  json out = json::object();
  for_each_channel(
      [&](const ChannelInfo& channel, const auto& column) {
        float least = INFINITY, most = -INFINITY;
        for (const auto value : column) {
          const auto x = static_cast<float>(value);
          if (std::isfinite(x)) least = std::min(least, x), most = std::max(most, x);
        }
        if (least <= most) out[std::string(channel.name)] = {least, most};
      },
      hits);
  return out;
}

json object_list(const Dataset& dataset) {
  std::vector<std::size_t> counts(dataset.manifest.objects.size());
  for (const std::uint32_t id : dataset.hits.id)
    if (id >= 1 && id <= counts.size()) ++counts[id - 1];
  json out = json::array();
  for (std::size_t i = 0; i < counts.size(); ++i)
    out.push_back({{"name", dataset.manifest.objects[i].name},
                   {"id", i + 1},
                   {"hits", counts[i]},
                   {"tau_origin", dataset.manifest.objects[i].tau_origin}});
  return out;
}

json summary(const Dataset& dataset) {
  const Manifest& m = dataset.manifest;
  std::uint64_t most = 0;
  for (std::size_t i = 0; i + 1 < dataset.hits.offset.size(); ++i)
    most = std::max(most, dataset.hits.offset[i + 1] - dataset.hits.offset[i]);
  const json scene = parse_json(m.scene, "manifest: scene");  // refuses what is nested too deep to print
  return {
      {"width", m.width},
      {"height", m.height},
      {"metric", m.metric},
      {"metric_parameters", scene.is_object() && scene.contains("metric") ? scene["metric"] : json(nullptr)},
      {"hits", {{"count", dataset.hits.count()}, {"max_per_pixel", most}, {"ranges", ranges(dataset.hits)}}},
      {"status", status_counts(dataset.rays)},
      {"objects", object_list(dataset)},
      {"payload", {{"hits", m.hits_sha256}, {"rays", m.rays_sha256}}},
      {"scene_sha256", m.scene_sha256},
      {"isa", m.isa},
      {"core_seconds", m.core_seconds},
      {"version", m.version},
      {"host", m.host},
      {"format", m.format},
      {"scene", scene}};
}

json pixel_records(const Dataset& dataset, const std::vector<int>& pixel) {
  const Manifest& m = dataset.manifest;
  if (pixel[0] < 0 || pixel[0] >= m.width || pixel[1] < 0 || pixel[1] >= m.height)
    throw InputError("--pixel", "lies outside the picture of " + std::to_string(m.width) + " x " +
                                    std::to_string(m.height) + " pixels");
  const std::size_t i = static_cast<std::size_t>(pixel[1]) * static_cast<std::size_t>(m.width) +
                        static_cast<std::size_t>(pixel[0]);
  json hits = json::array();
  const Hits& h = dataset.hits;
  for (std::uint64_t k = h.offset[i]; k < h.offset[i + 1]; ++k) {
    const std::size_t id = h.id[k];
    const bool known = id >= 1 && id <= m.objects.size();
    hits.push_back({{"Z", number(h.Z[k])},
                    {"A", number(h.A[k])},
                    {"object", known ? json(m.objects[id - 1].name) : json(nullptr)},
                    {"order", h.order[k]},
                    {"uv", {number(h.u[k]), number(h.v[k])}},
                    {"shift", number(h.shift[k])},
                    {"t", number(h.t[k])},
                    {"tau", number(h.tau[k])},
                    {"mu", number(h.mu[k])}});
  }
  const std::uint32_t status = dataset.rays.status[i];
  return {{"pixel", pixel},
          {"rays",
           {{"status", status < kStatusNames.size() ? json(std::string(kStatusNames[status])) : json(status)},
            {"steps", dataset.rays.steps[i]},
            {"error", number(dataset.rays.error[i])},
            {"drift", number(dataset.rays.drift[i])}}},
          {"hits", hits}};
}

/// One line a fault on standard output, status 1; a file that cannot even be read is one fault.
int report_faults(const std::string& path, bool quiet) {
  std::vector<std::string> faults;
  if (!std::ifstream(path))
    throw InputError(path, "cannot open the file; expected a nullcone dataset (.exr)");
  try {
    for (const std::string& fault : verify_file(path)) faults.push_back(path + ": " + fault);
  } catch (const InputError& error) {
    faults.emplace_back(error.what());
  }
  for (const std::string& fault : faults) std::cout << printable(fault, 1000) << '\n';
  if (faults.empty() && !quiet) std::cerr << path << ": whole and true\n";
  return faults.empty() ? 0 : 1;
}

/// Lines "key: value" for people; the scene itself is left to --json.
void print_plainly(json report) {
  report.erase("scene");
  for (const auto& [key, value] : report.items())
    std::cout << key << ": " << (value.is_string() ? printable(value.get<std::string>(), 1000) : value.dump())
              << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Tells what a dataset holds, how it came to be, and whether it is whole.", "nullcone-info");
  std::string path;
  std::vector<int> pixel;
  bool as_json = false, check = false;
  ToolOptions options;
  app.add_option("DATA", path, "Dataset (.exr)")->required();
  app.add_flag("--json", as_json, "Report as JSON");
  auto* one_pixel =
      app.add_option("--pixel", pixel, "All records of the pixel X,Y, counted from 0 at the top left")
          ->delimiter(',')
          ->expected(2);
  app.add_flag("--verify", check, "Check counts, channels and fingerprints; one line a fault, exit status 1")
      ->excludes(one_pixel);
  add_common_options(app, options);

  return run_tool(app, argc, argv, [&] {
    if (check) return report_faults(path, options.quiet);
    const Dataset dataset = read_dataset(path);
    const json report = pixel.empty() ? summary(dataset) : pixel_records(dataset, pixel);
    if (as_json)
      std::cout << report.dump(2) << '\n';
    else
      print_plainly(report);
    return 0;
  });
}
