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

bool has_display(const Shading& shading) {
  return shading.background != Rgb{} ||
         std::ranges::any_of(shading.appearances,
                             [](const Appearance& appearance) { return !appearance.light.physical; });
}

bool has_physical(const Shading& shading) {
  return std::ranges::any_of(shading.appearances,
                             [](const Appearance& appearance) { return appearance.light.physical; });
}

}  // namespace nullcone::postrender
