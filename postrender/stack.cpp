#include "postrender/stack.h"

#include "core/base/error.h"
#include "postrender/color.h"

namespace nullcone::postrender {

namespace {

/// Nothing where there is nothing to append: not all pictures have all parts.
template <class T>
void append(std::vector<T>& to, const std::vector<T>& more, std::size_t line, T grey) {
  if (more.empty()) return;
  to.insert(to.end(), line, grey);
  to.insert(to.end(), more.begin(), more.end());
}

}  // namespace

Image stack(std::span<const Image> pictures) {
  constexpr int kLine = 2;
  constexpr Rgb kGrey = {0.2F, 0.2F, 0.2F};
  Image out = pictures.front();
  const auto line = static_cast<std::size_t>(kLine) * static_cast<std::size_t>(out.width);
  for (const Image& next : pictures.subspan(1)) {
    if (next.output != out.output) throw InputError("--look", "pictures in one file need the same /output");
    append(out.exposed, next.exposed, line, kGrey);
    append(out.display, next.display, line, kGrey);
    append(out.encoded, next.encoded, 3 * line, Srgb8Table::instance()(kGrey.r));
    out.height += kLine + next.height;
  }
  return out;
}

}  // namespace nullcone::postrender
