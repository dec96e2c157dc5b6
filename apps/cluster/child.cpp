#include "apps/cluster/child.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <sstream>

#include "core/base/error.h"

namespace nullcone::cluster {

namespace {

/// Nobody writes into it; its reading end wakes up when the last process that holds the other has ended.
struct Lifeline {
  Lifeline() {
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) ends = {-1, -1};
  }
  ~Lifeline() {
    close_end(0);
    close_end(1);
  }
  Lifeline(const Lifeline&) = delete;
  Lifeline& operator=(const Lifeline&) = delete;
  void close_end(std::size_t i) {
    if (ends[i] >= 0) ::close(ends[i]);
    ends[i] = -1;
  }
  std::array<int, 2> ends{};
};

/// In the child, between fork and exec: only what may be called there.
[[noreturn]] void become(char* const* words, const Outputs& to, int lifeline, pid_t parent) {
  ::setpgid(0, 0);  // signals of the terminal are ours to pass on
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) ::_exit(127);
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(to.output, STDOUT_FILENO);
  ::dup2(to.complaints, STDERR_FILENO);
  ::fcntl(lifeline, F_SETFD, 0);  // passed on
  for (const int number : {SIGINT, SIGTERM, SIGPIPE, SIGCHLD}) ::signal(number, SIG_DFL);
  ::execvp(words[0], words);
  for (const char* part : {words[0], const_cast<char*>(": cannot be started\n")})
    if (::write(STDERR_FILENO, part, std::strlen(part)) < 0) break;
  ::_exit(127);
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

void describe(ChildEnd& out, int status, const rusage& usage) {
  if (WIFSIGNALED(status)) out.signal = WTERMSIG(status);
  if (WIFEXITED(status)) out.status = WEXITSTATUS(status);
  out.peak_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) << 10;
  out.core_seconds = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
}

}  // namespace

ChildEnd run_child(const std::vector<std::string>& words, const Outputs& to,
                   const std::function<bool()>& stop) {
  using Clock = std::chrono::steady_clock;
  constexpr int kPatience_ms = 100;  // between looks at `stop`
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  Lifeline lifeline;
  const auto start = Clock::now();
  const pid_t self = ::getpid(), process = ::fork();
  if (process < 0) throw WorkError(words.front(), "cannot be started");
  if (process == 0) become(arguments.data(), to, lifeline.ends[1], self);
  lifeline.close_end(1);
  ChildEnd out;
  int status = 0;
  rusage usage{};
  for (;;) {
    pollfd end{lifeline.ends[0], POLLIN, 0};
    ::poll(&end, 1, kPatience_ms);
    const pid_t ended = ::wait4(process, &status, (end.revents & POLLHUP) != 0 ? 0 : WNOHANG, &usage);
    if (ended == process) break;
    if (ended < 0 && errno != EINTR) throw WorkError(words.front(), "ended, and nobody knows how");
    if (!out.stopped && stop && stop()) out.stopped = ::kill(-process, SIGTERM) == 0;
  }
  describe(out, status, usage);
  out.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return out;
}

Captured capture(const std::vector<std::string>& words) {
  using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;
  const File output(std::tmpfile(), &std::fclose), complaints(std::tmpfile(), &std::fclose);
  if (!output || !complaints) throw WorkError(words.front(), "cannot be started: no temporary file");
  const auto text_of = [](const File& file) {
    std::string out;
    std::rewind(file.get());
    std::array<char, 4096> block{};
    for (std::size_t n = 0; (n = std::fread(block.data(), 1, block.size(), file.get())) > 0;)
      out.append(block.data(), n);
    return out;
  };
  const ChildEnd end = run_child(words, {::fileno(output.get()), ::fileno(complaints.get())});
  return {end, text_of(output), text_of(complaints)};
}

bool on_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (::access((std::filesystem::path(folder.empty() ? "." : folder) / program).c_str(), X_OK) == 0)
      return true;
  return false;
}

std::string quoted(const std::string& word) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-./=,:%@+").find(c) != std::string_view::npos;
  };
  bool safe = !word.empty();
  for (const char c : word) safe = safe && plain(c);
  if (safe) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string shell_line(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : " ") + quoted(word);
  return out;
}

}  // namespace nullcone::cluster
