#include "apps/cluster/scripts.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "apps/cluster/pictures.h"
#include "core/base/frame_numbers.h"

namespace nullcone::cluster {

namespace {

constexpr int kWarning_s = 60;  // from SIGTERM to SIGKILL, for a partial file

using Words = std::vector<std::string>;

std::string submitter() { return program_folder() + "/nullcone-submit"; }

std::string launched(const Settings& settings, const Words& command) {
  return (settings.launcher.empty() ? "" : settings.launcher + " ") + shell_line(command);
}

/// What a job asks for; 0: nothing.
struct Asked {
  int threads = 1, memory_mb = 0, minutes = 0;
};

/// sbatch as all our jobs call it; the user's own options follow. `log`: Slurm replaces what begins with % in
/// it.
Words sbatch(const Folder& folder, const Settings& settings, std::string log, const Asked& asked) {
  for (std::size_t at = 0; (at = log.find('%', at)) != log.npos; at += 2) log.insert(at, 1, '%');
  Words out = {"sbatch",
               "--parsable",
               "--job-name=nullcone-" + std::filesystem::path(folder.path()).filename().string(),
               "--chdir=" + folder.path(),
               "--requeue",
               "--nodes=1",
               "--ntasks=1",
               "--cpus-per-task=" + std::to_string(asked.threads),
               "--open-mode=append",
               "--output=" + log};
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) out.push_back(option + value);
  };
  const auto number = [](int value) { return value > 0 ? std::to_string(value) : ""; };
  const bool own_memory = std::ranges::any_of(
      settings.sbatch, [](const std::string& option) { return option.starts_with("--mem"); });
  add("--partition=", settings.partition);
  add("--account=", settings.account);
  add("--qos=", settings.qos);
  if (!own_memory) add("--mem=", number(asked.memory_mb));
  add("--time=", number(asked.minutes));
  return out;
}

/// `tasks` of a job, and the script that they run.
void add_script(Words& words, const Settings& settings, const Words& script) {
  words.insert(words.end(), settings.sbatch.begin(), settings.sbatch.end());
  words.insert(words.end(), script.begin(), script.end());
}

/// `arrays` share what may run at once.
std::string in_array(int tasks, int arrays, const Settings& settings) {
  const std::string out = "--array=0-" + std::to_string(tasks - 1);
  return settings.max_running > 0 ? out + "%" + std::to_string(std::max(1, settings.max_running / arrays))
                                  : out;
}

/// Jobs are written down when all are submitted; if one cannot be, or somebody stops this, those before it
/// end. What Slurm told the job in which this runs is not for others.
class SubmitScript {
 public:
  explicit SubmitScript(const std::string& jobs) {
    text_ = "#!/bin/sh\nset -eu\njobs=" + quoted(jobs) + R"(
for variable in $(env | sed -n 's/^\(SLURM_[A-Z0-9_]*\)=.*/\1/p'); do
  case $variable in SLURM_CONF*) ;; *) unset "$variable" ;; esac
done
ids= lines= after=afterany
give_up() { [ -z "$ids" ] || scancel $ids; }
trap give_up EXIT
trap 'exit 1' HUP INT TERM
)";
  }
  /// Slurm may say "id;cluster".
  void array(const Words& words, int first) {
    add(shell_line(words), "array", std::to_string(first));
    text_ += "after=$after:$id\n";
  }
  /// When all arrays, and these jobs, are over, however they end.
  void finish(const Words& words, const std::vector<std::string>& others = {}) {
    for (const std::string& other : others) text_ += "after=$after:" + other + "\n";
    add(shell_line(words), "finish", "");
    text_ += "printf %s \"$lines\" >\"$jobs.new\"\nmv \"$jobs.new\" \"$jobs\"\ntrap - EXIT\n";
  }
  const std::string& text() const { return text_; }

 private:
  void add(std::string command, const std::string& kind, const std::string& first) {
    if (kind == "finish") command.insert(command.find(' '), " --dependency=\"$after\"");
    text_ += "id=$(" + command + ")\nid=${id%%;*}\nids=\"$ids $id\"\nlines=\"${lines}" + kind + " $id " +
             first + "\n\"\n";
  }

  std::string text_;
};

/// Looking at a frame takes a tenth of tracing it at most; half an hour more for a scheduler that is away.
int finish_minutes(const Round& round, const Site& site) {
  if (round.minutes == 0) return 0;
  const double work_s = 0.1 * site.frames * round.settings.shards * round.piece_s / site.finish_threads;
  const int out = 40 + static_cast<int>(std::ceil(work_s / 60));
  return site.most_minutes > 0 ? std::min(out, site.most_minutes) : out;
}

