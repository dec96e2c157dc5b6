// How good the rays of a dataset are: medians without holding them all, and the worst ones by name.
#pragma once

#include <cstdint>
#include <vector>

#include "apps/info.h"

namespace nullcone {

/// Counts numbers from 0 to infinity in bins that are 2^-7 of their value wide, so that whole numbers below
/// 256 have a bin each; and 0 has its own.
class LogHistogram {
 public:
  static constexpr double kResolution = 1.0 / 128;

  void add(double x);
  /// The least edge of the bin that holds the number of rank ceil(share * count): at most 2^-7 of it too
  /// small. 0 where nothing has been counted.
  double quantile(double share) const;
  double max() const { return max_; }

 private:
  std::vector<std::uint64_t> bins_ = std::vector<std::uint64_t>(1 << 15);
  std::uint64_t count_ = 0;
  double max_ = 0;
};

/// What one ray says about itself.
struct RayQuality {
  std::uint64_t place;  ///< number in the grid of rays, row by row from the window's top left
  std::uint32_t status, steps;
  float error, drift;
};

/// Whether `a` deserves a look before `b`: doubtful ones first, then by error.
bool is_worse(const RayQuality& a, const RayQuality& b);

class Quality {
 public:
  /// Lists up to `worst` rays.
  Quality(const Manifest& manifest, std::size_t worst) : manifest_(manifest), most_(worst) {}
  /// The next rays from the top; those that were not traced do not count.
  void add(const Rays& rays);
  Report report() const;

 private:
  void list(const RayQuality& ray);
  Report describe(const RayQuality& ray) const;

  const Manifest& manifest_;
  std::size_t most_;
  std::uint64_t next_ = 0, doubtful_ = 0;
  LogHistogram steps_, error_, drift_;
  std::vector<RayQuality> worst_;  ///< a heap with the best of them on top
};

}  // namespace nullcone
