#include "apps/postrender_show.h"

#include <cstdio>

#include "apps/postrender_frame.h"
#include "core/base/error.h"
#include "core/record/dataset_file.h"
#include "postrender/channel_values.h"
#include "postrender/legend.h"
#include "postrender/picture_file.h"

namespace nullcone {

namespace {

namespace pr = postrender;

/// What stands in a legend, for programs; categories have no range.
void report_scale(const std::string& name, int width, int height, const pr::ColorScale* scale,
                  const Seconds& seconds) {
  std::printf("{\"channel\":\"%s\",\"width\":%d,\"height\":%d,", name.c_str(), width, height);
  if (scale != nullptr && scale->kind != pr::ScaleKind::categories)
    std::printf("\"range\":[%.9g,%.9g],", scale->range.first, scale->range.second);
  std::printf("\"seconds\":{\"read\":%.6f,\"render\":%.6f,\"write\":%.6f}}\n", seconds.read, seconds.render,
              seconds.write);
}

}  // namespace

int show_channel(const PostrenderOptions& options) {
  const std::string& name = options.show;
  const bool as_numbers = pr::is_exr_name(options.picture);
  std::optional<pr::Range> given;
  if (!options.range.empty()) given = pr::parse_range(options.range);
  if (given && as_numbers)
    throw InputError("--range", "numbers in an .exr file have no scale; expected .png");
  if (as_numbers && options.bits != 0 && options.bits != 32)
    throw InputError("--bits", "a channel in an .exr file has 32 bits");
  const pr::FrameFiles files = pr::files_of({options.data, {}, options.picture}, {options.frame}).front();
  Stopwatch watch;
  Seconds seconds;
  // Step 1: the channel.
  const pr::ChannelChoice choice = pr::find_channel(name, read_manifest(files.data), files.data);
  const Dataset dataset = read_dataset(files.data, choice.wanted());
  const Manifest& manifest = dataset.manifest;
  const std::vector<float> values = pr::channel_values(choice, dataset);
  seconds.read = watch.lap();
  if (as_numbers) {
    pr::write_channel(files.picture, name, manifest, values);
    seconds.write = watch.lap();
    if (options.json) report_scale(name, manifest.width, manifest.lines, nullptr, seconds);
    report_times(options, files.picture, manifest.width, manifest.lines, seconds);
    return 0;
  }
  // Step 2: its colours.
  pr::ColorScale scale = pr::choose_scale(choice.info, values, given);
  scale.channel = choice.name;
  const pr::Image image = pr::false_color_picture(scale, choice.info, manifest, values);
  seconds.render = watch.lap();
  pr::write_picture(files.picture, image, options.bits);
  seconds.write = watch.lap();
  if (options.json) report_scale(name, image.width, image.height, &scale, seconds);
  report_times(options, files.picture, image.width, image.height, seconds);
  return 0;
}

}  // namespace nullcone
