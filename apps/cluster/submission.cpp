#include "apps/cluster/submission.h"

#include <fcntl.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "apps/cluster/local.h"
#include "apps/cluster/scene_source.h"
#include "apps/cluster/slurm.h"
#include "apps/cluster/start_jobs.h"
#include "apps/cluster/trace_pieces.h"
#include "apps/stop_signals.h"
#include "core/base/error.h"
#include "core/record/whole_file.h"

namespace nullcone::cluster {

namespace {

constexpr double kPatience_s = 10, kPatienceOfJob_s = 6 * 3600, kTrial_s = 60;
constexpr int kReadingThreads = 4;  // where people submit

using Next = Verdict::Next;

/// Comes back when the jobs of other rounds are over.
void start_waiting(const Folder& folder, const TraceFrames& frames, Round round, const Submitting& how) {
  round.number = folder.last_round() + 1, round.begun = now();
  round.pieces.clear(), round.bundles = 0, round.delay_s = 0, round.trial = false;
  start_round(folder, frames, round, how);
}

int carry_out(const Folder& folder, const TraceFrames& frames, const Round& before, const Verdict& verdict,
              const Submitting& how) {
  if (stop_wanted || verdict.next == Next::interrupted) return 3;
  const std::string given_up = report(folder, before.settings, verdict.given_up);
  switch (verdict.next) {
    case Next::interrupted:
      return 3;
    case Next::complete:
      std::filesystem::remove(folder.cluster("failed.txt"));
      start_pictures(folder, frames, before.settings, how);
      return 0;
    case Next::wait: {
      std::printf("what is missing is in jobs that wait or run\n");
      const bool same =
          !how.next.empty() ? false : same_request(read_round(folder, folder.last_round()), before);
      if (!same) start_waiting(folder, frames, before, how);
      return 0;
    }
    case Next::again:
      start_round(folder, frames, verdict.round, how);
      return 0;
    case Next::end:
      break;
  }
  std::printf("%s", given_up.c_str());
  std::fprintf(stderr, "nullcone-submit: %s: frames are missing: %s\n", folder.path().c_str(),
               verdict.why.c_str());
  return 1;
}

/// Traces the trial's piece here, up to a minute of it. Throws WorkError if it fails.
void trace_trial(const Folder& folder, const Round& round, bool quiet) {
  folder.create(round.number);
  const EventLog events(folder, round.number, "trial");
  const std::string path = folder.bundle(round.number, "trial.log");
  const Descriptor log(path, O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW);
  if (!log) throw WorkError(path, "cannot write there");
  const auto [frame, shard] = piece_of(round.pieces.front(), round.settings.shards);
  if (!quiet) std::fprintf(stderr, "tracing frame %d here, to see what it takes\n", frame);
  const double end = now() + kTrial_s;
  const Attempt attempt = trace_piece(folder, round.settings, round.pieces.front(), events, log.number(),
                                      [end] { return stop_wanted || now() > end; });
  if (attempt.outcome == Outcome::failed) {
    const std::vector<std::string> words = last_words(folder, attempt, 1);
    throw WorkError("trial of frame " + std::to_string(frame),
                    words.empty() ? "failed; see " + path : printable(words.front(), 400));
  }
  if (!quiet && attempt.outcome == Outcome::done)
    std::fprintf(stderr, "it took %.2f s and %.0f MB\n", attempt.seconds,
                 static_cast<double>(attempt.peak_bytes) / (1 << 20));
}

/// Of Slurm; `over`: a round whose tasks are over.
Others others_at(const Folder& folder, const Settings& settings, int threads, int over = 0) {
  const Nodes nodes = nodes_of(settings);
  return {.queued = queued_pieces(folder, settings.shards, over),
          .capacity = {slots(settings), nodes.most_memory_mb, nodes.most_minutes},
          .threads = threads};
}

int dry_run(const Folder& folder, const TraceFrames& frames, Round wanted) {
  if (wanted.settings.trial == "here") wanted.settings.trial = "none";
  const Verdict verdict = judge(folder, frames, wanted, others_at(folder, wanted.settings, kReadingThreads));
  if (verdict.next != Next::again) {
    std::printf("# %s\n", verdict.next == Next::complete ? "all frames are there and verified"
                          : verdict.next == Next::wait   ? "what is missing is in jobs that wait or run"
                                                         : verdict.why.c_str());
    return verdict.next == Next::interrupted ? 3 : 0;
  }
  const Round& round = verdict.round;
  std::printf("# %zu pieces in %d tasks%s\n", round.pieces.size(), round.bundles,
              round.piece_s == 0 ? "; a trial would tell how many fit a task, and its memory and time" : "");
  print_scripts(folder, frames, round);
  return 0;
}

Round request(const Folder& folder, const SceneSource& scene, const Settings& settings) {
  Round out;
  out.number = out.chain = folder.last_round() + 1;
  out.settings = settings, out.scene_sha256 = scene.sha256;
  return out;
}

/// Jobs that must end before this is begun.
void refuse_other_work(const Folder& folder, const SceneSource& scene, bool local) {
  const int last = folder.last_round();
  if (last == 0 || !any_active(read_jobs(folder.round(last, "jobs")).ids())) return;
  if (local) throw WorkError(folder.path(), "jobs wait or run there; end them with --cancel");
  if (read_round(folder, last).scene_sha256 != scene.sha256)
    throw WorkError(folder.path(), "jobs of another scene wait or run there; end them with --cancel");
}

int finish_once(const Folder& folder, int number, int threads) {
  const SubmissionLock lock(folder, kPatienceOfJob_s);
  const Round round = read_round(folder, number);
  write_text(folder.round(number, "over"), "");
  const SceneSource scene(folder.scene());
  if (scene.sha256 != round.scene_sha256) {
    std::printf("the folder has another scene now\n");
    return 0;
  }
  const TraceFrames frames(folder.scene(), scene.file, folder.data(), round.settings.frames);
  merge_shards(frames, round.settings.shards, threads);
  Others others = others_at(folder, round.settings, threads, number);
  others.cancelled = cancelled_waiting(folder, number) || is_cancelled(folder, number);
  return carry_out(folder, frames, round, judge(folder, frames, round, others),
                   {.lock = lock, .next = folder.round(number, "next")});
}

}  // namespace

int submit(const SubmitOptions& options) {
  catch_stop_signals();
  const Folder folder(options.output);
  SceneSource scene(options.scene);
  const Settings& settings = options.settings;
  const auto frames_from = [&](const std::string& path) {
    return TraceFrames(path, scene.file, folder.data(), settings.frames);
  };
  scene.pin_meshes(frames_from(scene.file.path));
  const TraceFrames given = frames_from(scene.file.path);
  check_scenes(given, settings.shards);
  if (options.dry_run) return dry_run(folder, given, request(folder, scene, settings));
  if (!options.local && !options.scripts_only && !has_slurm())
    throw InputError("sbatch", "is not on PATH; expected Slurm, or --local or --scripts-only");
  folder.create();
  const SubmissionLock lock(folder, kPatience_s);
  if (!options.replace) refuse_strangers(given, kReadingThreads);
  refuse_other_work(folder, scene, options.local);
  adopt(scene, folder);
  const TraceFrames frames = frames_from(folder.scene());  // with the folder's meshes
  merge_shards(frames, settings.shards, kReadingThreads);
  const Round wanted = request(folder, scene, settings);
  if (options.local) return work_locally(folder, frames, wanted, options.jobs, options.quiet);

  const Others others = others_at(folder, settings, kReadingThreads);
  Verdict verdict = judge(folder, frames, wanted, others);
  if (verdict.next == Next::again && verdict.round.trial && settings.trial == "here") {
    trace_trial(folder, verdict.round, options.quiet);
    if (stop_wanted) return 3;
    verdict = judge(folder, frames, wanted, others);
  }
  return carry_out(folder, frames, wanted, verdict, {.lock = lock, .scripts_only = options.scripts_only});
}

int finish_round(const Folder& folder, int number, int threads) {
  catch_stop_signals();
  refuse_unknown(folder);
  constexpr std::array kPauses_s = {10, 60, 300};  // a scheduler that is away, a disk that is full
  for (std::size_t i = 0;; ++i) try {
      return finish_once(folder, number, threads);
    } catch (const WorkError& error) {
      if (i == kPauses_s.size() || stop_wanted) throw;
      std::fprintf(stderr, "%s; again in %d s\n", error.what(), kPauses_s[i]);
      for (const double end = now() + kPauses_s[i]; now() < end && !stop_wanted;)
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
}

}  // namespace nullcone::cluster
