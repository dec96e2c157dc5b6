// What nullcone-submit plans, writes down and reads again, and its children; the whole is tested with Slurm.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "apps/cluster/child.h"
#include "apps/cluster/events.h"
#include "apps/cluster/history.h"
#include "apps/cluster/lock.h"
#include "apps/cluster/plan.h"
#include "apps/cluster/scripts.h"
#include "core/base/error.h"

namespace nullcone::cluster {
namespace {

namespace fs = std::filesystem;

struct TemporaryFolder {
  TemporaryFolder() { fs::create_directories(path); }
  ~TemporaryFolder() { fs::remove_all(path); }
  fs::path path = fs::temp_directory_path() / ("nullcone-cluster-" + std::to_string(::getpid()));
};

Round round_of(int pieces) {
  Round out;
  out.scene_sha256 = std::string(64, 'a');
  for (int i = 0; i < pieces; ++i) out.pieces.push_back(i);
  return out;
}

TEST(Plan, bundles_share_out_all_pieces) {
  Round round = round_of(23);
  for (round.bundles = 1; round.bundles <= 23; ++round.bundles) {
    std::vector<std::int64_t> all;
    std::size_t least = 23, most = 0;
    for (int k = 0; k < round.bundles; ++k) {
      const std::vector<std::int64_t> bundle = round.bundle(k);
      least = std::min(least, bundle.size()), most = std::max(most, bundle.size());
      all.insert(all.end(), bundle.begin(), bundle.end());
    }
    std::ranges::sort(all);
    EXPECT_EQ(all, round.pieces);
    EXPECT_LE(most, least + 1);
  }
}

TEST(Plan, is_read_as_it_was_written) {
  const TemporaryFolder temporary;
  const Folder folder(temporary.path.string());
  folder.create(7);
  Round round = round_of(0);
  round.number = 7, round.chain = 3, round.pieces = {0, 1, 2, 7, 9, 10}, round.bundles = 4;
  round.memory_mb = 300, round.minutes = 12, round.delay_s = 5, round.trial = true, round.begun = 1.5;
  round.progress = 0.1;
  round.settings.looks = {"a b", "'"};
  round.settings.launcher = "apptainer exec 'x y'";
  write_text(folder.round(7, "plan.json"), round_to_json(round));
  EXPECT_EQ(folder.last_round(), 7);
  const Round again = read_round(folder, 7);
  EXPECT_EQ(again.pieces, round.pieces);
  EXPECT_EQ(round_to_json(again), round_to_json(round));
  for (const char* bad : {"3-1", "1,1", "2,1", "x", "-1", "1-", "1;2", "0-999999999999"}) {
    std::string text = round_to_json(round);
    text.replace(text.find("0-2,7,9-10"), 10, bad);
    write_text(folder.round(7, "plan.json"), text);
    EXPECT_THROW(read_round(folder, 7), InputError) << bad;
  }
}

/// Tasks of `seconds` pieces each.
int bundles_of(int pieces, double seconds, int slots, int per_task = 0) {
  Round round = round_of(pieces);
  round.settings.per_task = per_task;
  size_round(round, {seconds, 100 << 20}, {.slots = slots}, nullptr, {});
  return round.bundles;
}

TEST(Plan, as_many_tasks_as_end_soonest) {
  // 50,000 s of work. With n tasks: n / 30 until all have begun, and then 50,000 / n.
  EXPECT_EQ(bundles_of(100'000, 0.5, 0), 1224);
  EXPECT_EQ(bundles_of(100'000, 0.5, 10'000), 1224);
  EXPECT_EQ(bundles_of(100'000, 0.5, 100), 100);  // 500 s each
  EXPECT_EQ(bundles_of(100'000, 0.5, 40), 160);   // 4 turns of 312 s
  EXPECT_EQ(bundles_of(100'000, 0.5, 8), 64);     // 8 turns
  EXPECT_EQ(bundles_of(250, 0.1, 2), 2);
  EXPECT_EQ(bundles_of(10, 0.1, 100), 5);
  EXPECT_EQ(bundles_of(3, 4000, 2), 3);
  EXPECT_EQ(bundles_of(3, 4000, 0), 3);  // never more than pieces
  EXPECT_EQ(bundles_of(250, 0.1, 2, 20), 13);
  EXPECT_EQ(bundles_of(250, 0, 2), 250);  // nobody knows
}

TEST(Plan, asks_for_more_after_a_failure) {
  Round before = round_of(10);
  size_round(before, {60, 1000 << 20}, {.slots = 2}, nullptr, {});
  EXPECT_EQ(before.memory_mb, 1250 + 64);
  EXPECT_EQ(before.bundles, 2);
  EXPECT_EQ(before.minutes, 5 + 15);  // three times 5 pieces of a minute
  Round next = round_of(1);
  size_round(next, {60, 1000 << 20}, {}, &before, {.memory = true});
  EXPECT_EQ(next.memory_mb, 2 * 1314);
  EXPECT_EQ(next.minutes, 5 + 3);
  size_round(next, {60, 1000 << 20}, {}, &next, {});  // what it has needed once
  EXPECT_EQ(next.memory_mb, 2 * 1314);
  size_round(next, {60, 1000 << 20}, {}, &before, {.time = true});
  EXPECT_EQ(next.memory_mb, 1314);
  EXPECT_EQ(next.minutes, 40);
  size_round(next, {60, 1000 << 20}, {.minutes = 30}, &before, {.time = true});  // the partition's limit
  EXPECT_EQ(next.minutes, 30);
  Round asked = round_of(1);
  asked.settings.memory_mb = 500, asked.settings.minutes = 7;
  size_round(asked, {}, {}, nullptr, {});
  EXPECT_EQ(asked.memory_mb, 500);
  EXPECT_EQ(asked.minutes, 7);
  size_round(next = asked, {}, {}, &asked, {.memory = true});
  EXPECT_EQ(next.memory_mb, 1000);
  size_round(next = asked, {}, {.memory_mb = 700}, &asked, {.memory = true});  // more than any node has
  EXPECT_EQ(next.memory_mb, 700);
  Round silent = round_of(1);  // nothing is measured or asked
  size_round(next = silent, {}, {}, &silent, {.memory = true, .peak_bytes = 100 << 20});
  EXPECT_EQ(next.memory_mb, 264);
  silent.settings.memory_mb = silent.settings.minutes = 0;
  size_round(silent, {60, 1000 << 20}, {}, nullptr, {});
  EXPECT_EQ(silent.memory_mb, 0);
  EXPECT_EQ(silent.minutes, 0);
}

TEST(Plan, tries_of_a_piece_count_together) {
  std::vector<Attempt> tries(3);
  for (Attempt& attempt : tries)
    attempt.piece = 4, attempt.seconds = 60, attempt.outcome = Outcome::interrupted;
  tries[2].seconds = 5, tries[2].outcome = Outcome::done;
  EXPECT_EQ(measured_cost(tries, 1).seconds, 125);
}

TEST(Plan, tasks_that_say_nothing_have_failed) {
  const TemporaryFolder temporary;
  const Folder folder(temporary.path.string());
  folder.create(1);
  Round round = round_of(6);
  round.bundles = 3;
  const EventLog events(folder, 1, "1");
  Attempt attempt;
  attempt.piece = 1;
  events.begin(attempt);  // and was killed; 4 is its next
  write_text(folder.round(1, "plan.json"), round_to_json(round));
  const History history(folder, attempts_at(folder, round.scene_sha256), round);
  for (const std::int64_t piece : {0, 1, 2, 3, 5}) EXPECT_EQ(history.failures(piece), 1) << piece;
  EXPECT_EQ(history.failures(4), 0);
  EXPECT_EQ(history.last(3).bundle, "slurm");
  EXPECT_TRUE(history.last(1).memory);
}

TEST(Events, outlive_torn_lines_and_requeued_tasks) {
  const TemporaryFolder temporary;
  const Folder folder(temporary.path.string());
  folder.create(2);
  write_text(folder.round(2, "plan.json"), "");
  const EventLog events(folder, 2, "4");
  Attempt first, second;
  first.piece = second.piece = 12;
  events.begin(first);
  std::ofstream(folder.bundle(2, "4.jsonl"), std::ios::app) << R"({"event":"end","piece":12,"outc)";
  events.begin(second);
  second.outcome = Outcome::done, second.peak_bytes = 5 << 20, second.seconds = 2.5;
  events.end(second);
  const std::vector<Attempt> found = read_attempts(folder, 1, 2);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].outcome, Outcome::open);
  EXPECT_EQ(found[1].outcome, Outcome::done);
  EXPECT_EQ(found[1].bundle, "4");
  EXPECT_EQ(found[1].round, 2);
  const Cost cost = measured_cost(found, 1);
  EXPECT_EQ(cost.seconds, 2.5);
  EXPECT_EQ(cost.peak_bytes, 5U << 20);
  EXPECT_FALSE(measured_cost(found, 2).known());
}

TEST(Child, tells_how_it_ended) {
  const Captured said = capture({"sh", "-c", "echo out; echo err >&2"});
  EXPECT_EQ(said.output, "out\n");
  EXPECT_EQ(said.complaints, "err\n");
  EXPECT_EQ(capture({"sh", "-c", "exit 7"}).end.status, 7);
  EXPECT_EQ(capture({"sh", "-c", "kill -9 $$"}).end.signal, 9);
  EXPECT_EQ(capture({"/nowhere/none"}).end.status, 127);
  EXPECT_EQ(capture({"/nowhere/none"}).complaints, "/nowhere/none: cannot be started\n");
  const ChildEnd end = capture({"sh", "-c", "i=0; while [ $i -lt 100000 ]; do i=$((i+1)); done"}).end;
  EXPECT_GT(end.core_seconds, 0.01);
  EXPECT_GE(end.seconds, 0.9 * end.core_seconds);
  EXPECT_GT(end.peak_bytes, 100'000U);
}

TEST(Child, is_asked_to_stop_and_waited_for) {
  const int nothing = ::open("/dev/null", O_WRONLY);
  const auto begun = std::chrono::steady_clock::now();
  const ChildEnd end = run_child(
      {"sh", "-c", "trap 'sleep 0.3; exit 3' TERM; while :; do sleep 0.05; done"}, {nothing, nothing},
      [&] { return std::chrono::steady_clock::now() - begun > std::chrono::milliseconds(200); });
  ::close(nothing);
  EXPECT_TRUE(end.stopped);
  EXPECT_EQ(end.status, 3);
}

TEST(Child, dies_with_us) {
  const TemporaryFolder temporary;
  const std::string note = (temporary.path / "note").string();
  const pid_t parent = ::fork();
  if (parent == 0) {
    capture({"sh", "-c",
             "trap 'echo ended >" + quoted(note) + "; exit' TERM; echo began >" + quoted(note) +
                 "; while :; do sleep 0.05; done"});
    ::_exit(0);
  }
  const auto says = [&](const std::string& word) {
    for (int i = 0; i < 200; ++i) {
      std::string found;
      std::ifstream(note) >> found;
      if (found == word) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return false;
  };
  EXPECT_TRUE(says("began"));
  ::kill(parent, SIGKILL);
  ::waitpid(parent, nullptr, 0);
  EXPECT_TRUE(says("ended"));
}

/// Leaves the lock of a process that is dead.
void die_with_lock(const Folder& folder) {
  const pid_t child = ::fork();
  if (child == 0) {
    const SubmissionLock lock(folder, 0);
    ::_exit(0);  // without giving it back
  }
  ::waitpid(child, nullptr, 0);
}

TEST(Lock, has_one_holder) {
  const TemporaryFolder temporary;
  const Folder folder(temporary.path.string());
  folder.create();
  EXPECT_FALSE(is_locked(folder));
  {
    const SubmissionLock lock(folder, 0);
    EXPECT_TRUE(is_locked(folder));
    EXPECT_THROW(SubmissionLock(folder, 0.2), WorkError);
  }
  EXPECT_FALSE(is_locked(folder));
  die_with_lock(folder);
  for (int i = 0; i < 8; ++i)  // each in turn; names of claims differ by process only, so these are forked
    if (const pid_t child = ::fork(); child == 0) {
      try {
        const SubmissionLock lock(folder, 20);
        std::ofstream(folder.cluster("mark"), std::ios::app) << "in ";
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        std::ofstream(folder.cluster("mark"), std::ios::app) << "out ";
      } catch (const std::exception&) {
        ::_exit(1);
      }
      ::_exit(0);
    }
  for (int i = 0; i < 8; ++i) {
    int status = 0;
    ::wait(&status);
    EXPECT_EQ(status, 0);
  }
  std::ifstream in(folder.cluster("mark"));
  std::string first, second;
  int turns = 0;
  while (in >> first >> second) turns += first == "in" && second == "out";
  EXPECT_EQ(turns, 8);
}

TEST(Lock, of_the_dead_is_taken_over) {
  const TemporaryFolder temporary;
  const Folder folder(temporary.path.string());
  folder.create();
  die_with_lock(folder);
  EXPECT_TRUE(fs::exists(folder.cluster("lock")));
  EXPECT_FALSE(is_locked(folder));
  { const SubmissionLock lock(folder, 0); }
  EXPECT_FALSE(fs::exists(folder.cluster("lock")));

  for (const char* text : {"elsewhere\n1\nboot/pid\n5\n", "torn", ""}) {
    write_text(folder.cluster("lock"), text);
    EXPECT_TRUE(is_locked(folder));  // its time is new
    EXPECT_THROW(SubmissionLock(folder, 0), WorkError);
    fs::last_write_time(folder.cluster("lock"), fs::file_time_type::clock::now() - std::chrono::minutes(3));
    EXPECT_FALSE(is_locked(folder));
    { const SubmissionLock lock(folder, 0); }
  }
  EXPECT_TRUE(fs::is_empty(folder.cluster("")));
}

TEST(Scripts, pass_words_through_a_shell) {
  for (const char* word : {"", "a b", "it's", "$(exit 1)", "`x`", "a\nb", "\"", "\\", "*", "~", "-n"})
    EXPECT_EQ(capture({"sh", "-c", "printf %s " + quoted(word)}).output, word);
}

}  // namespace
}  // namespace nullcone::cluster
