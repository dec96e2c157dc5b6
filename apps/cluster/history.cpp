#include "apps/cluster/history.h"

#include <filesystem>

namespace nullcone::cluster {

std::vector<Attempt> attempts_at(const Folder& folder, const std::string& scene_sha256) {
  const int last = folder.last_round();
  int first = last + 1;
  while (first > 1 && read_round(folder, first - 1).scene_sha256 == scene_sha256) --first;
  return read_attempts(folder, first, last + 1);  // a trial comes before its round is written
}

History::History(const Folder& folder, const std::vector<Attempt>& attempts, const Round& round)
    : number_(round.number) {
  std::map<std::string, double> begun;  // of bundles of the last round
  for (const Attempt& attempt : attempts) {
    if (attempt.shards != round.settings.shards || attempt.round < round.chain) continue;
    add(attempt);
    if (attempt.round != number_) continue;
    const double first = begun.try_emplace(attempt.bundle, attempt.begun).first->second;
    out_of_time_ = out_of_time_ || (attempt.outcome == Outcome::interrupted && round.minutes > 0 &&
                                    attempt.ended - first >= 0.5 * 60 * round.minutes);
  }
  for (int number = round.chain; number < number_; ++number)
    if (const Round earlier = read_round(folder, number); earlier.chain == round.chain)
      add_silent_tasks(folder, earlier);
  add_silent_tasks(folder, round);
}

void History::add(Attempt attempt) {
  if (attempt.outcome == Outcome::open) {
    attempt.outcome = Outcome::failed;
    attempt.memory = true;
  }
  failures_[attempt.piece] += attempt.outcome == Outcome::failed;
  last_[attempt.piece] = std::move(attempt);
}

void History::add_silent_tasks(const Folder& folder, const Round& round) {
  for (int k = 0; k < round.bundles && !round.pieces.empty(); ++k) {
    const std::string bundle = std::to_string(k);
    if (std::filesystem::exists(folder.bundle(round.number, bundle + ".jsonl"))) continue;
    for (const std::int64_t piece : round.bundle(k)) {
      Attempt attempt;
      attempt.piece = piece, attempt.shards = round.settings.shards, attempt.round = round.number;
      attempt.bundle = "slurm";  // whose log may tell
      add(std::move(attempt));
    }
  }
}

int History::failures(std::int64_t piece) const {
  const auto found = failures_.find(piece);
  return found == failures_.end() ? 0 : found->second;
}

std::vector<Attempt> History::last_round(const std::vector<std::int64_t>& pieces) const {
  std::vector<Attempt> out;
  for (const std::int64_t piece : pieces)
    if (const auto found = last_.find(piece); found != last_.end() && found->second.round >= number_)
      out.push_back(found->second);
  return out;
}

}  // namespace nullcone::cluster
