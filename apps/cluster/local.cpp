#include "apps/cluster/local.h"

#include <fcntl.h>
#include <tbb/info.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <mutex>
#include <thread>

#include "apps/cluster/pictures.h"
#include "apps/cluster/trace_pieces.h"
#include "apps/stop_signals.h"
#include "core/base/error.h"
#include "core/base/frame_numbers.h"
#include "core/record/whole_file.h"

namespace nullcone::cluster {

namespace {

bool stopped() { return stop_wanted; }

/// Pieces done and time left, on one line of a terminal.
class Talk {
 public:
  Talk(const Round& round, bool quiet) : all_(round.pieces.size()), quiet_(quiet) {}

  void done(const Attempt& attempt) {
    const std::lock_guard hold(mutex_);
    if (quiet_) return;
    const double seconds = now() - begun_;
    const auto left = static_cast<double>(all_ - ++done_);
    std::fprintf(stderr, "\r%zu of %zu pieces, %.0f s left   ", done_, all_,
                 seconds * left / static_cast<double>(done_));
    if (attempt.outcome == Outcome::failed)
      std::fprintf(stderr, "\npiece %lld failed (cluster/ has its log)\n",
                   static_cast<long long>(attempt.piece));
    if (done_ == all_) std::fputc('\n', stderr);
  }

 private:
  std::size_t all_, done_ = 0;
  bool quiet_;
  double begun_ = now();
  std::mutex mutex_;
};

/// Pieces of a round, one after the other, as long as there are any.
void work(const Folder& folder, const Round& round, int worker, std::atomic<std::size_t>& next, Talk& talk) {
  const std::string name = "local-" + std::to_string(worker);
  const EventLog events(folder, round.number, name);
  const std::string path = folder.bundle(round.number, name + ".log");
  const Descriptor log(path, O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW);
  for (std::size_t i = 0; !stop_wanted && (i = next++) < round.pieces.size();) try {
      talk.done(trace_piece(folder, round.settings, round.pieces[i], events,
                            log ? log.number() : STDERR_FILENO, stopped));
    } catch (const WorkError& error) {  // no more processes, say: its begin without an end is a failure
      std::fprintf(stderr, "\n%s\n", error.what());
    }
}

/// All pieces of a round, by so many at once.
void trace_all(const Folder& folder, const Round& round, int jobs, bool quiet) {
  std::atomic<std::size_t> next = 0;
  Talk talk(round, quiet);
  std::vector<std::jthread> workers;  // children end with the thread that made them, so these last
  for (int k = 0; k < std::min(jobs, static_cast<int>(round.pieces.size())); ++k)
    workers.emplace_back([&, k] { work(folder, round, k, next, talk); });
}

void wait(int seconds) {
  const double end = now() + seconds;
  while (!stop_wanted && now() < end) std::this_thread::sleep_for(std::chrono::milliseconds(100));
}

int interrupted() {
  std::fprintf(stderr, "nullcone-submit: interrupted; the same command goes on\n");
  return 3;
}

/// Of all frames at once: the tool itself uses all cores.
int make_pictures(const Folder& folder, const TraceFrames& frames, Settings settings) {
  const std::vector<int>& numbers = frames.numbers();
  if (!settings.pictures || pictures_are_there(folder, settings, numbers)) return 0;
  note_pictures(folder, settings);
  settings.threads = 0;
  std::filesystem::create_directories(std::filesystem::path(folder.pictures()).parent_path());
  std::vector<std::string> words = picture_command(folder, settings);
  words.insert(words.end(), {"--frames", runs_of({numbers.begin(), numbers.end()})});
  for (const std::string& word : movie_options(folder, settings)) words.push_back(word);
  const ChildEnd end = run_child(words, {STDERR_FILENO, STDERR_FILENO}, stopped);
  if (end.stopped) return interrupted();
  return end.good() ? 0 : 1;
}

}  // namespace

int work_locally(const Folder& folder, const TraceFrames& frames, Round round, int jobs, bool quiet) {
  using Next = Verdict::Next;
  if (jobs == 0) jobs = std::max(1, tbb::info::default_concurrency() / std::max(round.settings.threads, 1));
  const int threads = jobs * std::max(round.settings.threads, 1);
  for (;;) {
    const Verdict verdict = judge(folder, frames, round, {.capacity = {.slots = jobs}, .threads = threads});
    if (verdict.next == Next::interrupted) return interrupted();
    const std::string given_up = report(folder, round.settings, verdict.given_up);
    if (verdict.next == Next::complete) std::filesystem::remove(folder.cluster("failed.txt"));
    if (verdict.next == Next::complete) return make_pictures(folder, frames, round.settings);
    if (verdict.next == Next::end) {
      std::fprintf(stderr, "%snullcone-submit: %s: frames are missing: %s\n", given_up.c_str(),
                   folder.path().c_str(), verdict.why.c_str());
      return 1;
    }
    wait(verdict.round.delay_s);
    if (verdict.more_memory) jobs = std::max(1, jobs / 2);
    round = verdict.round;
    round.bundles = 0;  // none: whoever is free takes the next piece
    folder.create(round.number);
    write_text(folder.round(round.number, "plan.json"), round_to_json(round));
    trace_all(folder, round, jobs, quiet);
    if (stop_wanted) return interrupted();
    merge_shards(frames, round.settings.shards, threads);
  }
}

}  // namespace nullcone::cluster
