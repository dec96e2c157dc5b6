#include "apps/cluster/rounds.h"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "apps/cluster/history.h"
#include "apps/cluster/trace_pieces.h"
#include "core/base/error.h"

namespace nullcone::cluster {

namespace {

std::string file_of(const TraceFrames& frames, std::int64_t number, int shards) {
  const auto [frame, shard] = piece_of(number, shards);
  const std::string whole = frames.whole_file(frame);
  return shards > 1 ? shard_path(whole, {shard, shards}) : whole;
}

/// What an interrupted try has left, of 1.
double part_of(const std::string& file) {
  const std::string partial = partial_path(file);
  std::error_code error;
  if (!std::filesystem::exists(partial, error)) return 0;
  try {
    const Manifest manifest = read_manifest(partial);
    return static_cast<double>(manifest.traced_lines) / manifest.lines;
  } catch (const std::exception&) {
    return 0;
  }
}

std::vector<std::int64_t> minus(const std::vector<std::int64_t>& from,
                                const std::vector<std::int64_t>& what) {
  std::vector<std::int64_t> out;
  std::ranges::set_difference(from, what, std::back_inserter(out));
  return out;
}

/// One piece, to be measured.
void make_trial(Round& round, const Round& before) {
  const std::vector<std::int64_t> others = minus(round.pieces, before.pieces);
  const std::vector<std::int64_t> tried = minus(round.pieces, others);
  round.pieces = {tried.empty() ? round.pieces[round.pieces.size() / 2] : tried.front()};
  round.trial = true;
}

/// What is missing and may be tried becomes the round's; the rest is given up.
void share_out(Verdict& out, const History& history, const std::vector<std::int64_t>& missing) {
  for (const std::int64_t piece : missing)
    if (history.failures(piece) < out.round.settings.tries)
      out.round.pieces.push_back(piece);
    else
      out.given_up.push_back(history.last(piece));
}

std::string ending_of(const Attempt& attempt) {
  if (attempt.host.empty()) return "without a word of its task (cluster/*/slurm.log)";
  return "on " + printable(attempt.host, 60) +
         (attempt.signal > 0   ? ": ended by signal " + std::to_string(attempt.signal)
          : attempt.ended == 0 ? ": killed with its task"
                               : ": exit status " + std::to_string(attempt.status));
}

/// Why nothing more shall be tried; empty where something shall.
std::string reason_to_end(const Verdict& verdict, const Round& before, const Others& others, bool failures) {
  if (verdict.round.pieces.empty()) return "what is missing has failed too often";
  if (others.cancelled) return "tasks were cancelled while they waited";
  const bool first = before.pieces.empty();
  if (!first && !failures && verdict.round.progress <= before.progress)
    return "a whole round brought nothing";
  return "";
}

}  // namespace

std::optional<Survey> survey(const TraceFrames& frames, int shards, int threads) {
  const auto missing = missing_pieces(frames, shards > 1 ? shards : 0, threads);
  if (!missing) return std::nullopt;
  Survey out{*missing, static_cast<double>(frames.numbers().size()) * shards};
  out.progress -= static_cast<double>(missing->size());
  for (const std::int64_t piece : out.missing) out.progress += part_of(file_of(frames, piece, shards));
  return out;
}

Verdict judge(const Folder& folder, const TraceFrames& frames, const Round& before, const Others& others) {
  using Next = Verdict::Next;
  const Settings& settings = before.settings;
  const auto there = survey(frames, settings.shards, others.threads);
  const auto whole = settings.shards > 1 ? survey(frames, 1, others.threads) : there;
  Verdict out;
  if (!there || !whole) return {.next = Next::interrupted};
  if (whole->missing.empty()) return out;
  if (there->missing.empty()) return {.next = Next::end, .why = "the shards are there, but cannot be merged"};

  const std::vector<Attempt> attempts = attempts_at(folder, before.scene_sha256);
  const History history(folder, attempts, before);
  Round& round = out.round = before;
  round.number = folder.last_round() + 1, round.begun = now(), round.progress = there->progress;
  round.pieces.clear(), round.trial = false;
  share_out(out, history, minus(there->missing, others.queued));
  if (round.pieces.empty() && out.given_up.empty()) return {.next = Next::wait};

  const std::vector<Attempt> tried = history.last_round(round.pieces);
  const bool failures = !out.given_up.empty() || std::ranges::any_of(tried, [](const Attempt& attempt) {
    return attempt.outcome == Outcome::failed;
  });
  out.why = reason_to_end(out, before, others, failures);
  out.next = out.why.empty() ? Next::again : Next::end;
  if (out.next == Next::end) return out;
  const Cost cost = measured_cost(attempts, settings.shards);
  if (!cost.known() && settings.trial != "none") make_trial(round, before);
  Needs needs;
  for (const Attempt& attempt : tried)
    if (attempt.memory)
      needs.memory = true, needs.peak_bytes = std::max(needs.peak_bytes, attempt.peak_bytes);
  needs.time = history.out_of_time();
  out.more_memory = needs.memory;
  round.delay_s = failures ? settings.retry_delay_s : 0;
  size_round(round, cost, others.capacity, before.pieces.empty() ? nullptr : &before, needs);
  return out;
}

std::string report(const Folder& folder, const Settings& settings, const std::vector<Attempt>& given_up) {
  const std::string path = folder.cluster("failed.txt");
  if (given_up.empty()) return "";
  constexpr std::size_t kLines = 10;
  std::string out;
  for (const Attempt& attempt : given_up) {
    const auto [frame, shard] = piece_of(attempt.piece, settings.shards);
    out += "frame " + std::to_string(frame);
    if (settings.shards > 1)
      out += ", shard " + std::to_string(shard) + "/" + std::to_string(settings.shards);
    out += ": failed " + std::to_string(settings.tries) + " times, last " + ending_of(attempt) + "\n";
    for (const std::string& line : last_words(folder, attempt, kLines))
      out += "    " + printable(line, 300) + "\n";
    out += "  again: " + shell_line(trace_command(folder, settings, attempt.piece)) + "\n";
  }
  write_text(path, out);
  return out;
}

}  // namespace nullcone::cluster
