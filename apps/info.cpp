// nullcone-info: what a dataset holds, how it came to be, and whether it is whole; and its flat companion.
#include "apps/info.h"

#include <fstream>
#include <iostream>

#include "apps/flat.h"
#include "apps/tool.h"
#include "core/base/error.h"

namespace {

using namespace nullcone;

struct Options {
  ToolOptions common;
  std::string data, output;
  std::vector<int> pixel;
  std::size_t worst = 10;
  int ranks = kDefaultRanks;
  bool json = false, verify = false, flat = false, format = false;
};

/// One line a fault on standard output, status 1; a file that cannot even be read is one fault.
int report_faults(const std::string& path, bool quiet) {
  std::vector<std::string> faults;
  if (!std::ifstream(path))
    throw InputError(path, "cannot open the file; expected a nullcone dataset (.exr)");
  Manifest manifest;
  try {
    manifest = read_manifest(path);
    for (const std::string& fault : verify_file(path)) faults.push_back(path + ": " + fault);
  } catch (const InputError& error) {
    faults.emplace_back(error.what());
  }
  for (const std::string& fault : faults) std::cout << printable(fault, 1000) << '\n';
  if (!faults.empty()) return 1;
  if (manifest.partial())
    std::cerr << path << ": true, but interrupted: " << manifest.traced_lines << " of " << manifest.lines
              << " scan lines are traced\n";
  else if (!quiet)
    std::cerr << path << ": whole and true\n";
  return 0;
}

int print_json(const Report& report) {
  std::cout << report.dump(2) << '\n';
  return 0;
}

int work(const Options& options) {
  if (options.format) return print_json(format_table());
  if (options.data.empty()) throw InputError("DATA", "is required: a dataset (.exr); see --help");
  if (options.verify) return report_faults(options.data, options.common.quiet);
  if (options.flat) return write_flat(options.data, options.output, options.ranks), 0;
  DatasetReader reader(options.data);
  const bool whole = options.pixel.empty();
  const Report report =
      whole ? summary(reader, options.worst) : pixel_records(reader, options.pixel[0], options.pixel[1]);
  if (options.json) return print_json(report);
  if (whole)
    print_summary(options.data, report);
  else
    print_pixel(report);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Tells what a dataset holds, how it came to be, and whether it is whole.", "nullcone-info");
  Options options;
  auto* data = app.add_option("DATA", options.data, "Dataset (.exr)");
  auto* json = app.add_flag("--json", options.json, "Report as JSON");
  auto* pixel = app.add_option("--pixel", options.pixel,
                               "All records of the pixel X,Y of the picture, counted from 0 at the top left")
                    ->delimiter(',')
                    ->expected(2);
  app.add_option("--worst", options.worst, "List so many of the worst rays (default: 10)")
      ->check(CLI::Range(0, 100'000))
      ->excludes(pixel);
  auto* verify =
      app.add_flag("--verify", options.verify,
                   "Check counts, channels, values and fingerprints; one line a fault, exit status 1")
          ->excludes(pixel);
  auto* flat =
      app.add_flag("--flat", options.flat,
                   "Write a flat picture with all channels and Cryptomatte layers, for programs that "
                   "do not read deep ones")
          ->excludes(pixel)
          ->excludes(verify)
          ->excludes(json);
  auto* output = app.add_option("-o,--output", options.output, "Flat picture to write (.exr)")->needs(flat);
  flat->needs(output);
  app.add_option("--ranks", options.ranks, "Cryptomatte: at most so many objects a pixel (default: 6)")
      ->check(CLI::Range(1, 64))
      ->needs(flat);
  app.add_flag("--format", options.format, "Print the table of channels of the file format, as JSON")
      ->excludes(data)
      ->excludes(flat);
  add_common_options(app, options.common);
  return run_tool(app, argc, argv, [&] { return work(options); });
}
