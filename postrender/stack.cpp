#include "postrender/stack.h"

namespace nullcone::postrender {

Image stack(std::span<const Image> pictures) {
  constexpr int kLine = 2;
  constexpr Rgb kGrey = {0.2F, 0.2F, 0.2F};
  Image out = pictures.front();
  const auto line = static_cast<std::size_t>(kLine) * static_cast<std::size_t>(out.width);
  for (const Image& next : pictures.subspan(1)) {
    if (!out.exposed.empty()) out.exposed.insert(out.exposed.end(), line, kGrey);
    if (!out.display.empty()) out.display.insert(out.display.end(), line, kGrey);
    out.exposed.insert(out.exposed.end(), next.exposed.begin(), next.exposed.end());
    out.display.insert(out.display.end(), next.display.begin(), next.display.end());
    out.height += kLine + next.height;
  }
  return out;
}

}  // namespace nullcone::postrender
