// nullcone-merge: windows of one picture become the whole.
#include <algorithm>
#include <cstdio>

#include "apps/preview.h"
#include "apps/tool.h"
#include "apps/trace_job.h"
#include "core/base/error.h"

namespace {

using namespace nullcone;

struct Window {
  std::string path;
  Manifest manifest;
};

std::string lines_text(int first, int end) {
  return "scan lines " + std::to_string(first) + " to " + std::to_string(end - 1);
}

/// All windows from the top; strangers, partial ones, overlaps and gaps are refused by name.
std::vector<Window> read_windows(const std::vector<std::string>& paths) {
  std::vector<Window> out;
  for (const std::string& path : paths) {
    out.push_back({path, read_manifest(path)});
    const Manifest& manifest = out.back().manifest;
    if (manifest.format < 2) throw InputError(path, "is of an older format, which has no windows");
    if (manifest.partial())
      throw InputError(path, "was interrupted; go on with nullcone-trace --resume first");
    const std::string fault = difference(manifest, out.front().manifest);
    if (!fault.empty()) throw InputError(path, fault + " (of " + out.front().path + ")");
    if (manifest.first_line % kBandLines != 0) throw InputError(path, "does not begin with a whole band");
  }
  std::ranges::stable_sort(out, {}, [](const Window& window) { return window.manifest.first_line; });
  int end = 0;
  const Window* before = nullptr;
  for (const Window& window : out) {
    const Manifest& m = window.manifest;
    if (m.first_line < end)
      throw InputError(window.path, "overlaps " + before->path + ": both hold " +
                                        lines_text(m.first_line, std::min(end, m.first_line + m.lines)));
    if (m.first_line > end)
      throw InputError(window.path, "a gap before it: nobody holds " + lines_text(end, m.first_line));
    end = m.first_line + m.lines;
    before = &window;
  }
  if (end < out.back().manifest.height)
    throw InputError(out.back().path,
                     "a gap after it: nobody holds " + lines_text(end, out.back().manifest.height));
  return out;
}

/// "a, b" of texts that differ.
void join(std::string& to, const std::string& more) {
  if ((", " + to + ", ").find(", " + more + ", ") == std::string::npos && to.size() < 1000) to += ", " + more;
}

int merge(const std::vector<std::string>& paths, const std::string& output, bool quiet) {
  check_output_name(output);
  const std::vector<Window> windows = read_windows(paths);
  Manifest whole = windows.front().manifest;
  whole.first_line = 0;
  whole.lines = whole.traced_lines = whole.height;
  Effort effort;
  for (const Window& window : windows) {
    join(whole.isa, window.manifest.isa);
    join(whole.host, window.manifest.host);
    effort += window.manifest.effort;
  }
  DatasetWriter writer(output, whole);
  for (const Window& window : windows) {
    DatasetReader reader(window.path);
    Verifier verifier(reader.manifest());
    for_each_band(window.manifest.lines, [&](int first, int lines) {
      const Band band = reader.band(first, lines);
      verifier.add(band);
      writer.add(band, make_preview(band.hits));
    });
    for (const std::string& fault : verifier.faults()) throw InputError(window.path, fault);
  }
  writer.finish(effort);
  if (!quiet)
    std::fprintf(stderr, "%s: %zu windows, %d x %d\n", output.c_str(), windows.size(), whole.width,
                 whole.height);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Puts windows of the same picture, from nullcone-trace --shard, together.", "nullcone-merge");
  std::vector<std::string> paths;
  std::string output;
  ToolOptions options;
  app.add_option("DATA", paths, "Datasets (.exr) that hold all scan lines, in any order")->required();
  app.add_option("-o,--output", output, "Dataset to write (.exr)")->required();
  add_common_options(app, options);
  return run_tool(app, argc, argv, [&] { return merge(paths, output, options.quiet); });
}
