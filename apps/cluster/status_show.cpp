#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "apps/cluster/status.h"
#include "apps/stop_signals.h"
#include "core/base/error.h"

namespace nullcone::cluster {

using nlohmann::ordered_json;

namespace {

std::string fixed(double value, int digits) {
  std::ostringstream out;
  out.setf(std::ios::fixed);
  out.precision(digits);
  out << value;
  return out.str();
}

std::string duration(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  if (whole < 100) return std::to_string(whole) + " s";
  if (whole < 6000) return std::to_string((whole + 59) / 60) + " min";
  return fixed(seconds / 3600, 1) + " h";
}

}  // namespace

std::string status_text(const Folder& folder, const Status& s) {
  std::ostringstream out;
  out << folder.path() << ": " << s.done << " of " << s.frames << " frames done, " << s.running
      << " running, " << s.waiting << " waiting, " << s.failed << " failed\n"
      << "round " << s.round
      << (s.working            ? ", at work"
          : s.done == s.frames ? ", over"
                               : ", over, frames missing");
  if (s.pictures >= 0) out << ", " << s.pictures << " pictures";
  if (s.tries_failed > 0) out << ", " << s.tries_failed << " tries failed";
  out << "\n";
  if (!s.held.empty()) {
    out << s.held.size() << " held, until somebody says: scontrol release";
    for (std::size_t i = 0; i < std::min<std::size_t>(s.held.size(), 8); ++i) out << " " << s.held[i];
    out << (s.held.size() > 8 ? " …" : "") << "\n";
  }
  if (s.per_minute > 0) out << "rate " << fixed(s.per_minute, 1) << " frames/min";
  if (s.per_minute > 0 && s.working && s.done < s.frames) out << ", " << duration(s.left_s) << " left";
  if (s.per_minute > 0) out << "\n";
  if (s.done == 0) return out.str();
  out << fixed(s.core_seconds / s.done, 2) << " core-seconds/frame; slowest:";
  for (const SlowFrame& slow : s.slowest)
    out << (&slow == &s.slowest.front() ? " " : ", ") << "frame " << slow.frame << " "
        << fixed(slow.core_seconds, 2) << " (" << printable(slow.host, 60) << ")";
  out << "\n";
  for (const auto& [name, host] : s.hosts)
    out << "  " << printable(name, 60) << " (" << printable(host.isa, 40) << "): " << host.frames
        << " frames, " << fixed(host.core_seconds / host.frames, 2) << " core-seconds/frame, slowest "
        << fixed(host.most, 2) << "\n";
  return out.str();
}

std::string status_json(const Status& s) {
  ordered_json slowest = ordered_json::array(), hosts = ordered_json::object();
  for (const SlowFrame& slow : s.slowest)
    slowest.push_back({{"frame", slow.frame}, {"core_seconds", slow.core_seconds}, {"host", slow.host}});
  for (const auto& [name, host] : s.hosts)
    hosts[name] = {{"isa", host.isa},
                   {"frames", host.frames},
                   {"core_seconds", host.core_seconds},
                   {"slowest_core_seconds", host.most}};
  return ordered_json{{"frames", s.frames},
                      {"done", s.done},
                      {"running", s.running},
                      {"waiting", s.waiting},
                      {"failed", s.failed},
                      {"pictures", s.pictures < 0 ? ordered_json() : ordered_json(s.pictures)},
                      {"tries_failed", s.tries_failed},
                      {"round", s.round},
                      {"working", s.working},
                      {"core_seconds", s.core_seconds},
                      {"frames_per_minute", s.per_minute},
                      {"seconds_left", s.left_s},
                      {"held", s.held},
                      {"slowest", slowest},
                      {"hosts", hosts}}
      .dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

int show_status(const Folder& folder, double every_s, bool json) {
  catch_stop_signals();
  for (;;) {
    const Status status = status_of(folder);
    const bool screen = every_s > 0 && !json && ::isatty(STDOUT_FILENO) == 1;
    const std::string text = json ? status_json(status) + "\n" : status_text(folder, status);
    std::printf("%s%s", screen ? "\033[H\033[J" : "", text.c_str());
    std::fflush(stdout);
    if (every_s <= 0) return 0;
    if (!status.working) return status.done == status.frames ? 0 : 1;
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(every_s);
    while (std::chrono::steady_clock::now() < end) {
      if (stop_wanted) return 0;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
}

}  // namespace nullcone::cluster
