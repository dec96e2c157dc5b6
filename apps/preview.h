// The flat picture inside a dataset, so that any EXR viewer shows something.
#pragma once

#include <array>

#include "core/record/dataset_file.h"

namespace nullcone {

/// Each object in a colour of its own, shaded by the emission angle; black where nothing was hit.
inline Preview make_preview(const Hits& hits) {
  constexpr std::array<std::array<float, 3>, 6> kColors = {{{0.25F, 0.45F, 0.9F},
                                                            {0.9F, 0.5F, 0.2F},
                                                            {0.3F, 0.75F, 0.35F},
                                                            {0.8F, 0.3F, 0.6F},
                                                            {0.85F, 0.8F, 0.3F},
                                                            {0.5F, 0.5F, 0.5F}}};
  const std::size_t pixels = hits.offset.size() - 1;
  Preview out(4 * pixels, 0.0F);
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint64_t first = hits.offset[i];
    if (first == hits.offset[i + 1]) continue;
    const auto& color = kColors[(hits.id[first] - 1) % kColors.size()];
    const float light = hits.mu.empty() ? 1.0F : 0.4F + 0.6F * hits.mu[first];
    for (std::size_t c = 0; c < 3; ++c) out[4 * i + c] = color[c] * light;
    out[4 * i + 3] = 1.0F;
  }
  return out;
}

}  // namespace nullcone
