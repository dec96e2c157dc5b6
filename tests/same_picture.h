// Two scenes that should look the same.
#pragma once

#include <gtest/gtest.h>

#include <map>

#include "tests/sanitized.h"
#include "tests/traced.h"

namespace nullcone::test {

/// A camera's resolution; a fraction of it where sanitizers slow everything down.
inline std::string pixels(int width, int height) {
  const int part = kSanitized ? 5 : 1;
  return "[" + std::to_string(width / part) + ", " + std::to_string(height / part) + "]";
}
inline constexpr std::size_t kFewest =
    kSanitized ? 20 : 300;  ///< hits that a picture must have to mean anything

inline std::string with(std::string scene, const std::string& more) { return scene.insert(1, more + ","); }

/// Hits of both scenes pixel by pixel: the worst difference of (u, v), ratios, and times over `scale`. Where
/// a ray grazes, all numbers are as uncertain as the root of their errors, so only mu > 0.05 counts. Few
/// pixels (those on edges) may see another object.
inline double worst_of_picture(const std::string& first, const std::string& second, double scale) {
  const Traced a = trace_text(first), b = trace_text(second);
  std::map<std::pair<std::size_t, std::size_t>, HitRecord> of_a;
  a.for_each_hit([&](const HitRecord& hit, std::size_t x, std::size_t y) { of_a[{x, y}] = hit; });
  std::size_t same = 0, other = 0;
  double worst = 0;
  const auto tau = [](const Traced& of, const HitRecord& hit) {
    return hit.tau + of.tau_origins[hit.id - 1];
  };
  b.for_each_hit([&](const HitRecord& hit, std::size_t x, std::size_t y) {
    const auto found = of_a.find({x, y});
    if (found == of_a.end() || found->second.id != hit.id ||
        std::fabs(found->second.Z - hit.Z) > 0.1 * scale) {
      ++other;
      return;
    }
    ++same;
    const HitRecord& h = found->second;
    if (std::min(h.mu, hit.mu) < 0.05 || std::min(h.v, 1 - h.v) < 0.02) return;  // u is undefined at poles
    const double du = std::fabs(h.u - hit.u);
    for (const double error :
         {std::min(du, 1 - du), h.v - hit.v, h.shift / hit.shift - 1, h.mu - hit.mu, (h.t - hit.t) / scale,
          (tau(a, h) - tau(b, hit)) / scale, (h.Z - hit.Z) / scale})
      if (std::isfinite(error)) worst = std::max(worst, std::fabs(error));
  });
  EXPECT_GT(same, a.hits() * (kSanitized ? 95 : 99) / 100);  // the coarser, the more edges
  EXPECT_GT(same, kFewest);
  EXPECT_LE(other, 2 + same / 300);
  EXPECT_NEAR(static_cast<double>(a.hits()), static_cast<double>(b.hits()),
              2 + 0.003 * static_cast<double>(same));
  return worst;
}
inline void expect_same_picture(const std::string& first, const std::string& second, double limit,
                                double scale) {
  EXPECT_LT(worst_of_picture(first, second, scale), limit);
}

}  // namespace nullcone::test
