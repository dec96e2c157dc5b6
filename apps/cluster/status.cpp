#include "apps/cluster/status.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>

#include "apps/cluster/lock.h"
#include "apps/cluster/pictures.h"
#include "apps/cluster/rounds.h"
#include "apps/cluster/slurm.h"
#include "core/base/error.h"

namespace nullcone::cluster {

namespace {

constexpr std::size_t kSlowest = 5, kRecent = 100;

/// What a finished frame tells of itself.
struct Done {
  int frame = 0;
  double core_seconds = 0, finished = 0;
  std::string host, isa;
};

/// By the headers alone: what is there, and of this scene.
std::vector<Done> finished(const TraceFrames& frames) {
  std::vector<Done> all(frames.numbers().size());
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    const int frame = frames.numbers()[i];
    const std::string file = frames.whole_file(frame);
    all[i].frame = -1;
    if (!unlike(file, frames.scene(frame), {}).empty()) return;
    try {
      const Manifest manifest = read_manifest(file);
      all[i] = {frame, manifest.effort.core_seconds, modified(file), manifest.host, manifest.isa};
    } catch (const std::exception&) {  // it went away just now
    }
  });
  std::erase_if(all, [](const Done& done) { return done.frame < 0; });
  return all;
}

void add_hosts(Status& out, std::vector<Done> done) {
  for (const Done& frame : done) {
    HostStatus& host = out.hosts[frame.host];
    host.isa = frame.isa;
    ++host.frames;
    host.core_seconds += frame.core_seconds;
    host.most = std::max(host.most, frame.core_seconds);
    out.core_seconds += frame.core_seconds;
  }
  std::ranges::sort(done, std::ranges::greater{}, &Done::core_seconds);
  for (std::size_t i = 0; i < std::min(kSlowest, done.size()); ++i)
    out.slowest.push_back({done[i].frame, done[i].core_seconds, done[i].host});
}

/// Of the last frames that came since the chain began.
void add_rate(Status& out, std::vector<Done> done, double begun) {
  std::ranges::sort(done, std::ranges::greater{}, &Done::finished);
  std::erase_if(done, [&](const Done& frame) { return frame.finished < begun; });
  if (done.empty()) return;
  const std::size_t count = std::min(done.size(), kRecent);
  const double since = done.size() > kRecent ? done[kRecent].finished : begun;
  const double until = out.done == out.frames || !out.working ? done.front().finished : now();
  if (until <= since) return;
  out.per_minute = 60 * static_cast<double>(count) / (until - since);
  out.left_s = 60 * (out.frames - out.done) / out.per_minute;
}

/// Frames, of pieces.
std::set<int> frames_of(const std::vector<std::int64_t>& pieces, int shards) {
  std::set<int> out;
  for (const std::int64_t piece : pieces) out.insert(piece_of(piece, shards).frame);
  return out;
}

/// Who works, and what was tried in vain.
void add_work(Status& out, const Folder& folder, const Round& round, const std::set<int>& done) {
  const int shards = round.settings.shards;
  std::map<std::int64_t, int> failures;
  std::set<int> running, failed;
  const std::vector<std::int64_t> queued = queued_pieces(folder, shards);
  const bool here = is_locked(folder);
  for (const Attempt& attempt : read_attempts(folder, round.chain, round.number)) {
    const int frame = piece_of(attempt.piece, shards).frame;
    const bool works = attempt.outcome == Outcome::open && attempt.round == round.number &&
                       !done.contains(frame) && (here || std::ranges::binary_search(queued, attempt.piece));
    if (works) running.insert(frame);
    const bool bad = attempt.outcome == Outcome::failed || (attempt.outcome == Outcome::open && !works);
    out.tries_failed += bad;
    failures[attempt.piece] += bad;
    if (failures[attempt.piece] >= round.settings.tries && !done.contains(frame)) failed.insert(frame);
  }
  std::set<int> waiting = frames_of(here && queued.empty() ? round.pieces : queued, shards);
  std::erase_if(waiting, [&](int frame) { return done.contains(frame) || running.contains(frame); });
  out.running = static_cast<int>(running.size()), out.failed = static_cast<int>(failed.size());
  out.waiting = static_cast<int>(waiting.size());
  for (int number = 1; number <= round.number; ++number) {
    if (std::filesystem::exists(folder.round(number, "over"))) continue;
    std::ranges::copy(held_tasks(read_jobs(folder.round(number, "jobs")).ids()),
                      std::back_inserter(out.held));
  }
  out.working = here || !queued.empty() || any_active(read_jobs(folder.round(round.number, "jobs")).ids()) ||
                any_active(read_jobs(folder.cluster("pictures.jobs")).ids());
}

}  // namespace

Status status_of(const Folder& folder) {
  Status out;
  refuse_unknown(folder);
  out.round = folder.last_round();
  const Round round = read_round(folder, out.round);
  const TraceFrames frames(folder.scene(), folder.data(), round.settings.frames);
  const std::vector<Done> done = finished(frames);
  out.frames = static_cast<int>(frames.numbers().size());
  out.done = static_cast<int>(done.size());
  if (round.settings.pictures) out.pictures = count_pictures(folder, round.settings, frames.numbers());
  std::set<int> names;
  for (const Done& frame : done) names.insert(frame.frame);
  add_work(out, folder, round, names);
  add_rate(out, done, read_round(folder, round.chain).begun);
  add_hosts(out, done);
  return out;
}

}  // namespace nullcone::cluster
