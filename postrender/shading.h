// A look with everything at hand, and what can be told of it before any pixel is shaded.
#pragma once

#include <string>
#include <vector>

#include "postrender/coats.h"
#include "postrender/emission.h"
#include "postrender/moving_texture.h"
#include "postrender/reflection.h"
#include "postrender/star_shading.h"

namespace nullcone::postrender {

/// How a surface looks, ready for pixels.
struct Appearance {
  Texture texture;
  Light light;
  float opacity = 1;       ///< times that of the crossing; 0: not seen at all
  Emission emission = {};  ///< what else changes with the time of emission; the opacity there counts too
  bool changes = false;    ///< whether `emission` says anything
  /// What else radiates there, in the same place: further materials.
  struct Component {
    Texture texture;
    Light light;
    bool operator==(const Component&) const = default;
  };
  std::vector<Component> more = {};
  float own_light = 1;  ///< a factor on `light`; of lit surfaces that is what they reflect of ambient light
  std::vector<Reflection> reflections = {};  ///< by LampState; empty: only its own light is seen

  bool operator==(const Appearance&) const = default;
};

/// A lamp during one of its time slices, or without one.
using LampState = Emission;

/// A lamp that is on, ready for pixels.
struct LampShading {
  ObjectShading when;  ///< its states and clock; "appearances" are numbers in Shading::lamp_states
  std::vector<std::size_t> paths;  ///< those that count: numbers in Hits::light
  bool operator==(const LampShading&) const = default;
};

/// A look with everything that a pixel needs at hand: textures read, spectra tabulated, names turned into
/// numbers.
struct Shading {
  std::vector<Appearance> appearances;
  std::vector<ObjectShading> objects;  ///< by id - 1
  Rgb background;                      ///< display colour behind everything
  std::vector<std::string> notes;      ///< what the user should know of it
  std::vector<LampShading> lamps = {};
  std::vector<LampState> lamp_states = {};
  std::vector<StarShading> stars = {};
  bool operator==(const Shading&) const = default;
};

/// Whether its weight is not that of the crossing alone.
bool has_own_weight(const Appearance& appearance);
/// Clocks that must be known.
Clocks clocks_of(const Shading& shading);

/// Whether any appearance radiates in cd/m^2.
bool has_physical(const Shading& shading);
/// Whether there are display colours, be it those of the background.
bool has_display(const Shading& shading);
/// Whether the colours of textures may be kept from one picture to the next: one crossing a pixel, which
/// shows one texture at all times.
bool keeps_colors(const Shading& shading);
/// Whether two shadings (of one dataset) look up the same colours.
bool same_textures(const Shading& a, const Shading& b);

}  // namespace nullcone::postrender
