// Textures that are placed anew or change with the time of emission: one mechanism for rotations, films, and
// numbers with keyframes.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "postrender/placement.h"
#include "postrender/texture.h"

namespace nullcone::postrender {

using StillTexture = std::variant<ColorTexture, CheckerboardTexture, ImageTexture, CubeTexture>;

struct MovingTexture {
  struct Parts {
    std::optional<Placement> placement;  ///< what the frames' own UvTransform cannot do
    Timeline timeline;                   ///< of the frames
    /// At least one, all of one kind; images that no crossing sees are null.
    std::vector<StillTexture> frames;
    bool operator==(const Parts&) const = default;
  };
  std::shared_ptr<const Parts> parts;
  bool operator==(const MovingTexture& other) const { return *parts == *other.parts; }
};

using Texture = std::variant<ColorTexture, CheckerboardTexture, ImageTexture, CubeTexture, MovingTexture>;

/// Whether footprints must be known.
bool needs_footprint(const Texture& texture);
/// Whether the texture itself lets light through.
bool has_alpha(const Texture& texture);
/// Clocks that must be known.
Clocks clocks_of(const Texture& texture);

/// The texture's colours along a run of at most kSegment pixels, of images also the alpha (colours are
/// multiplied by it). `times` of each pixel may be empty where clocks_of() has none. Footprints, if needed,
/// are overwritten; `recorded` as in Coordinates.
void look_up(const Kernel& kernel, const Texture& texture, const Run& run, std::span<const Times> times,
             bool recorded, Rgbx* out);

}  // namespace nullcone::postrender
