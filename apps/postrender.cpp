// nullcone-postrender: a dataset and a look in, a picture out.
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "apps/postrender_show.h"
#include "apps/tool.h"
#include "core/record/dataset_file.h"
#include "postrender/look_source.h"
#include "postrender/needed_channels.h"
#include "postrender/picture_file.h"
#include "postrender/renderer.h"
#include "postrender/stack.h"

namespace {

using namespace nullcone;

struct Options : PostrenderOptions {
  std::vector<std::string> looks, settings;
  std::string show;  ///< a channel in place of a look
  std::string range;
};

void report(const Options& options, const postrender::Image& image, const Seconds& seconds) {
  if (options.json)
    std::printf(
        "{\"width\":%d,\"height\":%d,\"white_cd_m2\":%.9g,"
        "\"seconds\":{\"read\":%.6f,\"render\":%.6f,\"write\":%.6f}}\n",
        image.width, image.height, image.white_cd_m2, seconds.read, seconds.render, seconds.write);
  report_times(options, image.width, image.height, seconds);
}

/// Steps 1 and 2: the manifest, then the looks against it.
std::vector<postrender::Look> read_looks(const Options& options, const Manifest& manifest) {
  std::vector<postrender::Look> looks;
  for (const std::string& file : options.looks.empty() ? std::vector<std::string>{""} : options.looks)
    looks.push_back(postrender::read_look(manifest, options.data, file, options.settings));
  return looks;
}

/// Step 3: the channels that the looks need, and no others.
Dataset read_needed(const std::string& path, const Manifest& manifest,
                    const std::vector<postrender::Look>& looks) {
  ChannelSet needed;
  for (const postrender::Look& look : looks) {
    postrender::check_channels(look, manifest, manifest.channels, path);
    needed = needed | postrender::needed_channels(look, manifest);
  }
  return read_dataset(path, needed, false);
}

int render(const Options& options) {
  namespace pr = postrender;
  Stopwatch watch;
  Seconds seconds;
  const Manifest manifest = read_manifest(options.data);
  const std::vector<pr::Look> looks = read_looks(options, manifest);
  pr::Renderer renderer(read_needed(options.data, manifest, looks));
  seconds.read = watch.lap();

  std::vector<pr::Image> pictures;
  for (const pr::Look& look : looks) pictures.push_back(renderer.render(look));
  const pr::Image image = pr::stack(pictures);
  seconds.render = watch.lap();

  pr::write_picture(options.picture, image, options.bits);
  seconds.write = watch.lap();

  report(options, image, seconds);
  return 0;
}

int work(const Options& options) {
  const tbb::global_control threads(
      tbb::global_control::max_allowed_parallelism,
      static_cast<std::size_t>(options.common.threads > 0 ? options.common.threads
                                                          : tbb::info::default_concurrency()));
  postrender::check_picture_name(options.picture, options.bits);
  if (!options.show.empty()) return show_channel(options, options.show, options.range);
  return render(options);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Makes a picture from a dataset and a look.", "nullcone-postrender");
  Options options;
  add_common_options(app, options.common);
  app.add_option("DATA", options.data, "dataset (.exr)")->required();
  CLI::Option* look =
      app.add_option("--look", options.looks,
                     "look (.json) in place of the scene's own; several are stacked from top to bottom")
          ->expected(1)
          ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  CLI::Option* set =
      app.add_option("--set", options.settings, "path=value: overrides an entry of the look (repeatable)")
          ->expected(1)
          ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  CLI::Option* show =
      app.add_option(
             "--show", options.show,
             "in false colours a channel by its name, as status, error or shift; as numbers into .exr")
          ->excludes(look)
          ->excludes(set);
  app.add_option("--range", options.range, "a,b: numbers at the ends of the scale of --show")->needs(show);
  app.add_option("-o,--output", options.picture, "picture: .png, .jpg, .jpeg or .exr")->required();
  app.add_option("--bits", options.bits, "8 or 16 bits a channel (PNG)");
  app.add_flag("--json", options.json, "report as JSON on standard output");
  return run_tool(app, argc, argv, [&] { return work(options); });
}
