// nullcone-submit: a sequence traced by many machines, or by one, until every frame is there.
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "apps/cluster/start_jobs.h"
#include "apps/cluster/status.h"
#include "apps/cluster/submission.h"
#include "apps/cluster/trace_pieces.h"
#include "apps/tool.h"
#include "core/base/error.h"

namespace {

using namespace nullcone;
using namespace nullcone::cluster;

struct Options {
  ToolOptions common;
  SubmitOptions submit;
  std::string status, cancel, task, finish;
  bool json = false;
  double watch_s = 0;
  int round = 0, bundle = 0;
};

void add_work_options(CLI::App& app, SubmitOptions& options) {
  Settings& s = options.settings;
  app.add_option("SCENE", options.scene, "Sequence (.json), or a scene of one frame");
  app.add_option("-o,--output", options.output, "Folder of the sequence: datasets, scripts, logs");
  app.add_option("--frames", s.frames, "0-249, 0-249:5 or 3,7,9-12 (default: all)");
  app.add_option("--shards", s.shards, "Pieces that a frame is cut into (default 1)")
      ->check(CLI::Range(1, 1'000'000));
  app.add_option("--isa", s.isa, "Instruction set of the kernel (default: the best of each host)")
      ->check(CLI::IsMember({"sse2", "avx2", "avx512"}));
  app.add_flag("--replace", options.replace, "Trace frames again that are of another scene");
  app.add_flag("--pictures", s.pictures, "Make pictures of the frames then, under pictures/");
  app.add_option("--look", s.looks, "Look (.json) of the pictures in place of the scene's; repeatable")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--movie", s.movie, "Movie of the pictures (.mp4, .mkv)");
  app.add_option("--fps", s.fps, "Frames a second of the movie (25)")->check(CLI::Range(0.01, 1000.0));
}

void add_scheduler_options(CLI::App& app, SubmitOptions& options) {
  Settings& s = options.settings;
  app.add_option("--partition", s.partition, "Slurm's partition");
  app.add_option("--account", s.account, "Account that pays");
  app.add_option("--qos", s.qos, "Quality of service");
  app.add_option("--sbatch", s.sbatch, "Any other option of sbatch, as --sbatch=--exclude=n7; repeatable")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--memory", s.memory_mb, "MB of a task (default: as measured; 0: do not ask)")
      ->check(CLI::Range(0, 100'000'000));
  app.add_option("--time", s.minutes, "Minutes of a task (default: as measured; 0: do not ask)")
      ->check(CLI::Range(0, 1'000'000));
  app.add_option("--per-task", s.per_task, "Frames or shards of a task (default: five minutes of them)")
      ->check(CLI::Range(1, 1'000'000));
  app.add_option("--max-running", s.max_running, "Tasks at once, at most")->check(CLI::Range(1, 1'000'000));
  app.add_option("--trial", s.trial, "Where a frame is measured first: here, queue or none")
      ->check(CLI::IsMember({"here", "queue", "none"}));
  app.add_option("--tries", s.tries, "Of a frame that fails (3)")->check(CLI::Range(1, 1000));
  app.add_option("--retry-delay", s.retry_delay_s, "Seconds before a frame is tried again (30)")
      ->check(CLI::Range(0, 1'000'000));
  app.add_option("--launcher", s.launcher, "Words before our tools in scripts, as of a container");
  CLI::Option* dry =
      app.add_flag("--dry-run", options.dry_run, "Print the scripts; write and submit nothing");
  CLI::Option* scripts =
      app.add_flag("--scripts-only", options.scripts_only, "Write the scripts; submit nothing")
          ->excludes(dry);
  CLI::Option* local = app.add_flag("--local", options.local, "Without Slurm: on this machine")
                           ->excludes(dry)
                           ->excludes(scripts);
  app.add_option("--jobs", options.jobs, "With --local: processes at once (default: one a core)")
      ->check(CLI::Range(1, 4096))
      ->needs(local);
}

void add_other_work(CLI::App& app, Options& options) {
  CLI::Option* status = app.add_option("--status", options.status, "Tell how far the folder is");
  app.add_flag("--json", options.json, "Status as JSON")->needs(status);
  app.add_option("--watch", options.watch_s, "Again every so many seconds (5), to the end")
      ->expected(0, 1)
      ->default_str("5")
      ->check(CLI::Range(0.1, 86400.0))
      ->needs(status);
  app.add_option("--cancel", options.cancel, "Cancel the jobs of the folder");
  app.add_option("--task", options.task)->group("");  // for the scripts
  app.add_option("--finish", options.finish)->group("");
  app.add_option("--round", options.round)->group("");
  app.add_option("--bundle", options.bundle)->group("");
}

void refuse(const char* option, const char* why) { throw InputError(option, why); }

void check_given(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options())
    for (const std::string& value : option->results())
      if (value.empty())
        throw InputError(option->get_positional() ? "SCENE" : "--" + option->get_lnames().front(),
                         "is empty; expected a value");
}

/// The other work that is asked for, empty for SCENE; options that do not belong to it are refused.
std::string other_work(const CLI::App& app) {
  const std::map<std::string, std::set<std::string>> works = {
      {"status", {"json", "watch"}}, {"cancel", {}}, {"task", {"round", "bundle"}}, {"finish", {"round"}}};
  std::string work;
  for (const auto& [name, options] : works)
    if (app.count("--" + name) > 0 && std::exchange(work, name) != "")
      refuse("command line", "expected one of SCENE, --status and --cancel");
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() == 0 || work.empty()) continue;
    const std::string name = option->get_positional() ? "SCENE" : option->get_lnames().front();
    if (name == work || name == "threads" || name == "quiet" || works.at(work).contains(name)) continue;
    throw InputError(name == "SCENE" ? name : "--" + name, "does not go with --" + work);
  }
  return work;
}

/// What is wrong, or is completed, before any work.
void prepare(SubmitOptions& options, int threads) {
  namespace fs = std::filesystem;
  Settings& s = options.settings;
  if (options.scene.empty()) refuse("SCENE", "is required (see --help)");
  if (options.output.empty()) refuse("--output", "is required (see --help)");
  s.threads = threads > 0 ? threads : 1;
  if (options.local) s.trial = "none";
  s.pictures = s.pictures || !s.looks.empty() || !s.movie.empty();
  for (std::string& look : s.looks) {
    if (!fs::is_regular_file(look)) throw InputError(look, "is not there; expected a look (.json)");
    look = fs::absolute(look).lexically_normal().string();
  }
  if (!s.movie.empty() && !s.movie.ends_with(".mp4") && !s.movie.ends_with(".mkv"))
    refuse("--movie", "expected a name that ends in .mp4 or .mkv");
}

int work(Options& options, const CLI::App& app) {
  check_given(app);
  const std::string other = other_work(app);
  if (other == "status") return show_status(Folder(options.status), options.watch_s, options.json);
  if (other == "cancel") return cancel(Folder(options.cancel));
  if (other == "task") return trace_bundle(Folder(options.task), options.round, options.bundle);
  if (other == "finish")
    return finish_round(Folder(options.finish), options.round, std::max(options.common.threads, 1));
  prepare(options.submit, options.common.threads);
  options.submit.quiet = options.common.quiet;
  return submit(options.submit);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Traces a sequence on a cluster, or on this machine, until every frame is there and verified.",
               "nullcone-submit");
  Options options;
  add_work_options(app, options.submit);
  add_scheduler_options(app, options.submit);
  add_other_work(app, options);
  add_common_options(app, options.common);
  return run_tool(app, argc, argv, [&] { return work(options, app); });
}
