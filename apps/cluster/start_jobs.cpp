#include "apps/cluster/start_jobs.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "apps/cluster/pictures.h"
#include "apps/cluster/scripts.h"
#include "apps/cluster/slurm.h"
#include "core/base/error.h"

namespace nullcone::cluster {

namespace {

/// The last line that is not empty.
std::string last_line(const std::string& text) {
  const std::string lines = text.substr(0, text.find_last_not_of('\n') + 1);
  return printable(lines.substr(lines.rfind('\n') + 1), 300);
}

/// Runs a script of ours that calls sbatch. False where somebody else shall.
bool run_submit_script(const std::string& script, const Submitting& how) {
  if (how.scripts_only || !has_slurm()) {
    if (!how.next.empty()) write_text(how.next, script + "\n");
    return false;
  }
  if (!how.lock.held())
    throw WorkError("lock", "was taken over by another nullcone-submit; nothing is submitted");
  const Captured said = capture({"sh", script});
  if (!said.end.good()) throw WorkError(script, "cannot submit: " + last_line(said.output + said.complaints));
  return true;
}

/// Jobs of rounds that wait or run.
std::vector<std::string> active_jobs(const Folder& folder) {
  std::vector<std::string> out;
  for (int number = folder.last_round(); number > 0; --number) {
    const std::vector<std::string> jobs = read_jobs(folder.round(number, "jobs")).ids();
    out.insert(out.end(), jobs.rbegin(), jobs.rend());  // the step that would try again goes first
  }
  std::erase_if(out, [](const std::string& job) { return !any_active({job}); });
  return out;
}

Site site_of(const TraceFrames& frames, const Settings& settings) {
  constexpr int kEnough = 4;
  const Nodes nodes = nodes_of(settings);
  const int threads = std::max(settings.threads, std::min(nodes.least_cores, kEnough));
  return {largest_array(), threads, nodes.most_minutes, static_cast<int>(frames.numbers().size())};
}

/// "1 frame", "2 frames".
std::string counted(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

void tell(const Folder& folder, const Round& round, bool submitted) {
  std::string asked;
  if (round.memory_mb > 0) asked += ", " + std::to_string(round.memory_mb) + " MB";
  if (round.minutes > 0) asked += ", " + std::to_string(round.minutes) + " min";
  const char* what = round.settings.shards > 1 ? "shard" : "frame";
  if (round.pieces.empty())
    std::printf("round %d: waits for the others\n", round.number);
  else
    std::printf("round %d: %s in %s%s%s\n", round.number, counted(round.pieces.size(), what).c_str(),
                counted(static_cast<std::size_t>(round.bundles), "task").c_str(), asked.c_str(),
                round.trial ? " (a trial, to measure)" : "");
  if (!submitted) {
    std::printf("submit with: sh %s\n", quoted(folder.round(round.number, "submit.sh")).c_str());
    return;
  }
  for (const std::string& id : read_jobs(folder.round(round.number, "jobs")).ids())
    std::printf("job %s\n", id.c_str());
}

}  // namespace

void start_round(const Folder& folder, const TraceFrames& frames, const Round& round, const Submitting& how) {
  Site site = site_of(frames, round.settings);
  if (round.pieces.empty()) site.others = active_jobs(folder);
  folder.create(round.number);
  write_text(folder.round(round.number, "plan.json"), round_to_json(round));
  write_scripts(round_scripts(folder, round, site));
  tell(folder, round, run_submit_script(folder.round(round.number, "submit.sh"), how));
}

void start_pictures(const Folder& folder, const TraceFrames& frames, const Settings& settings,
                    const Submitting& how) {
  const std::vector<int>& numbers = frames.numbers();
  std::printf("all %zu frames are there and verified\n", numbers.size());
  if (!settings.pictures || pictures_are_there(folder, settings, numbers)) return;
  const std::string jobs = folder.cluster("pictures.jobs");
  if (any_active(read_jobs(jobs).ids())) {
    if (!are_noted(folder, settings))
      throw WorkError(folder.path(),
                      "other pictures are being made; ask again when they are, or say --cancel");
    std::printf("pictures are being made\n");
    return;
  }
  std::filesystem::remove(jobs);
  std::filesystem::create_directories(std::filesystem::path(folder.pictures()).parent_path());
  constexpr int kLeast = 10, kUsual = 16;  // pictures a task; tasks where nobody knows how many can run
  const int most = static_cast<int>(numbers.size() + kLeast - 1) / kLeast, can_run = slots(settings);
  const int tasks = std::min({most, can_run > 0 ? can_run : kUsual, largest_array()});
  write_scripts(picture_scripts(folder, settings, numbers, tasks));
  note_pictures(folder, settings);
  const std::string script = folder.cluster("pictures.submit.sh");
  if (run_submit_script(script, how))
    std::printf("pictures: %s, job %s\n", counted(static_cast<std::size_t>(tasks), "task").c_str(),
                read_jobs(jobs).ids().front().c_str());
  else
    std::printf("submit with: sh %s\n", quoted(script).c_str());
}

void print_scripts(const Folder& folder, const TraceFrames& frames, const Round& round) {
  for (const auto& [name, text] : round_scripts(folder, round, site_of(frames, round.settings)))
    std::printf("# %s\n%s\n", name.c_str(), text.c_str());
}

int cancel(const Folder& folder) {
  refuse_unknown(folder);
  write_text(folder.cluster("cancelled"), std::to_string(folder.last_round()) + "\n");
  if (!has_slurm())
    throw InputError("scancel",
                     "is not on PATH; nothing more will be submitted, but end what was: its numbers "
                     "stand in " +
                         folder.cluster("*.jobs"));
  std::vector<std::string> jobs = active_jobs(folder),
                           pictures = read_jobs(folder.cluster("pictures.jobs")).ids();
  for (const std::string& job : pictures)
    if (any_active({job})) jobs.push_back(job);
  if (!jobs.empty()) {
    std::vector<std::string> words = {"scancel"};
    words.insert(words.end(), jobs.begin(), jobs.end());
    const Captured said = capture(words);
    if (!said.end.good()) throw WorkError("scancel", last_line(said.complaints));
  }
  std::printf("%s cancelled\n", counted(jobs.size(), "job").c_str());
  return 0;
}

bool is_cancelled(const Folder& folder, int round) {
  return std::atoi(read_text(folder.cluster("cancelled")).c_str()) >= round;
}

}  // namespace nullcone::cluster
