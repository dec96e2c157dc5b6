// Light of lamps on surfaces, pixel by pixel.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/record/dataset.h"
#include "postrender/kernel.h"
#include "postrender/shading.h"

namespace nullcone::postrender {

/// sum += weight * what is seen of the light.
void add_light(const Kernel& kernel, const Light& light, const Lit& lit);

/// Light that is added up: in cd/m^2 (or the sensor's unit), and display colours. Null where nothing is.
struct Sums {
  Rgbx *display, *physical;
};

/// Crossings of one rank on a scan line, from column `first` on.
struct RunPlace {
  std::size_t row, rank, first;
};

/// Adds what surfaces reflect of lamps; holds the working memory of one thread.
class Illumination {
 public:
  /// `one_each` as lines_with_one_each() finds it.
  Illumination(const Dataset& dataset, std::span<const std::uint8_t> one_each, const Shading& shading,
               const Kernel& kernel)
      : dataset_(dataset), one_each_(one_each), shading_(shading), kernel_(kernel) {}

  /// Of a run of at most kSegment pixels that all show `surface`; `lit.sum` is not read.
  void add(const Appearance& surface, const RunPlace& place, const Lit& lit, const Sums& line);

 private:
  /// The record of one path along the run.
  struct Path {
    const float *E, *shift, *t, *tau;
  };
  /// A pixel that sees the lamp in one of its states.
  struct Sight {
    std::uint32_t state, pixel;
    float share;
  };

  Path path_along(std::size_t path, const RunPlace& place, std::size_t count);
  void add_path(const Appearance& surface, const LampShading& lamp, const Path& path, const Lit& lit,
                const Sums& sums);
  void find_sights(const ObjectShading& lamp, const Path& path, std::size_t count);
  bool weigh_steady(const Reflection& reflection, const LampState& state, const Path& path, const Lit& lit);
  bool weigh(const Reflection& reflection, const LampState& state, double tau_origin,
             std::span<const Sight> sights, const Path& path, const Lit& lit);
  void add_reflection(const Reflection& reflection, const Lit& lit, const Sums& sums);

  const Dataset& dataset_;
  std::span<const std::uint8_t> one_each_;
  const Shading& shading_;
  const Kernel& kernel_;
  std::array<std::array<float, kSegment>, 4> copied_{};  ///< of crossings that do not stand side by side
  std::array<float, kSegment> product_{}, along_{}, across_{}, weight_{};
  std::array<Rgbx, kSegment> filtered_{};
  std::vector<Sight> sights_;
};

}  // namespace nullcone::postrender
