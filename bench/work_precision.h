// The study of accuracy against time: what its program and its kernels (one an instruction set) say to each
// other. Plain data only.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "core/scene/scene.h"

namespace nullcone::study {

enum class MetricId { minkowski, goedel, kerr_schild };

/// Where rays are launched, and how far they are followed: a fixed affine length, so that every integrator
/// has the same end points to reach.
struct Place {
  std::string_view name;
  MetricId metric;
  double parameter;  ///< Gödel: a; Kerr-Schild: spin
  double radius;     ///< of the observer; 0: at the origin
  double length;     ///< affine
};

struct Start {
  std::array<double, 8> y;  ///< (x^mu, p_mu)
};

/// How a ray ended.
struct End {
  std::array<double, 8> y;
  double steps, rejected;  ///< attempts in all, and those refused (counted on request only)
  double error, drift;     ///< as in records; |g^mn p_m p_n| / p_t^2
  bool captured, lost;     ///< lost: neither captured nor followed over the whole length
};

struct Rays {
  const Start* start;
  End* end;
  std::size_t count;
};

/// Follows rays by the tracer's own loop, without objects; CPU seconds of the fastest of `repeats` runs.
using March = double (*)(const Place&, const Accuracy&, const Rays&, int repeats);
/// The bare stepper: packs that stay full, `attempts` attempts of a step for each ray. CPU seconds of the
/// fastest of `repeats`.
using Loop = double (*)(const Place&, const Accuracy&, const Rays&, int attempts, int repeats);

struct Kernel {
  std::string_view name;
  March march;
  Loop loop;
};
/// One lane (plain double), compiled with the same flags, and packs.
extern const Kernel kAvx2Lane, kAvx2Pack, kAvx512Lane, kAvx512Pack;

inline const char* name_of(Integrator integrator) {
  return kIntegratorNames[static_cast<std::size_t>(integrator)].data();
}

}  // namespace nullcone::study
