// SIGINT and SIGTERM as a flag that long work looks at.
#pragma once

#include <atomic>
#include <csignal>

namespace nullcone {

/// Set by SIGINT and SIGTERM after catch_stop_signals(). What is already being written is finished.
inline std::atomic<bool> stop_wanted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

/// A second signal ends the program at once.
inline void catch_stop_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { stop_wanted = true; };
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  for (const int number : {SIGINT, SIGTERM}) {
    struct sigaction before {};
    sigaction(number, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);  // ignored under nohup, say
  }
}

}  // namespace nullcone
