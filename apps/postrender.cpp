// nullcone-postrender: a dataset and a look in, a picture out.
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

#include "apps/tool.h"
#include "core/record/dataset_file.h"
#include "postrender/look_source.h"
#include "postrender/picture_file.h"
#include "postrender/renderer.h"
#include "postrender/stack.h"

namespace {

using namespace nullcone;

struct Options {
  ToolOptions common;
  std::string data, picture;
  std::vector<std::string> looks, settings;
  int bits = 8;
  bool json = false;
};

/// Seconds from one step to the next.
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> passed = now - last_;
    last_ = now;
    return passed.count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

struct Seconds {
  double read = 0, render = 0, write = 0;
};

void report(const Options& options, const postrender::Image& image, const Seconds& seconds) {
  if (options.json)
    std::printf(
        "{\"width\":%d,\"height\":%d,\"white_cd_m2\":%.9g,"
        "\"seconds\":{\"read\":%.6f,\"render\":%.6f,\"write\":%.6f}}\n",
        image.width, image.height, image.white_cd_m2, seconds.read, seconds.render, seconds.write);
  if (!options.common.quiet)
    std::fprintf(stderr, "%s: %d x %d, read %.3f s, rendered %.3f s, written %.3f s\n",
                 options.picture.c_str(), image.width, image.height, seconds.read, seconds.render,
                 seconds.write);
}

int work(const Options& options) {
  namespace pr = postrender;
  const tbb::global_control threads(
      tbb::global_control::max_allowed_parallelism,
      static_cast<std::size_t>(options.common.threads > 0 ? options.common.threads
                                                          : tbb::info::default_concurrency()));
  pr::check_picture_name(options.picture, options.bits);
  Stopwatch watch;
  Seconds seconds;

  Dataset dataset = read_dataset(options.data);
  std::vector<pr::Look> looks;
  for (const std::string& file : options.looks.empty() ? std::vector<std::string>{""} : options.looks)
    looks.push_back(pr::read_look(dataset.manifest, options.data, file, options.settings));
  seconds.read = watch.lap();

  pr::Renderer renderer(std::move(dataset));
  std::vector<pr::Image> pictures;
  for (const pr::Look& look : looks) pictures.push_back(renderer.render(look));
  const pr::Image image = pr::stack(pictures);
  seconds.render = watch.lap();

  pr::write_picture(options.picture, image, options.bits);
  seconds.write = watch.lap();

  report(options, image, seconds);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Makes a picture from a dataset and a look.", "nullcone-postrender");
  Options options;
  add_common_options(app, options.common);
  app.add_option("DATA", options.data, "dataset (.exr)")->required();
  app.add_option("--look", options.looks,
                 "look (.json) in place of the scene's own; several are stacked from top to bottom")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--set", options.settings, "path=value: overrides an entry of the look (repeatable)")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("-o,--output", options.picture, "picture: .png, .jpg, .jpeg or .exr")->required();
  app.add_option("--bits", options.bits, "8 or 16 bits a channel (PNG)");
  app.add_flag("--json", options.json, "report as JSON on standard output");
  return run_tool(app, argc, argv, [&] { return work(options); });
}
