#include "apps/trace_talk.h"

#include <cstdio>

namespace nullcone {

Progress TraceTalk::progress() {
  if (quiet_) return {};
  return [this](std::size_t done, std::size_t all) {
    const double now = seconds();
    double last = last_.load();
    if (now - last < 0.2 || !last_.compare_exchange_strong(last, now)) return;
    const double rate = static_cast<double>(done) / now, left = static_cast<double>(all - done) / rate;
    std::fprintf(stderr, "\r%3.0f %%, %.2f M pixels/s, %.0f s left   ",
                 100.0 * static_cast<double>(done) / static_cast<double>(all), 1e-6 * rate, left);
  };
}

Note TraceTalk::notes() const {
  if (quiet_) return {};
  return [](const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); };
}

void TraceTalk::resumed(const std::string& path, int lines) const {
  if (!quiet_) std::fprintf(stderr, "%s: going on after %d scan lines\n", path.c_str(), lines);
}

void TraceTalk::summary(const Manifest& manifest, std::size_t hits, const std::string& path) const {
  if (quiet_) return;
  std::fprintf(stderr, "\r%s: %zu rays, %zu hits, %.2f s, %.2f core-seconds (%s)   \n", path.c_str(),
               manifest.rays(), hits, seconds(), manifest.effort.core_seconds, manifest.isa.c_str());
  if (manifest.effort.light_doubts > 0)
    std::fprintf(
        stderr,
        "%s: note: light of a lamp may have been missed %llu times, where it winds about or is focused\n",
        path.c_str(), static_cast<unsigned long long>(manifest.effort.light_doubts));
}

double TraceTalk::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

}  // namespace nullcone
