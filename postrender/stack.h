// Several pictures in one, from top to bottom.
#pragma once

#include <span>

#include "postrender/image.h"

namespace nullcone::postrender {

/// Stacks pictures of equal width, with thin grey lines between them. One picture comes back as it is. The
/// white is that of the first. Throws InputError where their outputs differ.
Image stack(std::span<const Image> pictures);

}  // namespace nullcone::postrender