int finish_memory(const Round& round, const Site& site) {
  constexpr int kRest_mb = 256, kThread_mb = 64;
  return round.memory_mb == 0 ? 0 : std::max(round.memory_mb, kRest_mb + kThread_mb * site.finish_threads);
}

std::string submit_script(const Folder& folder, const Round& round, const Site& site) {
  SubmitScript out(folder.round(round.number, "jobs"));
  const int largest = site.largest_array, arrays = (round.bundles + largest - 1) / largest;
  for (int first = 0; first < round.bundles; first += largest) {
    Words words = sbatch(folder, round.settings, folder.bundle(round.number, "slurm.log"),
                         {round.settings.threads, round.memory_mb, round.minutes});
    words.push_back(in_array(std::min(largest, round.bundles - first), arrays, round.settings));
    const int warning_s = round.minutes > 0 ? std::min(kWarning_s, 30 * round.minutes) : kWarning_s;
    words.push_back("--signal=B:TERM@" + std::to_string(warning_s));
    if (round.delay_s > 0) words.push_back("--begin=now+" + std::to_string(round.delay_s));
    add_script(words, round.settings, {folder.round(round.number, "array.sh"), std::to_string(first)});
    out.array(words, first);
  }
  Words words = sbatch(folder, round.settings, folder.bundle(round.number, "finish.log"),
                       {site.finish_threads, finish_memory(round, site), finish_minutes(round, site)});
  add_script(words, round.settings, {folder.round(round.number, "finish.sh")});
  out.finish(words, site.others);
  return out.text();
}

std::string array_script(const Folder& folder, const Round& round) {
  return "#!/bin/bash\n# A task: " + std::to_string(round.pieces.size()) + " pieces in " +
         std::to_string(round.bundles) + " bundles; $1 is that of task 0.\nexec " +
         launched(round.settings, {submitter(), "--task", folder.path(), "--round",
                                   std::to_string(round.number), "--bundle"}) +
         " \"$(($1 + SLURM_ARRAY_TASK_ID))\"\n";
}

std::string finish_script(const Folder& folder, const Round& round) {
  const std::string next = folder.round(round.number, "next");
  return "#!/bin/bash\n# When all tasks are over: merges, verifies, plans what is missing.\n" +
         launched(round.settings,
                  {submitter(), "--finish", folder.path(), "--round", std::to_string(round.number)}) +
         " --threads \"${SLURM_CPUS_PER_TASK:-1}\" || exit\n"
         "# What it could not submit itself, in a container.\nnext=" +
         quoted(next) +
         "\n[ ! -e \"$next\" ] || { script=$(cat \"$next\") && rm \"$next\" && sh \"$script\"; }\n";
}

}  // namespace

Scripts round_scripts(const Folder& folder, const Round& round, const Site& site) {
  return {{folder.round(round.number, "array.sh"), array_script(folder, round)},
          {folder.round(round.number, "finish.sh"), finish_script(folder, round)},
          {folder.round(round.number, "submit.sh"), submit_script(folder, round, site)}};
}

Scripts picture_scripts(const Folder& folder, const Settings& settings, const std::vector<int>& frames,
                        int tasks) {
  const auto runs = [&](std::int64_t first, std::int64_t end) {
    return runs_of({frames.begin() + first, frames.begin() + end});
  };
  const auto n = static_cast<std::int64_t>(frames.size());
  std::string some;  // a line a task
  for (int k = 0; k < tasks; ++k) some += runs(n * k / tasks, n * (k + 1) / tasks) + "\n";
  const std::string lists = folder.cluster("pictures.txt"), script = folder.cluster("pictures.sh"),
                    last = folder.cluster("movie.sh");
  Words array = sbatch(folder, settings, folder.cluster("pictures.log"), {settings.threads}), finish = array;
  array.push_back(in_array(tasks, 1, settings));
  add_script(array, settings, {script});
  add_script(finish, settings, {last});
  SubmitScript submit(folder.cluster("pictures.jobs"));
  submit.array(array, 0);
  submit.finish(finish);
  const std::string make = "exec " + launched(settings, picture_command(folder, settings));
  return {{lists, some},
          {script, "#!/bin/bash\n" + make + " --frames \"$(sed -n \"$((SLURM_ARRAY_TASK_ID + 1))p\" " +
                       quoted(lists) + ")\"\n"},
          {last, "#!/bin/bash\n# What a task has left out, and the movie.\n" + make + " --frames " +
                     runs(0, n) + " " + shell_line(movie_options(folder, settings)) + "\n"},
          {folder.cluster("pictures.submit.sh"), submit.text()}};
}

void write_scripts(const Scripts& scripts) {
  for (const auto& [name, text] : scripts) write_text(name, text);
}

}  // namespace nullcone::cluster
