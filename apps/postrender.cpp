// nullcone-postrender: a dataset and a look in, a picture out; or many.
#include <tbb/global_control.h>
#include <CLI/CLI.hpp>

#include "apps/postrender_completion.h"
#include "apps/postrender_explain.h"
#include "apps/postrender_frame.h"
#include "apps/postrender_progress.h"
#include "apps/postrender_sequence.h"
#include "apps/postrender_show.h"
#include "core/base/error.h"
#include "postrender/picture_file.h"

namespace {

using namespace nullcone;

void check_options(const PostrenderOptions& options) {
  const auto refuse = [](const char* option, const char* why) { throw InputError(option, why); };
  if (options.picture.empty()) refuse("--output", "is required (see --help)");
  postrender::check_picture_name(options.picture, options.bits);
  if (options.frames.empty() && !options.movie.empty()) refuse("--movie", "expected --frames");
  if (options.frames.empty() && options.overwrite) refuse("--overwrite", "expected --frames");
}

/// Empty texts and zeros stand for options that are not given.
void check_given(const PostrenderOptions& options, const CLI::App& app) {
  for (const CLI::Option* option : app.get_options())
    for (const std::string& value : option->results())
      if (value.empty() && !option->check_lname("complete-set"))
        throw InputError(option->get_positional() ? "DATA" : "--" + option->get_lnames().front(),
                         "is empty; expected a value");
  if (app.count("--bits") > 0 && options.bits == 0) throw InputError("--bits", "is 0; expected 8, 16 or 32");
}

int work(const PostrenderOptions& options, const CLI::App& app, bool number_given) {
  check_given(options, app);
  if (!options.completion.empty()) return print_completion(app, options.completion);
  if (options.data.empty()) throw InputError("DATA", "is required (see --help)");
  if (!options.complete_set.empty() || app.count("--complete-set") > 0) return complete_set(options);
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(thread_count(options)));
  const bool sequence = !options.frames.empty();
  const bool pattern = postrender::FramePatterns{options.data, options.looks, options.picture}.any();
  if (pattern && !sequence && !number_given)
    throw InputError("--frames",
                     "is missing; names with # want numbers, as --frames 0-249, or one --frame 7");
  if (options.explain) return explain_look(options);
  check_options(options);
  if (!options.show.empty()) return show_channel(options);
  return sequence ? render_sequence(options) : render_picture(options);
}

/// What the picture shows.
void add_look_options(CLI::App& app, PostrenderOptions& options) {
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
  app.add_flag("--explain", options.explain, "print the look in full, as JSON; no picture")->excludes(show);
  app.add_option("--complete-set", options.complete_set)->group("");
}

void add_sequence_options(CLI::App& app, PostrenderOptions& options) {
  CLI::Option* show = app.get_option("--show");
  CLI::Option* frame =
      app.add_option("--frame", options.frame, "number of a single picture, for keyframes and ####")
          ->check(CLI::Range(0, 999'999'999));
  CLI::Option* frames =
      app.add_option(
             "--frames", options.frames,
             "0-249, 0-249:5 or 3,7,9-12: a sequence; #### in DATA, --look and --output is the number")
          ->excludes(frame)
          ->excludes(show)
          ->excludes(app.get_option("--explain"));
  app.add_flag("--overwrite", options.overwrite, "also the frames that are there and up to date")
      ->needs(frames);
  CLI::Option* movie =
      app.add_option("--movie", options.movie, "movie of the frames (.mp4, .mkv), by ffmpeg")->needs(frames);
  app.add_option("--fps", options.fps, "frames a second of the movie (25)")
      ->check(CLI::Range(0.01, 1000.0))
      ->needs(movie);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Makes a picture from a dataset and a look, or a sequence of them.", "nullcone-postrender");
  PostrenderOptions options;
  add_common_options(app, options.common);
  app.add_option("DATA", options.data, "dataset (.exr)");
  app.add_option("-o,--output", options.picture, "picture: .png, .jpg, .jpeg, .tif, .tiff or .exr");
  app.add_option("--bits", options.bits, "bits a component: .png 8 or 16, .tif 8, 16 or 32, .exr 16 or 32");
  add_look_options(app, options);
  add_sequence_options(app, options);
  app.add_flag("--json", options.json, "report as JSON on standard output");
  app.add_option("--completion", options.completion,
                 "bash or zsh: print the script that completes this command line");
  return run_tool(app, argc, argv, [&] { return work(options, app, app.count("--frame") > 0); });
}
