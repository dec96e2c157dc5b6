#include "postrender/shading.h"

#include <algorithm>

namespace nullcone::postrender {

bool has_own_weight(const Appearance& appearance) {
  return appearance.opacity != 1 || appearance.changes || has_alpha(appearance.texture);
}

Clocks clocks_of(const Shading& shading) {
  Clocks out;
  for (const Appearance& appearance : shading.appearances) {
    out.add(clocks_of(appearance.texture));
    if (appearance.changes) out.add(appearance.emission.clocks());
  }
  for (const ObjectShading& object : shading.objects) out.add(object.clocks());
  return out;
}

bool keeps_colors(const Shading& shading) {
  return !clocks_of(shading).any() && std::ranges::none_of(shading.objects, &ObjectShading::blends) &&
         std::ranges::none_of(shading.appearances, [](const Appearance& appearance) {
           return has_own_weight(appearance) || !appearance.more.empty();
         });
}

bool same_textures(const Shading& a, const Shading& b) {
  return a.objects == b.objects &&
         std::ranges::equal(a.appearances, b.appearances, {}, &Appearance::texture, &Appearance::texture);
}

namespace {

/// Whether it radiates in cd/m^2 (or in display colours, not physical).
bool radiates(const Appearance& appearance, bool physical) {
  return (appearance.own_light > 0 && appearance.light.physical == physical) ||
         std::ranges::any_of(appearance.reflections,
                             [&](const Reflection& one) { return one.light.physical == physical; });
}

}  // namespace

bool has_display(const Shading& shading) {
  return shading.background != Rgb{} ||
         std::ranges::any_of(shading.appearances, [](const Appearance& one) { return radiates(one, false); });
}

bool has_physical(const Shading& shading) {
  return !shading.stars.empty() ||
         std::ranges::any_of(shading.appearances, [](const Appearance& one) { return radiates(one, true); });
}

}  // namespace nullcone::postrender
