// SIGINT and SIGTERM as a flag that long work looks at.
#pragma once

#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>

namespace nullcone {

/// Set by SIGINT and SIGTERM after catch_stop_signals(). What is already being written is finished.
inline std::atomic<bool> stop_wanted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

namespace stop_signals {

inline std::atomic<std::int64_t> first = 0;  ///< when it came, in nanoseconds; 0: none has come
static_assert(std::atomic<std::int64_t>::is_always_lock_free);

inline void handle(int number) {
  timespec clock{};
  clock_gettime(CLOCK_MONOTONIC, &clock);
  const std::int64_t second = 1'000'000'000, now = clock.tv_sec * second + clock.tv_nsec;
  std::int64_t before = 0;
  stop_wanted = true;
  if (first.compare_exchange_strong(before, now) || now - before < second) return;
  std::signal(number, SIG_DFL);
  std::raise(number);  // comes when this function has returned
}

}  // namespace stop_signals

/// A signal that comes a second or more after the first ends the program at once. Sooner ones are the same
/// wish: a batch system may send it to all processes of a job, and those who started them pass it on.
inline void catch_stop_signals() {
  struct sigaction action {};
  action.sa_handler = stop_signals::handle;
  action.sa_flags = SA_RESTART;
  for (const int number : {SIGINT, SIGTERM}) {
    struct sigaction before {};
    sigaction(number, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);  // ignored under nohup, say
  }
}

}  // namespace nullcone
