// Files that are whole or not there: leftovers of killed writers, several writers of one name, strangers.
#include <sys/inotify.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <array>
#include <csignal>
#include <cstring>
#include <functional>
#include <optional>

#include "core/record/whole_file.h"
#include "tests/dataset_fixture.h"

namespace {
std::function<void()> before_lock;  // what others do just before somebody gets a lock
}
/// In the place of the C library's.
extern "C" int flock(int file, int operation) noexcept {
  if (before_lock) std::exchange(before_lock, nullptr)();
  return static_cast<int>(::syscall(SYS_flock, file, operation));
}

namespace nullcone::test {
namespace {

/// Starts a child process that runs `work`; its exit status is 1 where that throws.
template <class Work>
pid_t start(Work&& work) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  try {
    work();
  } catch (...) {
    ::_exit(1);
  }
  ::_exit(0);
}
int end_of(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

class WholeFiles : public DatasetFile {
 protected:
  using Names = std::vector<std::string>;

  static void write_text(const std::string& to, const std::string& text) {
    WholeFile file(to);
    file.stream() << text;
    file.finish();
  }
  /// A process that has begun to write is killed.
  void kill_a_writer() const {
    const pid_t child = start([&] {
      WholeFile part(path);
      part.stream() << "half of it";
      part.stream().flush();
      ::raise(SIGKILL);
    });
    EXPECT_EQ(end_of(child), 128 + SIGKILL);
  }
};

TEST_F(WholeFiles, WhatAKilledProcessLeftIsRemovedByTheNextWrite) {
  kill_a_writer();
  EXPECT_EQ(listing(), Names{"a.exr.part-nullcone-0"});
  write_text(folder / "b.exr", "b");  // another name: not its affair
  EXPECT_EQ(listing().size(), 2u);
  write_text(path, "whole");
  EXPECT_EQ(listing(), (Names{"a.exr", "b.exr"}));
}

TEST_F(WholeFiles, LeftoversAreFoundBehindAGap) {
  {
    const WholeFile first(path), second(path), third(path);
    kill_a_writer();
  }
  EXPECT_EQ(listing(), Names{"a.exr.part-nullcone-3"});
  write_text(path, "whole");
  EXPECT_EQ(listing(), Names{"a.exr"});
}

TEST_F(WholeFiles, WhatIsBeingWrittenOrIsNoPartIsLeftAlone) {
  const Names strangers = {"a.exr.part-2", "a.exr.part-nullcone-x", "xa.exr.part-nullcone-1"};
  for (const std::string& name : strangers) std::ofstream(folder / name) << "precious";
  fs::create_directories(folder / "a.exr.part-nullcone-0");
  fs::create_symlink("xa.exr.part-nullcone-1", folder / "a.exr.part-nullcone-1");
  ASSERT_EQ(::mkfifo((folder / "a.exr.part-nullcone-2").c_str(), 0600), 0);
  Names all = listing();
  WholeFile first(path);
  first.stream() << "first";
  EXPECT_EQ(end_of(start([&] { write_text(path, "another process"); })), 0);
  write_text(path, "and this one again");
  EXPECT_EQ(listing().size(), all.size() + 2);
  first.finish();
  EXPECT_EQ(slurp(path), "first");
  all.insert(all.begin(), "a.exr");
  EXPECT_EQ(listing(), all);
}

TEST_F(WholeFiles, WhatIsNotFinishedIsRemoved) {
  { WholeFile(path).stream() << "half"; }
  EXPECT_EQ(listing(), Names{});
}

/// Where locks do not reach other hosts, a living part may be taken for a leftover, and its name given away.
TEST_F(WholeFiles, AnotherWritersPartIsNeverRenamedOrRemoved) {
  const fs::path part = folder / "a.exr.part-nullcone-0";
  {
    WholeFile file(path);
    file.stream() << "mine";
    fs::remove(part);
    std::ofstream(part) << "half of another one's";
    EXPECT_THROW(file.finish(), WorkError);
  }
  EXPECT_EQ(listing(), Names{part.filename()});
  EXPECT_EQ(slurp(part), "half of another one's");
}

TEST_F(WholeFiles, ManyWritersOfOneNameDoNotDisturbEachOther) {
  const std::string text(5000, 'x');
  const auto write_often = [&] {
    for (int i = 0; i < 300; ++i) write_text(path, text);
  };
  const std::vector<pid_t> writers = {start(write_often), start(write_often)};
  for (int i = 0; i < 30; ++i) {  // and some who do not come to an end
    const pid_t killed = start(write_often);
    ::usleep(3000);
    ::kill(killed, SIGKILL);
    ::waitpid(killed, nullptr, 0);
    if (fs::exists(path)) {
      EXPECT_EQ(slurp(path), text);
    }
  }
  for (const pid_t writer : writers) EXPECT_EQ(end_of(writer), 0);
  write_text(path, text);
  EXPECT_EQ(listing(), Names{"a.exr"});
}

TEST_F(WholeFiles, APartThatBecameAnotherOneIsNoLeftover) {
  std::optional<WholeFile> first(path), third;
  first->stream() << "first";
  before_lock = [&] {  // the second has opened the part of the first
    first->finish();
    first.reset();
    third.emplace(path);
  };
  {
    const WholeFile second(path);
    ASSERT_TRUE(third);
  }
  third->stream() << "third";
  third->finish();
  EXPECT_EQ(slurp(path), "third");
}

TEST_F(WholeFiles, APartThatIsTakenForALeftoverBeforeItsLockIsTakenAnew) {
  before_lock = [&] { fs::remove(folder / "a.exr.part-nullcone-0"); };
  WholeFile file(path);
  file.stream() << "whole";
  file.finish();
  EXPECT_EQ(slurp(path), "whole");
  EXPECT_EQ(listing(), Names{"a.exr"});
}

/// The kernel tells of every reading of a folder.
TEST_F(WholeFiles, TheFolderIsNeverListed) {
  const int seen = ::inotify_init1(IN_NONBLOCK);
  ASSERT_GE(seen, 0);
  ASSERT_GE(::inotify_add_watch(seen, folder.c_str(), IN_ACCESS | IN_ONLYDIR), 0);
  const auto is_read_by = [&](const auto& work) {
    work();
    bool out = false;
    alignas(inotify_event) std::array<char, 4096> events{};
    for (ssize_t size = 0; (size = ::read(seen, events.data(), events.size())) > 0;)
      for (ssize_t at = 0; at < size;) {
        inotify_event event{};
        std::memcpy(&event, events.data() + at, sizeof event);
        out = out || event.len == 0;  // of the folder itself, not of a file in it
        at += static_cast<ssize_t>(sizeof event + event.len);
      }
    return out;
  };
  EXPECT_TRUE(is_read_by([&] { listing(); }));
  EXPECT_FALSE(is_read_by([&] { write_text(path, "a"); }));
  EXPECT_FALSE(is_read_by([&] { write(folder / "b.exr", sample()); }));
  ::close(seen);
}

}  // namespace
}  // namespace nullcone::test
