// The stars of a sky with everything that drawing them needs.
#pragma once

#include <cstdint>
#include <memory>

#include "postrender/spectrum.h"
#include "postrender/stars.h"

namespace nullcone::postrender {

/// How stars are drawn.
struct StarStyle {
  double intensity = 1;
  double size_px = 0.7;           ///< standard deviation of the spot that stands for a point
  double most_magnified = 10000;  ///< near caustics
  bool operator==(const StarStyle&) const = default;
};

/// The stars of one sky, ready to be seen.
struct StarShading {
  std::uint32_t id;
  std::shared_ptr<const StarField> field;
  Light light;           ///< of a black body of kReferenceStar_K, by g T / kReferenceStar_K
  bool doppler = true;   ///< colours are shifted
  double power = 0;      ///< of g, beside what the shift of the black body brings
  double intensity = 1;  ///< of style and object
  StarStyle style;
  bool operator==(const StarShading&) const = default;
};
inline constexpr double kReferenceStar_K = 6500;

}  // namespace nullcone::postrender
